// The equations of a model file as a simulator that can be diagnosed.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "channels.hpp"
#include "equation_plan.hpp"
#include "formulas.hpp"
#include "model_file.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace diagnose_program {

/// All quantities of a model, with the formulas that compute them. A copy has memory and formulas of its own, so that
/// each thread can have one.
class Equations {
 public:
  explicit Equations(const ModelFile& model);
  Equations(const Equations& other);
  Equations& operator=(const Equations& other);
  Equations(Equations&&) noexcept = default;
  Equations& operator=(Equations&&) noexcept = default;

  const surefoot::SimulatorInfo& info() const { return *info_; }

  /// Takes the constants of a recording; throws surefoot::DiagnoseError if one is missing.
  void take_constants(const surefoot::Recording& recording);
  void prepare(const Eigen::VectorXd& p);

  template <class State, class Tap>
  State change(const State& x, const Channels& u, Tap&& tap) {
    if constexpr (std::is_same_v<std::remove_cvref_t<Tap>, surefoot::NoTap>) return change(x, u);
    put(x, u);
    for (std::size_t i = 0; i < lets_.size(); ++i) {
      lets_[i].evaluate();
      const int signal = plan_->change.signals[i];
      if (signal < 0) continue;
      double& value = slots_[static_cast<std::size_t>(plan_->change.lets[i].slot)];
      value = tap(signal, value);
    }
    after_lets_.evaluate();
    return results<State>(change_);
  }

  template <class State>
  State change(const State& x, const Channels& u) {
    return computed<State>(change_, x, u);
  }
  template <class State>
  State efforts(const State& x, const Channels& u) {
    return computed<State>(efforts_, x, u);
  }
  /// What forces on the states add to the rates; 0 for forces that no rate uses.
  template <class State>
  State response(const State& x, const Channels& u, const State& forces) {
    evaluate_responses(x, u);
    State added = forces;
    const double* const* per_force = responses_.results.data();
    set_one_by_one(added, [](Eigen::Index) { return 0.0; });
    for (const int state : plan_->pushed) {
      const double force = forces[state];
      set_one_by_one(added, [&](Eigen::Index i) { return added[i] + force * *per_force[i]; });
      per_force += added.size();
    }
    return added;
  }
  /// The same for a unit of force on each of these states, all named in plan.pushed.
  template <class State>
  std::vector<State> unit_responses(const State& x, const Channels& u, const std::vector<int>& states) {
    evaluate_responses(x, u);
    std::vector<State> responses(states.size(), x);
    for (std::size_t k = 0; k < states.size(); ++k) {
      const auto number = std::find(plan_->pushed.begin(), plan_->pushed.end(), states[k]) - plan_->pushed.begin();
      const double* const* per_force = responses_.results.data() + number * x.size();
      set_one_by_one(responses[k], [&](Eigen::Index i) { return *per_force[i]; });
    }
    return responses;
  }
  template <class State>
  Channels outputs(const State& x, const Channels& u) {
    return computed<Channels>(outputs_, x, u);
  }

  /// The rate of one state alone, with those signals at zero that are `held`.
  template <class State>
  double rate_without(const std::vector<bool>& held, int state, const State& x, const Channels& u) {
    if (rates_without_.empty() || held != held_) hold(held);
    const Part& rate = rates_without_[static_cast<std::size_t>(state)];
    return computed<surefoot::Vec<1>>(rate, x, u)[0];
  }

 private:
  /// All formulas of a part of the plan, and where its results are found.
  struct Part {
    Formulas formulas;
    std::vector<const double*> results;
    bool steady = false;  // the same for all states and inputs
  };

  void build();
  void hold(const std::vector<bool>& signals);
  Part part_of(const Operations& operations, std::vector<int> results);

