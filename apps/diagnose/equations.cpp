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
  for (const auto& input : model.inputs) info.inputs.push_back({input.name, input.unit, input.linear});
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
  for (const PlanStep& step : steps) result.emplace_back(step.operations, slots);
  return result;
}

Formulas together(const PlanPart& part, std::span<double> slots) {
  Operations all;
  for (const PlanStep& let : part.lets) all.insert(all.end(), let.operations.begin(), let.operations.end());
  all.insert(all.end(), part.operations.begin(), part.operations.end());
  return {all, slots};
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

void Equations::build() {
  prepare_ = Formulas(plan_->prepare, slots_);
  whole_change_ = together(plan_->change, slots_);
  lets_ = one_by_one(plan_->change.lets, slots_);
  change_ = Formulas(plan_->change.operations, slots_);
  outputs_ = together(plan_->outputs, slots_);
  efforts_ = together(plan_->efforts, slots_);
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

Channels Equations::change(const Channels& x, const Channels& u) {
  put(x, u);
  whole_change_.evaluate();
  return results(plan_->change);
}

Channels Equations::outputs(const Channels& x, const Channels& u) {
  put(x, u);
  outputs_.evaluate();
  return results(plan_->outputs);
}

Channels Equations::efforts(const Channels& x, const Channels& u) {
  put(x, u);
  efforts_.evaluate();
  return results(plan_->efforts);
}

}  // namespace diagnose_program
