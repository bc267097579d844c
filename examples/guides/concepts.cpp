// The smallest type that conforms to each concept of the library, and what the library does with it. Exits with 1 if
// anything comes out otherwise than the page that quotes it says.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stop_token>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/motion/simulate_walk.hpp"
#include "surefoot/optimize/cma_es.hpp"

using namespace surefoot;

// [problem]
struct Integrator {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = Vec<1>;
  using Action = Vec<1>;
  Box<1> state_box() const { return Box<1>::symmetric(State(1)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(0.1)); }
  State initial_state(Rng& rng) const { return state_box().sample(rng); }
  Step<State> step(const State& s, const Action& a, Rng&) const {
    return {state_box().clamp(s + action_box().clamp(a)), -s.squaredNorm(), false};
  }
};
static_assert(Problem<Integrator>);
// [problem]

// [policy]
constexpr auto homewards = [](const Integrator::State& s) { return Integrator::Action(-0.5 * s); };
static_assert(Policy<decltype(homewards), Integrator>);
// [policy]

// [memory]
struct Hesitant {  // does nothing in every second step
  bool waits = false;
  void reset() { waits = false; }  // called on a copy at the start of every run
  Integrator::Action operator()(const Integrator::State& s) {
    waits = !waits;
    return waits ? Integrator::Action(0) : Integrator::Action(-0.5 * s);
  }
};
static_assert(Policy<Hesitant, Integrator>);
// [memory]

// [executor]
struct Backwards {  // results never depend on the order of jobs
  std::size_t width() const { return 1; }
  template <class Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    for (std::size_t i = count; i-- > 0;) {
      if (stop.stop_requested()) return false;
      job(i);
    }
    return true;
  }
};
static_assert(Executor<Backwards>);
// [executor]

// [leaf]
struct FirstSampleLeaf {
  static constexpr std::uint32_t tag = 1000;  // names the model in files; 0 to 999 are the library's
  static constexpr std::size_t parameters(int, int outputs) { return static_cast<std::size_t>(outputs); }
  static void fit(const LeafSamples& samples, const LeafOptions&, std::span<float> parameters) {
    std::copy_n(samples.output(0), parameters.size(), parameters.begin());
  }
  static void add(const float* parameters, const float*, int, int outputs, double* sum) {
    for (int o = 0; o < outputs; ++o) sum[o] += static_cast<double>(parameters[o]);
  }
};
static_assert(LeafModel<FirstSampleLeaf>);
// [leaf]

// [objective]
constexpr auto bowl = [](const Eigen::VectorXd& x) { return x.squaredNorm(); };
constexpr auto noisy_bowl = [](const Eigen::VectorXd& x, Rng& rng) { return x.squaredNorm() + 0.1 * rng.normal(); };
static_assert(Objective<decltype(bowl)> && Objective<decltype(noisy_bowl)>);
// [objective]

// [motion]
struct Scale {  // walks `scale` times as far as commanded
  static constexpr int parameter_count = 1;
  static std::array<ModelParameter, 1> parameter_info() { return {{{"scale", "1", 0.5, 2.0}}}; }
  static Scale from_parameters(const Vec<1>& p) { return {p[0]}; }
  Vec<1> parameters() const { return Vec<1>(scale); }
  Pose2 displacement(const Vec<3>& command) const { return Pose2::from_vec(scale * command); }
  double scale = 1;
};
static_assert(MotionModel<Scale>);
// [motion]

// [simulator]
struct Pendulum {
  using State = Vec<2>;   // angle [rad], speed [rad/s]
  using Input = Vec<1>;   // torque [N m]
  using Output = Vec<1>;  // angle [rad]
  SimulatorInfo info() const {
    return {.name = "pendulum",
            .states = {{"theta", "rad"}, {"omega", "rad/s"}},
            .inputs = {{"torque", "N m"}},
            .outputs = {{"theta_rad", "rad"}},
            .parameters = {{"inertia", "kg m^2", 0.01, 0.001, 0.1}}};
  }
  State derivative(const State& x, const Input& u, const Eigen::VectorXd& p) const {
    return {x[1], (u[0] - 0.1 * std::sin(x[0])) / p[0]};
  }
  Output observe(const State& x, const Input&, const Eigen::VectorXd&) const { return Output(x[0]); }
};
static_assert(Simulator<Pendulum>);
// [simulator]

// [effect]
inline Effect wind() {
  return {.name = "wind",
          .sentence = "a wind of {force} at {at}",
          .place = Place::velocity,
          .parameters =
              {{.name = "force", .measure = {.effort = 1}, .low = -3, .high = 3, .starts = {0.1}, .strength = true}},
          .force = [](const EffectContext&, Values p, Values) { return p[0]; }};
}
// [effect]

namespace {

bool expect(bool good, const char* what) {
  if (!good) std::printf("wrong: %s\n", what);
  return good;
}

bool problem_and_executor() {
  const RolloutOptions trials{.runs = 200, .horizon = 30};
  const double forwards = evaluate(Integrator{}, homewards, trials, Serial{}, 1).mean;
  const double backwards = evaluate(Integrator{}, homewards, trials, Backwards{}, 1).mean;
  const double hesitant = evaluate(Integrator{}, Hesitant{}, trials, Serial{}, 1).mean;
  return expect(forwards == backwards, "same bits in any order") && expect(forwards > hesitant, "waiting costs");
}

bool leaf() {
  const Dataset<1, 1> two{Eigen::RowVector2f(0, 1), Eigen::RowVector2d(3, 5), {}};
  const auto forest = train_extra_trees<FirstSampleLeaf>(two, {.min_leaf = 1}, Serial{}, 1);
  return expect(forest.predict(Vec<1>(-1))[0] == 3 && forest.predict(Vec<1>(2))[0] == 5, "a leaf for each sample");
}

bool objective() {
  const auto exact = cma_es(bowl, Eigen::Vector2d(1, 2), 0.5, {.target = 1e-9}, Serial{}, 1);
  return expect(exact.best_value < 1e-9, "minimum of the bowl");
}

bool motion() {
  const WalkSequence planned = planned_sequence(Eigen::Matrix3Xd(Vec<3>(0.1, 0, 0).replicate(1, 5)), true);
  return expect(std::abs(predict_final_pose(Scale{1.5}, planned).x - 0.75) < 1e-12, "five scaled steps");
}

bool simulator_and_effect() {
  Recording still;
  still.time.setLinSpaced(101, 0, 1);
  still.inputs.setZero(1, 101);
  still.outputs.setZero(1, 101);
  still.initial = still.initial_scale = Vec<2>::Zero();
  const Augmented windy{.effects = {{.name = "wind", .attached_to = "omega", .values = {0.5}}}};
  const double without = simulate_augmented(Pendulum{}, {}, still).outputs(0, 100);
  const double with = simulate_augmented(Pendulum{}, windy, still, {wind()}).outputs(0, 100);
  return expect(without == 0 && with > 0.05, "wind moves what hangs still");
}

}  // namespace

int main() { return problem_and_executor() && leaf() && objective() && motion() && simulator_and_effect() ? 0 : 1; }
