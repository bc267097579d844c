#include "surefoot/solve/rfpi.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/solve/temporary_file.hpp"
#include "tests/support/double_integrator.hpp"
#include "tests/support/pendulum.hpp"

namespace surefoot {
namespace {

// The double integrator; counts its steps and asks for a stop in the middle of the work.
struct Counted : toy::DoubleIntegrator {
  std::atomic<long>* steps_left = nullptr;
  std::stop_source* stop = nullptr;  // asked when steps_left is used up

  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    if (steps_left != nullptr && steps_left->fetch_sub(1, std::memory_order_relaxed) == 1) stop->request_stop();
    return DoubleIntegrator::step(state, action, rng);
  }
};
const Counted noisy{{.push = 0.02}};

// Every phase of the training on few samples: a run takes milliseconds.
RfpiOptions tiny() {
  RfpiOptions options;
  options.max_iterations = 9;
  options.horizon = 20;
  options.lookahead = {.candidates = 5, .samples = 2, .kept = 3, .refined = 5, .refined_samples = 2};
  options.value_forest.trees = options.policy_forest.trees = 3;
  options.first_states = 100;
  options.initial_iterations = 2;
  options.fixed_size_iterations = 4;
  options.evaluation_runs = 20;
  return options;
}

RfpiOptions tiny_paper() {
  RfpiOptions options = RfpiOptions::paper();
  options.max_iterations = 5;
  options.horizon = 15;
  options.value_runs = 3;
  options.lookahead.candidates = 10;
  options.lookahead.samples = 2;
  options.value_forest.trees = options.policy_forest.trees = 3;
  options.evaluation_runs = 20;
  return options;
}

template <Problem P>
void check_same(const RfpiResult<P>& a, const RfpiResult<P>& b) {
  CHECK(a.policy.forest() == b.policy.forest());
  CHECK(a.cost.mean == b.cost.mean);
  REQUIRE(a.history.size() == b.history.size());
  for (std::size_t i = 0; i < a.history.size(); ++i) {
    CHECK(a.history[i].iteration == b.history[i].iteration);
    CHECK(a.history[i].cost == b.history[i].cost);
    CHECK(a.history[i].best_cost == b.history[i].best_cost);
    CHECK(a.history[i].share == b.history[i].share);
    CHECK(a.history[i].states == b.history[i].states);
    CHECK(a.history[i].leaves == b.history[i].leaves);
  }
}

TEST_CASE("a few counted seconds come close to the known optimum of a linear-quadratic problem") {
  RfpiOptions options;
  options.budget.counted_seconds = 3;
  options.first_states = 1000;
  const double optimum = -toy::DoubleIntegratorOptimum(noisy, options.horizon).expected_return();
  const auto result = rfpi(noisy, options, Threads(2), 1);
  CHECK(result.cost.low() < 1.1 * optimum);
  CHECK(result.cost.high() > optimum);
  CHECK(result.stop == RfpiStop::budget);
  CHECK(result.history.back().share == doctest::Approx(1).epsilon(0.2));
}

TEST_CASE("a few counted seconds swing the pendulum up") {
  RfpiOptions options;
  options.budget.counted_seconds = 3;
  options.horizon = toy::Pendulum::horizon;
  const auto result = rfpi(toy::Pendulum{}, options, Threads(2), 1);
  CHECK(result.cost.mean < 500);  // standing still costs 1224
}

TEST_CASE("the published way improves much on the random policy within a few iterations") {
  RfpiOptions options = RfpiOptions::paper();
  options.max_iterations = 5;
  options.horizon = 30;
  options.value_runs = 5;
  options.lookahead.candidates = 30;
  options.lookahead.samples = 3;
  options.evaluation_runs = 200;
  const auto result = rfpi(noisy, options, Threads(2), 1);
  const RandomPolicy<1> random(noisy.action_box());
  const double before = -evaluate(noisy, random, {.runs = 800, .horizon = 30}, Threads(1), 1).mean;
  CHECK(result.cost.mean < 0.5 * before);
  CHECK(result.stop == RfpiStop::iterations);
  // Policy n is improved after n more runs, and all states are kept.
  for (std::size_t n = 1; n <= 5; ++n) CHECK(result.history[n - 1].states == 30 * n * (n + 1) / 2);
}

TEST_CASE("equal seeds give equal bits on any number of threads") {
  for (const RfpiOptions& options : {tiny(), tiny_paper()}) {
    const auto serial = rfpi(noisy, options, Threads(1), 1);
    check_same(serial, rfpi(noisy, options, Threads(2), 1));
    check_same(serial, rfpi(noisy, options, Threads(4), 1));
    CHECK(serial.policy.forest() != rfpi(noisy, options, Threads(1), 2).policy.forest());
  }
}

TEST_CASE("the history tells what happened") {
  std::vector<RfpiProgress> seen;
  RfpiOptions options = tiny();
  options.on_progress = [&](const RfpiProgress& progress) { seen.push_back(progress); };
  const auto result = rfpi(noisy, options, Threads(1), 1);
  REQUIRE(result.history.size() == 9);
  REQUIRE(seen.size() == 9);
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 9; ++i) {
    const RfpiProgress& now = result.history[i];
    CHECK(now.iteration == static_cast<int>(i) + 1);
    CHECK(seen[i].cost == now.cost);
    best = std::min(best, now.cost);
    CHECK(now.best_cost == best);
    CHECK(now.leaves >= 3);
    if (i > 0) {
      CHECK(now.share > result.history[i - 1].share);
      CHECK(now.seconds >= result.history[i - 1].seconds);
      CHECK(now.cpu_seconds >= result.history[i - 1].cpu_seconds);
    }
    if (i < 2) CHECK(now.states == 100);  // blind
    if (i > 5) CHECK(now.states > result.history[i - 1].states);
  }
  CHECK(result.cost.runs == 80);
  CHECK(result.stop == RfpiStop::iterations);
}

