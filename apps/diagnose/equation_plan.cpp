#include "equation_plan.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "expression.hpp"

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
    return std::move(plan_);
  }

 private:
  struct Let {
    std::string name;
    PlanStep step;
    std::vector<int> needs;  // slots
    bool is_input = false;   // another name for an input
  };

  int add(double value, bool fixed) {
    plan_.slots.push_back(value);
    fixed_.push_back(fixed);
    return static_cast<int>(plan_.slots.size()) - 1;
  }

  static std::string variable(int slot) { return "v" + std::to_string(slot); }

  bool is_fixed(const Expression& e, int i) const {
    const Node& node = e[i];
    if (node.kind == Node::Kind::name) return fixed_[static_cast<std::size_t>(slot_of_.at(node.text))];
    return std::ranges::all_of(node.arguments, [&](int argument) { return is_fixed(e, argument); });
  }

  // The text of a node, its fixed parts replaced by slots that prepare computes.
  std::string text(const Expression& e, int i) {
    const int slot = known_slot(e, i);
    return slot >= 0 ? variable(slot) : plain_text(e, i);
  }

  std::string plain_text(const Expression& e, int i) {
    const Node& node = e[i];
    const auto argument = [&](std::size_t k) { return text(e, node.arguments[k]); };
    switch (node.kind) {
      case Node::Kind::number:
      case Node::Kind::name:
        return variable(known_slot(e, i));
      case Node::Kind::negate:
        return "(-" + argument(0) + ")";
      case Node::Kind::binary:
        return "(" + argument(0) + node.text + argument(1) + ")";
      case Node::Kind::choice:
        return "(" + argument(0) + "?" + argument(1) + ":" + argument(2) + ")";
      case Node::Kind::call:
        break;
    }
    if (node.arguments.size() == 1) return node.text + "(" + argument(0) + ")";
    std::string folded = argument(0);
    for (std::size_t k = 1; k < node.arguments.size(); ++k) folded = node.text + "(" + folded + "," + argument(k) + ")";
    return folded;
  }

  // EffectSlot that already holds, or after prepare will hold, the value of a node; -1: it changes and must be computed.
  int known_slot(const Expression& e, int i) {
    const Node& node = e[i];
    if (node.kind == Node::Kind::name) return slot_of_.at(node.text);
    if (node.kind == Node::Kind::number) return number_slot(node.value);
    if (!is_fixed(e, i)) return -1;
    const std::string value = plain_text(e, i);
    const auto [at, added] = prepared_.emplace(value, 0);
    if (added) {
      at->second = add(unknown, true);
      plan_.prepare.push_back({at->second, value});
    }
    return at->second;
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
    const int known = known_slot(e, e.root);
    const bool changes = known < 0 || !fixed_[static_cast<std::size_t>(known)];
    if (!changes) {
      slot_of_[let.name] = known;
      return;
    }
    const std::string value = text(e, e.root);
    const int slot = slot_of_[let.name] = add(unknown, false);
    const bool is_input = known >= plan_.states && known < plan_.states + plan_.inputs;
    lets_.push_back({let.name, {slot, value}, slots_in(e), is_input});
  }

  PlanPart part(const std::vector<Formula>& formulas) {
    PlanPart result;
    std::vector<bool> needed(plan_.slots.size(), false);
    for (const Formula& formula : formulas) {
      const Expression e = parse_expression(formula.text);
      for (const int slot : slots_in(e)) needed[static_cast<std::size_t>(slot)] = true;
      int slot = known_slot(e, e.root);
      if (slot < 0) {
        const std::string value = text(e, e.root);
        slot = add(unknown, false);
        result.steps.push_back({slot, value});
      }
      result.results.push_back(slot);
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
  std::map<std::string, int> prepared_;  // texts
  std::map<double, int> numbers_;
  std::vector<Let> lets_;
};

}  // namespace

EquationPlan plan_equations(const ModelFile& model) { return Planner(model).plan(); }

}  // namespace diagnose_program
