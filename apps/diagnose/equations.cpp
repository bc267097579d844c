#include "equations.hpp"

#include <algorithm>
#include <cmath>

#include "names.hpp"

namespace diagnose_program {
namespace {

surefoot::SimulatorInfo info_of(const ModelFile& model, const EquationPlan& plan) {
  surefoot::SimulatorInfo info;
  info.name = model.name;
  info.kind = model.kind;
  for (const auto& state : model.states) info.states.push_back({state.name, state.unit, state.effort_unit});
  for (const auto& input : model.inputs) info.inputs.push_back({input.name, input.unit, input.hold});
  for (const auto& output : model.outputs) {
    info.outputs.push_back({output.name, output.unit, output.noise, output.process_noise});
  }
  info.parameters = model.parameters;
  info.signals = plan.signals;
  if (model.planar) {
    const auto index = [&](const std::string& name) {
      return static_cast<int>(std::ranges::find(model.states, name, &ModelState::name) - model.states.begin());
    };
    info.planar = {index(model.planar->x), index(model.planar->y), index(model.planar->heading)};
  }
  return info;
}

std::vector<Formulas> one_by_one(std::span<const PlanStep> steps, std::span<double> slots) {
  std::vector<Formulas> result;
  for (const PlanStep& step : steps) result.emplace_back(step.operations, std::span(&step.slot, 1), slots);
  return result;
}

Operations together(const PlanPart& plan) {
  Operations all;
  for (const PlanStep& let : plan.lets) all.insert(all.end(), let.operations.begin(), let.operations.end());
  all.insert(all.end(), plan.operations.begin(), plan.operations.end());
  return all;
}

// Those of the operations, which come in order, that a result depends on.
Operations needed_for(int result, const Operations& operations) {
  std::vector<int> needed{result};
  Operations kept;
  for (std::size_t i = operations.size(); i-- > 0;) {
    const Operation& one = operations[i];
    if (std::ranges::find(needed, one.to) == needed.end()) continue;
    needed.insert(needed.end(), {one.a, one.b, one.c});
    kept.push_back(one);
  }
  std::ranges::reverse(kept);
  return kept;
}

}  // namespace

Equations::Equations(const ModelFile& model) {
  auto plan = std::make_shared<EquationPlan>(plan_equations(model));
  info_ = std::make_shared<surefoot::SimulatorInfo>(info_of(model, *plan));
  plan_ = std::move(plan);
  slots_ = plan_->slots;
  build();
}

Equations::Equations(const Equations& other) : info_(other.info_), plan_(other.plan_), slots_(other.slots_) { build(); }

Equations& Equations::operator=(const Equations& other) {
  Equations copy(other);
  return *this = std::move(copy);
}

Equations::Part Equations::part_of(const Operations& operations, std::vector<int> results) {
  Part part{Formulas(operations, results, slots_), {}, operations.empty()};
  for (const int slot : results) {
    part.results.push_back(&slots_[static_cast<std::size_t>(slot)]);
    part.steady = part.steady && slot >= plan_->states + plan_->inputs;
  }
  return part;
}

void Equations::hold(const std::vector<bool>& signals) {
  held_ = signals;
  rates_without_.clear();
  const PlanPart& plan = plan_->change;
  std::vector<int> held;  // slots
  for (std::size_t i = 0; i < plan.lets.size(); ++i) {
    const int signal = plan.signals[i];
    if (signal >= 0 && signals[static_cast<std::size_t>(signal)]) held.push_back(plan.lets[i].slot);
  }
  const auto replace = [&](int& slot) {
    if (std::ranges::find(held, slot) != held.end()) slot = plan_->zero;
  };
  Operations operations = together(plan);
  for (Operation& one : operations) {
    for (int* slot : {&one.a, &one.b, &one.c}) replace(*slot);
  }
  for (int result : plan.results) {
    replace(result);
    rates_without_.push_back(part_of(needed_for(result, operations), {result}));
  }
}

void Equations::build() {
  prepare_ = Formulas(plan_->prepare, slots_);
  change_ = part_of(together(plan_->change), plan_->change.results);
  outputs_ = part_of(together(plan_->outputs), plan_->outputs.results);
  efforts_ = part_of(together(plan_->efforts), plan_->efforts.results);
  responses_ = part_of(together(plan_->responses), plan_->responses.results);
  lets_ = one_by_one(plan_->change.lets, slots_);
  after_lets_ = Formulas(plan_->change.operations, plan_->change.results, slots_);
}

void Equations::take_constants(const surefoot::Recording& recording) {
  for (const auto& [key, slot] : plan_->meta) {
    const auto value = recording.constants.find(key);
    if (value == recording.constants.end()) {
      throw surefoot::DiagnoseError(recording.name + ": the model wants the constant " + in_quotes(key) +
                                    "; add a first line '# " + printable(key) + ": number'");
    }
    slots_[static_cast<std::size_t>(slot)] = value->second;
  }
  prepare_.evaluate();
}

void Equations::prepare(const Eigen::VectorXd& p) {
  std::copy(p.data(), p.data() + std::min<Eigen::Index>(p.size(), plan_->parameters),
            slots_.data() + plan_->states + plan_->inputs);
  prepare_.evaluate();
}

}  // namespace diagnose_program