// Trains until the end in legs: each is stopped inside the work after some steps of the problem.
template <Executor E>
void check_legs(RfpiOptions options, const E& executor) {
  const auto whole = rfpi(noisy, options, Threads(1), 1);
  std::atomic<long> steps{1L << 40};
  std::stop_source never;
  rfpi(Counted{noisy, &steps, &never}, options, Threads(1), 1);
  const long total = (1L << 40) - steps;

  const toy::TemporaryFile file("legs");
  options.checkpoint = file.path.string();
  options.checkpoint_seconds = 0;
  Rng rng(3);
  int legs = 1;
  for (;; ++legs) {
    REQUIRE(legs < 50);
    std::stop_source stop;
    steps = static_cast<long>(rng.uniform(0.3, 0.5) * static_cast<double>(total));
    const auto result = rfpi(Counted{noisy, &steps, &stop}, options, executor, 1, {}, stop.get_token());
    options.resume = true;
    if (result.stop == RfpiStop::requested) {
      CHECK(result.history.size() < whole.history.size());
      continue;
    }
    check_same(whole, result);
    break;
  }
  CHECK(legs > 2);
}

TEST_CASE("a training stopped inside iterations and resumed gives the bits of one in one go") {
  check_legs(tiny(), Threads(1));
  check_legs(tiny(), Threads(2));
  check_legs(tiny_paper(), Threads(2));
}

TEST_CASE("a training stopped after any iteration and resumed gives the bits of one in one go") {
  RfpiOptions options = tiny();
  const auto whole = rfpi(noisy, options, Threads(1), 1);
  const toy::TemporaryFile file("stopped");
  options.checkpoint = file.path.string();
  for (int last = 1; last < 9; ++last) {
    std::stop_source stop;
    options.on_progress = [&](const RfpiProgress& now) {
      if (now.iteration == last) stop.request_stop();
    };
    options.resume = false;
    const auto part = rfpi(noisy, options, Threads(1), 1, {}, stop.get_token());
    CHECK(part.stop == RfpiStop::requested);
    CHECK(part.history.size() == static_cast<std::size_t>(last));
    options.on_progress = {};
    options.resume = true;
    check_same(whole, rfpi(noisy, options, Threads(1), 1));
  }
  check_same(whole, rfpi(noisy, options, Threads(1), 1));  // nothing is left to do
}

