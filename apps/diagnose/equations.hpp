// The equations of a model file as a simulator that can be diagnosed.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "equation_plan.hpp"
#include "formulas.hpp"
#include "model_file.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace diagnose_program {

/// Up to 16 numbers without memory from the heap.
using Channels = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, static_cast<int>(most_channels), 1>;

/// All quantities of a model, with the parsers that compute them. A copy has memory and parsers of its own, so that
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

  template <class Tap>
  Channels change(const Channels& x, const Channels& u, Tap&& tap) {
    if constexpr (std::is_same_v<std::remove_cvref_t<Tap>, surefoot::NoTap>) return change(x, u);
    put(x, u);
    for (std::size_t i = 0; i < lets_.size(); ++i) {
      lets_[i].evaluate();
      const int signal = plan_->change.signals[i];
      if (signal < 0) continue;
      double& value = slots_[static_cast<std::size_t>(plan_->change.lets[i].slot)];
      value = tap(signal, value);
    }
    change_.evaluate();
    return results(plan_->change);
  }

  Channels change(const Channels& x, const Channels& u);
  Channels outputs(const Channels& x, const Channels& u);
  Channels efforts(const Channels& x, const Channels& u);

 private:
  void build();
  void put(const Channels& x, const Channels& u) {
    std::copy(x.data(), x.data() + x.size(), slots_.data());
    std::copy(u.data(), u.data() + u.size(), slots_.data() + plan_->states);
  }
  Channels results(const PlanPart& part) const {
    Channels values(static_cast<Eigen::Index>(part.results.size()));
    for (std::size_t i = 0; i < part.results.size(); ++i) {
      values[static_cast<Eigen::Index>(i)] = slots_[static_cast<std::size_t>(part.results[i])];
    }
    return values;
  }

  std::shared_ptr<const surefoot::SimulatorInfo> info_;
  std::shared_ptr<const EquationPlan> plan_;
  std::vector<double> slots_;
  Formulas prepare_, whole_change_, change_, outputs_, efforts_;
  std::vector<Formulas> lets_;  // those that rates need, one by one, so that a tap can come between
};

/// Surefoot's Simulator over these equations. Not to be shared between threads; copies are.
class OdeModel {
 public:
  using State = Channels;
  using Input = Channels;
  using Output = Channels;

  explicit OdeModel(const ModelFile& model) : equations_(model) {}

  surefoot::SimulatorInfo info() const { return equations_.info(); }
  OdeModel for_recording(const surefoot::Recording& recording) const {
    OdeModel copy = *this;
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
  State effort(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/) const {
    return equations_.efforts(x, u);
  }
  Output observe(const State& x, const Input& u, const Eigen::VectorXd& /*prepared*/) const {
    return equations_.outputs(x, u);
  }

 private:
  mutable Equations equations_;  // computing fills its slots
};

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