  template <class State>
  void put(const State& x, const Channels& u) {
    double* to = slots_.data();
    for (const double value : x) {
      *to++ = value;
      std::atomic_signal_fence(std::memory_order_seq_cst);
    }
    for (const double value : u) *to++ = value;
  }
  template <class State>
  void evaluate_responses(const State& x, const Channels& u) {
    if (responses_.steady) return;
    put(x, u);
    responses_.formulas.evaluate();
  }
  template <class Values>
  static Values results(const Part& part) {
    Values values;
    values.resize(static_cast<Eigen::Index>(part.results.size()));
    set_one_by_one(values, [&](Eigen::Index i) { return *part.results[static_cast<std::size_t>(i)]; });
    return values;
  }
  template <class Values, class State>
  Values computed(const Part& part, const State& x, const Channels& u) {
    if (!part.steady) {
      put(x, u);
      part.formulas.evaluate();
    }
    return results<Values>(part);
  }

  std::shared_ptr<const surefoot::SimulatorInfo> info_;
  std::shared_ptr<const EquationPlan> plan_;
  std::vector<double> slots_;
  Formulas prepare_;
  Part change_, outputs_, efforts_, responses_;
  std::vector<Formulas> lets_;       // those that rates need, one by one, so that a tap can come between,
  Formulas after_lets_;              // and the formulas after them
  std::vector<Part> rates_without_;  // by state, without the signals that are held
  std::vector<bool> held_;
};

/// Surefoot's Simulator over these equations: vectors of a fixed size make simulations faster. Not to be shared between
/// threads; copies are.
template <class StateVector>
class OdeModelOf {
 public:
  using State = StateVector;
  using Input = Channels;
  using Output = Channels;

  explicit OdeModelOf(const ModelFile& model) : equations_(model) {}

  surefoot::SimulatorInfo info() const { return equations_.info(); }
  OdeModelOf for_recording(const surefoot::Recording& recording) const {
    OdeModelOf copy = *this;
    copy.equations_.take_constants(recording);
    return copy;
  }
  void prepare(const Eigen::VectorXd& p) { equations_.prepare(p); }

  State derivative(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/) const {
    return equations_.change(x, u);
  }
  template <class Tap>
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/, Tap&& tap) const {
    return equations_.change(x, u, tap);
  }
  double rate_without(const std::vector<bool>& signals, int state, const State& x, const Input& u) const {
    return equations_.rate_without(signals, state, x, u);
  }
  State effort(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/) const {
    return equations_.efforts(x, u);
  }
  State response(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/, const State& forces) const {
    return equations_.response(x, u, forces);
  }
  std::vector<State> unit_responses(const State& x, const Input& u, const std::vector<int>& states) const {
    return equations_.unit_responses(x, u, states);
  }
  Output observe(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/) const {
    return equations_.outputs(x, u);
  }

 private:
  mutable Equations equations_;  // computing fills its slots
};

/// With any number of states.
using OdeModel = OdeModelOf<Channels>;

/// Calls use(simulator), with vectors of a fixed size where there are few states.
template <class Use>
auto with_ode_model(const ModelFile& model, Use&& use) {
  switch (model.states.size()) {
    case 1:
      return use(OdeModelOf<surefoot::Vec<1>>(model));
    case 2:
      return use(OdeModelOf<surefoot::Vec<2>>(model));
    case 3:
      return use(OdeModelOf<surefoot::Vec<3>>(model));
    case 4:
      return use(OdeModelOf<surefoot::Vec<4>>(model));
    case 5:
      return use(OdeModelOf<surefoot::Vec<5>>(model));
    case 6:
      return use(OdeModelOf<surefoot::Vec<6>>(model));
    default:
      return use(OdeModel(model));
  }
}

class MapModel {
 public:
  using State = Channels;
  using Input = Channels;
  using Output = Channels;

  explicit MapModel(const ModelFile& model) : equations_(model) {}

  surefoot::SimulatorInfo info() const { return equations_.info(); }
  MapModel for_recording(const surefoot::Recording& recording) const {
    MapModel copy = *this;
    copy.equations_.take_constants(recording);
    return copy;
  }
  void prepare(const Eigen::VectorXd& p) { equations_.prepare(p); }

  State next(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/) const {
    return equations_.change(x, u);
  }
  template <class Tap>
  State next(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/, Tap&& tap) const {
    return equations_.change(x, u, tap);
  }
  Output observe(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/) const {
    return equations_.outputs(x, u);
  }

 private:
  mutable Equations equations_;
};

static_assert(surefoot::Simulator<OdeModel> && surefoot::Simulator<MapModel>);

}  // namespace diagnose_program