TEST_CASE("a resumed training without noise knows how long its runs were") {
  const toy::DoubleIntegrator problem;
  RfpiOptions options = tiny();
  options.horizon = 150;  // no run ends earlier: 15 steps of backups
  const toy::TemporaryFile file("lengths");
  const auto whole = rfpi(problem, options, Threads(1), 1);
  options.checkpoint = file.path.string();
  options.max_iterations = 5;
  rfpi(problem, options, Threads(1), 1);
  options.max_iterations = 9;
  options.resume = true;
  check_same(whole, rfpi(problem, options, Threads(2), 1));
}

TEST_CASE("a checkpoint keeps whether lookaheads follow the policy") {
  const toy::TemporaryFile file("follows");
  for (const bool follows : {false, true}) {
    RfpiState<toy::DoubleIntegrator> state;
    state.follows = follows;
    save_checkpoint(file.path.string(), 7, state);
    CHECK(load_checkpoint<toy::DoubleIntegrator>(file.path.string(), 7).follows == follows);
  }
}

TEST_CASE("a checkpoint keeps the kind of opinions that did best") {
  const toy::TemporaryFile file("opinions");
  for (const OpinionsOf opinions : {OpinionsOf::distances, OpinionsOf::actions}) {
    RfpiState<toy::DoubleIntegrator> state;
    state.opinions = opinions;
    save_checkpoint(file.path.string(), 7, state);
    CHECK(load_checkpoint<toy::DoubleIntegrator>(file.path.string(), 7).opinions == opinions);
  }
}

TEST_CASE("no state outside of the box is learnt from, however unstable the runs") {
  struct Unstable : toy::DoubleIntegrator {
    Step<State> step(const State& state, const Action& action, Rng& rng) const {
      Step<State> step = DoubleIntegrator::step(state, action, rng);
      step.next *= 1.5;
      return step;
    }
  };
  const Unstable problem;
  const RfpiOptions options = detail::without_noise(tiny());
  const auto states_of = [&](const RfpiState<Unstable>& before) {
    RfpiWork work;
    return detail::choose_states(problem, options, before, 500, {}, Serial{}, Rng(1), work, {});
  };
  RfpiState<Unstable> before;
  const auto first = states_of(before);
  Dataset<2, 1> data;  // a policy that pushes away
  data.inputs = Eigen::MatrixXf::Random(2, 50);
  data.outputs = Eigen::MatrixXd::Constant(1, 50, 1.5);
  before.policy = train_extra_trees<LinearLeaf>(data, {.trees = 2}, Serial{}, 1);
  before.iteration = options.initial_iterations;
  const auto later = states_of(before);
  for (const auto* states : {&first, &later}) {
    CHECK(states->size() >= 250);
    CHECK(std::ranges::all_of(*states, [&](const auto& state) { return problem.state_box().contains(state); }));
  }
}

TEST_CASE("a checkpoint keeps for how long runs are in transition") {
  const toy::TemporaryFile file("transient");
  RfpiState<toy::DoubleIntegrator> state;
  state.transient = 17;
  save_checkpoint(file.path.string(), 7, state);
  CHECK(load_checkpoint<toy::DoubleIntegrator>(file.path.string(), 7).transient == 17);
}

TEST_CASE("half of the states that runs visit are of their transient") {
  struct Clock : toy::DoubleIntegrator {  // the first number of a state counts transitions
    State initial_state(Rng&) const { return State::Zero(); }
    Step<State> step(const State& state, const Action&, Rng&) const { return {state + State(0.01, 0), 0, false}; }
  };
  const Clock clock;
  RfpiOptions options = resolved({.horizon = 20});
  RfpiState<Clock> before;
  before.iteration = options.initial_iterations;
  before.policy = train_extra_trees<LinearLeaf>(
      Dataset<2, 1>{Eigen::MatrixXf::Random(2, 50), Eigen::MatrixXd::Constant(1, 50, 0.0), {}}, {.trees = 2}, Serial{},
      1);
  const auto early = [&](int transient, bool adapt) {
    before.transient = transient;
    options.adapt = adapt;
    RfpiWork work;
    const auto states = detail::choose_states(clock, options, before, 1000, {}, Serial{}, Rng(1), work, {});
    return std::ranges::count_if(states, [](const auto& s) { return s[1] == 0 && s[0] < 0.045; });  // of five steps
  };
  CHECK(early(5, true) == doctest::Approx(250 + 250 / 4).epsilon(0.1));  // of 500 that are visited
  CHECK(early(20, true) == doctest::Approx(500 / 4).epsilon(0.1));
  CHECK(early(0, true) == early(20, true));
  CHECK(early(5, false) == early(20, true));
}

