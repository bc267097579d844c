#include "equation_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "expression.hpp"
#include "known_operations.hpp"
#include "names.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class Planner {
 public:
  explicit Planner(const ModelFile& model) : model_(model) {}

  EquationPlan plan() {
    plan_.states = static_cast<int>(model_.states.size());
    plan_.inputs = static_cast<int>(model_.inputs.size());
    plan_.parameters = static_cast<int>(model_.parameters.size());
    for (const auto& state : model_.states) slot_of_[state.name] = add(0, false);
    for (const auto& input : model_.inputs) slot_of_[input.name] = add(0, false);
    for (const auto& parameter : model_.parameters) slot_of_[parameter.name] = add(parameter.value, true);
    for (const auto& constant : model_.constants) {
      const int slot = slot_of_[constant.name] = add(constant.meta.empty() ? constant.value : unknown, true);
      if (!constant.meta.empty()) plan_.meta.emplace_back(constant.meta, slot);
    }
    plan_.zero = number_slot(0);
    for (const auto& state : model_.states) {
      if (!state.force.empty()) slot_of_[state.force] = plan_.zero;
    }
    for (const auto& let : model_.lets) add_let(let);

    std::vector<Formula> changes, outputs, efforts;
    for (const auto& state : model_.states) {
      changes.push_back(state.change);
      efforts.push_back(state.effort ? *state.effort : Formula{"1", ""});
    }
    for (const auto& output : model_.outputs) outputs.push_back(output.value);
    plan_.change = part(changes);
    name_signals();
    plan_.outputs = part(outputs);
    plan_.efforts = part(efforts);
    plan_.responses = responses(changes);
    plan_.prepare = std::move(prepare_.operations);
    return std::move(plan_);
  }

 private:
  struct Let {
    std::string name;
    PlanStep step;
    std::vector<int> needs;  // slots
    bool is_input = false;   // another name for an input
  };

  // Operations on their way, and the slots of those that are there already.
  using Operands = std::tuple<Operation::Code, const void*, int, int, int>;
  struct Block {
    Operations operations;
    std::map<Operands, int> slots;
  };

  int add(double value, bool fixed) {
    plan_.slots.push_back(value);
    fixed_.push_back(fixed);
    return static_cast<int>(plan_.slots.size()) - 1;
  }

  bool is_fixed(int slot) const { return fixed_[static_cast<std::size_t>(slot)]; }

  // The slot of an operation's result. What depends on fixed slots alone is computed once, in prepare.
  int result_of(Operation operation, Block& block) {
    const bool fixed = is_fixed(operation.a) && is_fixed(operation.b) && is_fixed(operation.c);
    Block& home = fixed ? prepare_ : block;
    const void* function = operation.unary != nullptr ? reinterpret_cast<const void*>(operation.unary)
                                                      : reinterpret_cast<const void*>(operation.binary);
    const Operands key{operation.code, function, operation.a, operation.b, operation.c};
    const auto [at, added] = home.slots.emplace(key, 0);
    if (added) {
      operation.to = at->second = add(unknown, fixed);
      home.operations.push_back(operation);
    }
    return at->second;
  }

  int apply(Operation::Code code, int a, int b, Block& block) { return result_of({code, 0, a, b, a}, block); }

  int power(int base, const Node& exponent, int exponent_slot, Block& block) {
    constexpr double most_products = 4;
    const bool products = exponent.kind == Node::Kind::number && exponent.value >= 1 &&
                          exponent.value <= most_products && exponent.value == std::floor(exponent.value);
    if (!products) return apply(Operation::Code::power, base, exponent_slot, block);
    int result = base;
    for (int k = 1; k < static_cast<int>(exponent.value); ++k) {
      result = apply(Operation::Code::multiply, result, base, block);
    }
    return result;
  }

  // Adds the operations of a node to `block` or to prepare; the slot of its value.
  int compile(const Expression& e, int i, Block& block) {
    const Node& node = e[i];
    if (node.kind == Node::Kind::name) return slot_of_.at(node.text);
    if (node.kind == Node::Kind::number) return number_slot(node.value);
    std::vector<int> arguments;
    for (const int argument : node.arguments) arguments.push_back(compile(e, argument, block));
    switch (node.kind) {
      case Node::Kind::negate:
        return apply(Operation::Code::negate, arguments[0], arguments[0], block);
      case Node::Kind::binary:
        if (node.text == "^") return power(arguments[0], e[node.arguments[1]], arguments[1], block);
        return apply(code_of_operator(node.text), arguments[0], arguments[1], block);
      case Node::Kind::choice:
        return result_of({Operation::Code::choice, 0, arguments[0], arguments[1], arguments[2]}, block);
      default:
        break;
    }
    Operation call = call_of(node.text, arguments.size());
    int result = arguments[0];
    for (std::size_t k = std::min<std::size_t>(1, arguments.size() - 1); k < arguments.size(); ++k) {
      call.a = result;
      call.b = call.c = arguments[k];
      result = result_of(call, block);
    }
    return result;
  }

  int number_slot(double value) {
    const auto [at, added] = numbers_.emplace(value, 0);
    if (added) at->second = add(value, true);
    return at->second;
  }

  std::vector<int> slots_in(const Expression& e) const {
    std::vector<int> result;
    for (const std::string& name : names_in(e)) result.push_back(slot_of_.at(name));
    return result;
  }

  void add_let(const ModelLet& let) {
    const Expression e = parse_expression(let.value.text);
    Block block;
    const int value = compile(e, e.root, block);
    if (is_fixed(value)) {
      slot_of_[let.name] = value;
      return;
    }
    // in a slot of its own, since an effect may change it
    const int slot = slot_of_[let.name] = add(unknown, false);
    if (block.operations.empty()) {
      block.operations.push_back({Operation::Code::copy, slot, value, value, value});
    } else {
      block.operations.back().to = slot;
    }
    const bool is_input = value >= plan_.states && value < plan_.states + plan_.inputs;
    lets_.push_back({let.name, {slot, std::move(block.operations)}, slots_in(e), is_input});
  }

  PlanPart part(const std::vector<Formula>& formulas) {
    std::vector<int> results;
    Block block;
    for (const Formula& formula : formulas) {
      const Expression e = parse_expression(formula.text);
      results.push_back(compile(e, e.root, block));
    }
    return part(std::move(block), std::move(results));
  }

  // The operations with the lets that they need.
  PlanPart part(Block block, std::vector<int> results) {
    PlanPart result{{}, {}, std::move(results), std::move(block.operations)};
    std::vector<bool> needed(plan_.slots.size(), false);
    for (const int slot : result.results) needed[static_cast<std::size_t>(slot)] = true;
    for (const Operation& one : result.operations) {
      for (const int slot : {one.a, one.b, one.c}) needed[static_cast<std::size_t>(slot)] = true;
    }
    for (std::size_t i = lets_.size(); i-- > 0;) {
      if (!needed[static_cast<std::size_t>(lets_[i].step.slot)]) continue;
      for (const int slot : lets_[i].needs) needed[static_cast<std::size_t>(slot)] = true;
    }
    for (const Let& let : lets_) {
      if (!needed[static_cast<std::size_t>(let.step.slot)]) continue;
      result.lets.push_back(let.step);
      result.signals.push_back(-1);
    }
    return result;
  }

  // What each force adds to each rate, per unit: the derivative, since rates are linear in forces.
  PlanPart responses(const std::vector<Formula>& changes) {
    Block block;
    std::vector<int> results;
    for (std::size_t i = 0; i < model_.states.size(); ++i) {
      const std::string& force = model_.states[i].force;
      if (force.empty()) continue;
      plan_.pushed.push_back(static_cast<int>(i));
      Slopes slopes{{force, number_slot(1)}};
      for (const ModelLet& let : model_.lets) slopes[let.name] = slope(let.value, force, slopes, block);
      for (const Formula& change : changes) results.push_back(slope(change, force, slopes, block));
    }
    return part(std::move(block), std::move(results));
  }

  using Slopes = std::map<std::string, int>;  // by name: the slot of its derivative by a force

  int slope(const Formula& formula, const std::string& force, const Slopes& slopes, Block& block) {
    const Expression e = parse_expression(formula.text);
    const int result = slope(e, e.root, slopes, block);
    if (result >= 0) return result;
    throw surefoot::DiagnoseError(
        formula.place + ": the force " + in_quotes(force) +
        " must enter as a plain sum or product, since rates are linear in forces; take it out "
        "of the function, power or quotient that it stands in");
  }

  // The slot of the derivative of a node by the force whose slopes those are; -1: it is not linear in it.
  int slope(const Expression& e, int i, const Slopes& slopes, Block& block) {
    const Node& node = e[i];
    if (node.kind == Node::Kind::number) return plan_.zero;
    if (node.kind == Node::Kind::name) {
      const auto at = slopes.find(node.text);
      return at == slopes.end() ? plan_.zero : at->second;
    }
    std::vector<int> of;
    for (const int argument : node.arguments) of.push_back(slope(e, argument, slopes, block));
    if (std::ranges::find(of, -1) != of.end()) return -1;
    if (std::ranges::all_of(of, [this](int slot) { return slot == plan_.zero; })) return plan_.zero;
    if (node.kind == Node::Kind::negate) return apply(Operation::Code::negate, of[0], of[0], block);
    if (node.kind == Node::Kind::choice && of[0] == plan_.zero) {
      const int condition = compile(e, node.arguments[0], block);
      return result_of({Operation::Code::choice, 0, condition, of[1], of[2]}, block);
    }
    if (node.kind != Node::Kind::binary) return -1;
    if (node.text == "+" && of[0] == plan_.zero) return of[1];
    if ((node.text == "+" || node.text == "-") && of[1] == plan_.zero) return of[0];
    if (node.text == "+" || node.text == "-") return apply(code_of_operator(node.text), of[0], of[1], block);
    if (node.text == "*" && of[0] == plan_.zero) return times(compile(e, node.arguments[0], block), of[1], block);
    if (node.text == "*" && of[1] == plan_.zero) return times(of[0], compile(e, node.arguments[1], block), block);
    if (node.text == "/" && of[1] == plan_.zero) {
      return apply(Operation::Code::divide, of[0], compile(e, node.arguments[1], block), block);
    }
    return -1;
  }

  int times(int a, int b, Block& block) {
    const int one = number_slot(1);
    if (a == one) return b;
    return b == one ? a : apply(Operation::Code::multiply, a, b, block);
  }

  // Effects may act on the lets that rates need, unless that would be to act on an input under another name.
  void name_signals() {
    for (std::size_t i = 0; i < plan_.change.lets.size(); ++i) {
      const int slot = plan_.change.lets[i].slot;
      const auto let = std::ranges::find_if(lets_, [slot](const Let& one) { return one.step.slot == slot; });
      if (let->is_input) continue;
      plan_.change.signals[i] = static_cast<int>(plan_.signals.size());
      plan_.signals.push_back(let->name);
    }
  }

  const ModelFile& model_;
  EquationPlan plan_;
  std::vector<bool> fixed_;  // by slot: stays the same during a run
  std::map<std::string, int> slot_of_;
  Block prepare_;
  std::map<double, int> numbers_;
  std::vector<Let> lets_;
};

}  // namespace

EquationPlan plan_equations(const ModelFile& model) { return Planner(model).plan(); }

}  // namespace diagnose_program
