#include "surefoot/solve/rfpi.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>

#include "surefoot/core/any_executor.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/mpi/mpi_executor.hpp"
#include "tests/solve/temporary_file.hpp"
#include "tests/support/pendulum.hpp"

namespace surefoot {
namespace {

using toy::Pendulum;

RfpiOptions tiny(RfpiOptions options = {}) {
  options.max_iterations = 4;
  options.horizon = 20;
  options.lookahead = {.candidates = 5, .samples = 2, .kept = 3, .refined = 5, .refined_samples = 2};
  options.value_forest.trees = options.policy_forest.trees = 3;
  options.first_states = 200;
  options.initial_iterations = 2;
  options.fixed_size_iterations = 2;
  options.value_runs = 3;
  options.evaluation_runs = 100;
  return options;
}

void check_same(const RfpiResult<Pendulum>& a, const RfpiResult<Pendulum>& b) {
  CHECK(a.policy.forest() == b.policy.forest());
  CHECK(a.cost.mean == b.cost.mean);
  REQUIRE(a.history.size() == b.history.size());
  for (std::size_t i = 0; i < a.history.size(); ++i) {
    CHECK(a.history[i].cost == b.history[i].cost);
    CHECK(a.history[i].counted_seconds == b.history[i].counted_seconds);
  }
}

// One name for all processes.
struct SharedFile {
  toy::TemporaryFile own{"mpi_rfpi"};
  std::filesystem::path path;
  explicit SharedFile(const MpiExecutor& executor)
      : path(map(executor, 1, [&](std::size_t) { return own.path.string(); })[0]) {}
};

// In all processes, and in each by itself. Of one type, so that the solver is compiled once.
RfpiResult<Pendulum> learn(const RfpiOptions& options, std::size_t threads = 1, std::stop_token stop = {}) {
  const AnyExecutor executor(std::make_unique<MpiExecutor>(MPI_COMM_WORLD, threads));
  return rfpi(Pendulum{}, options, executor, 1, {}, std::move(stop));
}
RfpiResult<Pendulum> learn_alone(const RfpiOptions& options) {
  return rfpi(Pendulum{}, options, AnyExecutor(std::make_unique<Serial>()), 1);
}

TEST_CASE("several processes learn the policy of one, by either method") {
  for (const RfpiOptions& options : {tiny(), tiny(RfpiOptions::paper())}) {
    const auto serial = learn_alone(options);
    check_same(serial, learn(options));
    check_same(serial, learn(options, 2));
  }
}

TEST_CASE("one process tells the progress and writes the checkpoint, all go on from it") {
  const MpiExecutor executor(MPI_COMM_WORLD);
  const auto whole = learn_alone(tiny());
  const SharedFile file(executor);
  int told = 0;
  RfpiOptions options = tiny();
  options.checkpoint = file.path;
  options.resume = true;  // nothing there yet
  options.max_iterations = 2;
  options.on_progress = [&](const RfpiProgress&) { ++told; };
  learn(options);
  CHECK(told == (executor.rank() == 0 ? 2 : 0));
  options.max_iterations = 4;
  check_same(whole, learn(options));
  options.max_iterations = 4;
  check_same(whole, learn_alone(options));  // alone, from the file that many wrote
}

TEST_CASE("a stop in one process ends the training in all at the same iteration") {
  const MpiExecutor executor(MPI_COMM_WORLD);
  const auto whole = learn_alone(tiny());
  const SharedFile file(executor);
  RfpiOptions options = tiny();
  options.checkpoint = file.path;
  options.checkpoint_seconds = 0;
  std::stop_source source;
  options.on_progress = [&](const RfpiProgress& progress) {  // in the first process only
    if (progress.iteration == 2) source.request_stop();
  };
  const auto stopped = learn(options, 1, source.get_token());
  CHECK(stopped.stop == RfpiStop::requested);
  CHECK(stopped.history.size() == 2);
  CHECK(source.stop_requested() == (executor.rank() == 0));
  options.resume = true;
  options.on_progress = {};
  check_same(whole, learn(options));
}

TEST_CASE("a limit by the clock ends the training in all processes together") {
  const MpiExecutor executor(MPI_COMM_WORLD);
  RfpiOptions options = tiny();
  options.max_iterations = 0;
  options.budget.counted_seconds = 1e6;
  const auto limited = [&](double seconds) {
    options.max_seconds = seconds + static_cast<double>(executor.rank());
    return learn(options);
  };
  std::optional<RfpiResult<Pendulum>> result;
  for (double seconds = 0.5; !result; seconds *= 2) {
    REQUIRE(seconds < 100);
    try {
      result = limited(seconds);
    } catch (const SolveError&) {  // a busy machine has no policy yet
    }
  }
  CHECK(result->stop == RfpiStop::wall_clock);
  const auto costs = map(executor, executor.processes(), [&](std::size_t) { return result->cost.mean; });
  for (const double cost : costs) CHECK(cost == costs[0]);
}

TEST_CASE("a checkpoint that cannot be written or read ends all processes with the same words") {
  RfpiOptions options = tiny();
  options.checkpoint = "no/such/folder/checkpoint";
  CHECK_THROWS_WITH_AS(
      learn(options),
      doctest::Contains("file no/such/folder/checkpoint cannot be written: check that its folder exists"), CoreError);
  const MpiExecutor executor(MPI_COMM_WORLD);
  const SharedFile file(executor);
  once(executor, [&] { write_file_atomically(file.path, "SURE"); });
  options.checkpoint = file.path;
  options.resume = true;
  CHECK_THROWS_WITH_AS(learn(options), doctest::Contains("ends too early"), CoreError);
}

}  // namespace
}  // namespace surefoot