TEST_CASE("states that share a leaf are sorted next to each other, and none is lost") {
  const toy::DoubleIntegrator problem;
  Rng rng(1);
  std::vector<Vec<2>> states;
  for (int i = 0; i < 300; ++i) states.push_back(problem.state_box().sample(rng));
  Dataset<2, 1> data;
  data.inputs = Eigen::MatrixXf::Random(2, 500);
  data.outputs = Eigen::MatrixXd::Random(1, 500);
  const auto forest = train_extra_trees<LinearLeaf>(data, {.trees = 3, .min_leaf = 20}, Serial{}, 1);
  const auto by_numbers = [](const Vec<2>& a, const Vec<2>& b) {
    return std::pair(a[0], a[1]) < std::pair(b[0], b[1]);
  };
  std::vector<Vec<2>> sorted = states;
  detail::sort_by_leaves(problem, forest, sorted);
  std::vector<std::uint32_t> leaves(forest.trees());
  std::uint32_t before = 0;
  for (const Vec<2>& state : sorted) {
    forest.leaf_indices(state, leaves);
    CHECK(leaves[0] >= before);
    before = leaves[0];
  }
  CHECK(before > 0);
  std::ranges::sort(sorted, by_numbers);
  std::ranges::sort(states, by_numbers);
  CHECK(sorted == states);
  detail::sort_by_leaves(problem, decltype(forest){}, sorted);  // there are no leaves yet
  CHECK(sorted == states);
}

TEST_CASE("a training that resumes from nothing starts anew") {
  const toy::TemporaryFile file("fresh");
  RfpiOptions options = tiny();
  const auto whole = rfpi(noisy, options, Threads(1), 1);
  options.checkpoint = file.path.string();
  options.resume = true;
  check_same(whole, rfpi(noisy, options, Threads(1), 1));
  CHECK(std::filesystem::exists(file.path));
}

TEST_CASE("a checkpoint that cannot be written is told by name") {
  const toy::TemporaryFile file("nowhere");
  RfpiOptions options = tiny();
  options.checkpoint = (file.path / "checkpoint").string();
  CHECK_THROWS_WITH_AS(rfpi(noisy, options, Threads(1), 1), doctest::Contains(options.checkpoint.c_str()), CoreError);
}

TEST_CASE("a budget in counted seconds ends the same way after a resume") {
  RfpiOptions options = tiny();
  options.max_iterations = 0;
  options.budget.counted_seconds = 0.06;
  const auto whole = rfpi(noisy, options, Threads(1), 1);
  CHECK(whole.stop == RfpiStop::budget);
  REQUIRE(whole.history.size() > 5);
  const toy::TemporaryFile file("budget");
  options.checkpoint = file.path.string();
  options.max_iterations = 5;
  rfpi(noisy, options, Threads(1), 1);
  options.max_iterations = 0;
  options.resume = true;
  check_same(whole, rfpi(noisy, options, Threads(1), 1));
}

TEST_CASE("a training whose process was killed gives the bits of one in one go after a resume") {
  RfpiOptions options = tiny();
  const auto whole = rfpi(noisy, options, Threads(1), 1);
  const toy::TemporaryFile file("killed");
  options.checkpoint = file.path.string();
  options.checkpoint_seconds = 0;
  for (const int last : {2, 5}) {
    int channel[2];
    REQUIRE(pipe(channel) == 0);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {  // tells of every iteration, and would never end by itself
      options.on_progress = [&](const RfpiProgress& now) {
        if (::write(channel[1], "i", 1) != 1 || now.iteration == 8) pause();
      };
      rfpi(noisy, options, Threads(1), 1);
      _exit(0);
    }
    close(channel[1]);
    char byte = 0;
    for (int i = 0; i <= last; ++i) REQUIRE(::read(channel[0], &byte, 1) == 1);  // the one before is in the checkpoint
    kill(child, SIGKILL);
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    close(channel[0]);
    REQUIRE(WIFSIGNALED(status));
    RfpiOptions rest = options;
    rest.resume = true;
    int first = 0;
    rest.on_progress = [&](const RfpiProgress& now) {
      if (first == 0) first = now.iteration;
    };
    check_same(whole, rfpi(noisy, rest, Threads(1), 1));
    CHECK(first > last);
    std::filesystem::remove(file.path);
  }
}

TEST_CASE("a checkpoint of another run is refused in words") {
  const toy::TemporaryFile file("other");
  RfpiOptions options = tiny();
  options.checkpoint = file.path.string();
  options.max_iterations = 2;
  rfpi(noisy, options, Threads(1), 1);
  options.resume = true;
  const std::vector<Vec<2>> seeds{Vec<2>(0.5, 0)};
  const auto refused = [](const Counted& problem, const RfpiOptions& o, std::uint64_t seed,
                          std::span<const Vec<2>> states) {
    CHECK_THROWS_WITH_AS(rfpi(problem, o, Threads(1), seed, states),
                         doctest::Contains("another problem, other options or another seed"), SolveError);
  };
  refused(noisy, options, 2, {});
  refused(noisy, options, 1, seeds);
  refused(Counted{{.push = 0.03}}, options, 1, {});
  const std::vector<std::function<void(RfpiOptions&)>> changes{
      [](RfpiOptions& o) { o.discount = 0.97; },
      [](RfpiOptions& o) { o.horizon = 21; },
      [](RfpiOptions& o) { o.first_states = 101; },
      [](RfpiOptions& o) { o.lookahead.softness = 0.2; },
      [](RfpiOptions& o) { o.value_forest.ridge = 2; },
      [](RfpiOptions& o) { o.policy_forest.max_leaves = 7; },
      [](RfpiOptions& o) { o.reuse_previous_samples = false; },
      [](RfpiOptions& o) { o.value_method = ValueMethod::rollouts; },
      [](RfpiOptions& o) { o.agreement = 0.6; },
      [](RfpiOptions& o) { o.adapt = false; },
      [](RfpiOptions& o) { o.lookahead.hold = 2; },
      [](RfpiOptions& o) { o.evaluation_runs = 21; }};
  for (const auto& change : changes) {
    RfpiOptions changed = options;
    change(changed);
    refused(noisy, changed, 1, {});
  }
  CHECK(rfpi(noisy, options, Threads(1), 1).history.size() == 2);
}

TEST_CASE("a damaged checkpoint is refused") {
  const toy::TemporaryFile file("damaged");
  RfpiOptions options = tiny();
  options.checkpoint = file.path.string();
  options.max_iterations = 7;
  options.first_states = 20;
  options.value_forest.trees = options.policy_forest.trees = 1;
  const auto whole = rfpi(noisy, options, Threads(1), 1);
  options.resume = true;
  const Bytes bytes = read_file(file.path);
  const auto loads = [&](const Bytes& changed) {
    write_file_atomically(file.path, changed);
    try {
      rfpi(noisy, options, Threads(1), 1);
    } catch (const Error&) {
      return false;
    }
    return true;
  };
  Rng rng(1);
  const auto size = static_cast<std::uint32_t>(bytes.size());
  int loaded = 0;
  for (int i = 0; i < 500; ++i) {
    Bytes changed = bytes;
    changed[i % 2 == 0 ? rng.below(size) : rng.below(100)] ^= static_cast<std::byte>(1U << rng.below(8));
    if (loads(changed)) ++loaded;
    changed = bytes;
    changed.resize(rng.below(size));
    if (loads(changed)) ++loaded;
  }
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  if (loads(longer)) ++loaded;
  CHECK(loaded == 0);
  CHECK(loads(bytes));
  write_file_atomically(file.path, std::string_view("something else entirely"));
  CHECK_THROWS_WITH_AS(rfpi(noisy, options, Threads(1), 1), doctest::Contains("is not a checkpoint"), CoreError);
}

TEST_CASE("states from outside are learnt from") {
  RfpiOptions options = tiny();
  const auto alone = rfpi(noisy, options, Threads(1), 1);
  std::vector<Vec<2>> seeds;
  for (int i = 0; i < 300; ++i) seeds.emplace_back(0.001 * i, 0);
  for (const std::size_t count : {1U, 50U, 300U}) {  // 300: more than an iteration takes
    const auto with = rfpi(noisy, options, Threads(1), 1, std::span(seeds).first(count));
    CHECK(with.history.size() == 9);
    CHECK(with.history[0].states == 100);
    CHECK(with.policy.forest() != alone.policy.forest());
  }
  const auto paper = rfpi(noisy, tiny_paper(), Threads(1), 1, std::span(seeds).first(50));
  for (std::size_t n = 1; n <= 5; ++n) CHECK(paper.history[n - 1].states == 50 + 15 * n * (n + 1) / 2);
}

TEST_CASE("the wall clock ends a training, says so, and leaves a policy") {
  RfpiOptions options = tiny();
  options.max_iterations = 0;
  options.growth = 1;
  options.budget.counted_seconds = 1e6;
  options.max_seconds = 0.5;
  const auto result = rfpi(noisy, options, Threads(2), 1);
  CHECK(result.stop == RfpiStop::wall_clock);
  CHECK(result.history.back().seconds < 10);
  CHECK(result.history.back().share < 0.1);
  CHECK(result.policy.forest().leaves() > 0);
  options.max_iterations = 2;
  options.max_seconds = std::numeric_limits<double>::max();  // does not overflow
  CHECK(rfpi(noisy, options, Threads(1), 1).stop == RfpiStop::iterations);
}

std::stop_token already_requested() {
  std::stop_source stop;
  stop.request_stop();
  return stop.get_token();
}

TEST_CASE("a stop before there is a policy is told in words") {
  for (const RfpiOptions& options : {tiny(), tiny_paper()}) {
    CHECK_THROWS_WITH_AS(rfpi(noisy, options, Threads(1), 1, {}, already_requested()),
                         "rfpi: stopped before there was a first policy: give it more time", SolveError);
    CHECK_THROWS_AS(rfpi(noisy, options, Threads(2), 1, {}, already_requested()), SolveError);
  }
}

TEST_CASE("a callback that throws ends the training") {
  RfpiOptions options = tiny();
  options.on_progress = [](const RfpiProgress&) { throw std::runtime_error("enough"); };
  CHECK_THROWS_WITH(rfpi(noisy, options, Threads(2), 1), "enough");
}

TEST_CASE("every bad option is refused in a sentence that names it") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  struct Bad {
    const char* name;
    std::function<void(RfpiOptions&)> make;
  };
  const std::vector<Bad> table{
      {"budget.counted_seconds", [](RfpiOptions& o) { o.budget.counted_seconds = 0; }},
      {"budget.counted_seconds", [](RfpiOptions& o) { o.budget.counted_seconds = nan; }},
      {"max_seconds", [](RfpiOptions& o) { o.max_seconds = -1; }},
      {"budget.step_ns", [](RfpiOptions& o) { o.budget.step_ns = -1; }},
      {"discount", [](RfpiOptions& o) { o.discount = -0.1; }},
      {"discount", [](RfpiOptions& o) { o.discount = 1.01; }},
      {"horizon", [](RfpiOptions& o) { o.horizon = 0; }},
      {"max_iterations", [](RfpiOptions& o) { o.max_iterations = -1; }},
      {"first_states", [](RfpiOptions& o) { o.first_states = 0; }},
      {"max_states", [](RfpiOptions& o) { o.max_states = 99; }},
      {"growth", [](RfpiOptions& o) { o.growth = 0.9; }},
      {"initial_iterations", [](RfpiOptions& o) { o.initial_iterations = 0; }},
      {"box_share", [](RfpiOptions& o) { o.box_share = 1.1; }},
      {"visited_share", [](RfpiOptions& o) { o.visited_share = -0.1; }},
      {"exploration", [](RfpiOptions& o) { o.exploration = nan; }},
      {"backup_weight", [](RfpiOptions& o) { o.backup_weight = 2; }},
      {"backup_steps", [](RfpiOptions& o) { o.backup_steps = -1; }},
      {"backup_runs", [](RfpiOptions& o) { o.backup_runs = 0; }},
      {"value_runs", [](RfpiOptions& o) { o.value_runs = 0; }},
      {"lookahead.candidates", [](RfpiOptions& o) { o.lookahead.candidates = 0; }},
      {"lookahead.samples", [](RfpiOptions& o) { o.lookahead.samples = 0; }},
      {"lookahead.kept", [](RfpiOptions& o) { o.lookahead.kept = 0; }},
      {"lookahead.refined", [](RfpiOptions& o) { o.lookahead.refined = -1; }},
      {"lookahead.refined_samples", [](RfpiOptions& o) { o.lookahead.refined_samples = 0; }},
      {"lookahead.softness", [](RfpiOptions& o) { o.lookahead.softness = nan; }},
      {"lookahead.step", [](RfpiOptions& o) { o.lookahead.step = -1; }},
      {"lookahead.radius", [](RfpiOptions& o) { o.lookahead.radius = -1; }},
      {"lookahead.hold", [](RfpiOptions& o) { o.lookahead.hold = 0; }},
      {"lookahead.follow", [](RfpiOptions& o) { o.lookahead.follow = -1; }},
      {"agreement", [](RfpiOptions& o) { o.agreement = 0; }},
      {"evaluation_runs", [](RfpiOptions& o) { o.evaluation_runs = 1; }},
      {"resume", [](RfpiOptions& o) { o.resume = true; }},
      {"min_leaf", [](RfpiOptions& o) { o.value_forest.min_leaf = 0; }},
      {"trees", [](RfpiOptions& o) { o.policy_forest.trees = 0; }},
  };
  for (const Bad& bad : table) {
    RfpiOptions options = tiny();
    bad.make(options);
    CAPTURE(bad.name);
    CHECK_THROWS_WITH_AS(rfpi(noisy, options, Threads(1), 1), doctest::Contains("RfpiOptions: "), SolveError);
    CHECK_THROWS_WITH_AS(rfpi(noisy, options, Threads(1), 1), doctest::Contains(bad.name), SolveError);
  }
}

TEST_CASE("every reason to stop has a sentence of its own") {
  CHECK(explain(RfpiStop::budget) == "the budget is used up");
  CHECK(explain(RfpiStop::iterations) == "all iterations are done");
  CHECK(explain(RfpiStop::wall_clock).find("speed of this machine") != std::string::npos);
  CHECK(explain(RfpiStop::requested) == "it was asked to stop");
}

// The smallest problem with an end: every run is over after its first step.
struct OneStep {
  static constexpr int state_dim = 1, action_dim = 1;
  using State = Vec<1>;
  using Action = Vec<1>;
  Box<1> state_box() const { return Box<1>::symmetric(State(1)); }
  Box<1> action_box() const { return Box<1>::symmetric(Action(1)); }
  State initial_state(Rng& rng) const { return state_box().sample(rng); }
  Step<State> step(const State& state, const Action& action, Rng&) const {
    return {state, -(action - 0.5 * state).squaredNorm(), true};
  }
};

TEST_CASE("a problem whose runs end at once is solved by both methods") {
  for (RfpiOptions options : {tiny(), tiny_paper()}) {
    options.max_iterations = 20;
    const auto result = rfpi(OneStep{}, options, Threads(2), 1);
    CHECK(result.cost.mean < 0.02);  // the action 0 costs 1 / 12 on average
  }
}

}  // namespace
}  // namespace surefoot
