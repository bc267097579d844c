// What a training and a cross-validation cost on several processes, and what travels between them:
//   mpirun -n 2 mpi_benchmark rfpi BUDGET | curve REPETITIONS
// Prints one line of CSV per iteration of RFPI, or one in all; times in seconds of the first process.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>

#include "examples/sigmaban/approach/approach.hpp"
#include "examples/sigmaban/approach/seed_states.hpp"
#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/plan.hpp"
#include "surefoot/mpi/mpi_executor.hpp"
#include "surefoot/mpi/mpi_session.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "tests/support/walks.hpp"

namespace {

using surefoot::MpiExecutor;
using surefoot::MpiUse;

// The time and the use of the executor since the last call.
class Meter {
 public:
  explicit Meter(const MpiExecutor& executor) : executor_(executor) {}

  void print(const std::string& what, std::size_t states, std::size_t leaves) {
    const auto now = std::chrono::steady_clock::now();
    const MpiUse& use = executor_.use();
    std::printf("%zu,%s,%zu,%zu,%.4f,%.4f,%.4f,%llu,%llu\n", executor_.processes(), what.c_str(), states, leaves,
                std::chrono::duration<double>(now - before_).count(), use.job_seconds - used_.job_seconds,
                use.exchange_seconds - used_.exchange_seconds,
                static_cast<unsigned long long>(use.rounds - used_.rounds),
                static_cast<unsigned long long>(use.bytes - used_.bytes));
    std::fflush(stdout);
    before_ = now;
    used_ = use;
  }

 private:
  const MpiExecutor& executor_;
  MpiUse used_;
  std::chrono::steady_clock::time_point before_ = std::chrono::steady_clock::now();
};

void train(const MpiExecutor& executor, double budget) {
  const auto problem = sigmaban::Approach::ha();
  surefoot::RfpiOptions options;
  options.budget.counted_seconds = budget;
  Meter meter(executor);
  options.on_progress = [&](const surefoot::RfpiProgress& p) {
    meter.print("iteration " + std::to_string(p.iteration), p.states, p.leaves);
  };
  const auto result = surefoot::rfpi(problem, options, executor, 1, sigmaban::seed_states(problem, 1));
  surefoot::once(executor, [&] { std::fprintf(stderr, "cost %.17g\n", result.cost.mean); });
}

void draw_curve(const MpiExecutor& executor, std::size_t repetitions) {
  const auto walks = toys::final_poses(toys::walks(toys::paper_walk(), toys::paper_noise(), 25, 1));
  const surefoot::LearningCurveOptions options{.counts = {2, 5, 10, 20}, .repetitions = repetitions};
  Meter meter(executor);
  const auto curve = surefoot::learning_curve<surefoot::FullLinearCorrection>(
      std::span<const surefoot::WalkSequence>(walks), options, executor, 1);
  surefoot::once(executor, [&] {
    meter.print("curve", 0, 0);
    std::fprintf(stderr, "error %.17g m\n", curve.position[3]);
  });
}

}  // namespace

int main(int argc, char** argv) {
  surefoot::MpiSession session(argc, argv);
  const std::string what = argc == 3 ? argv[1] : "";
  const double amount = argc == 3 ? std::atof(argv[2]) : 0;
  if ((what != "rfpi" && what != "curve") || !(amount > 0)) {
    return session.end(2, "usage: mpi_benchmark rfpi BUDGET | curve REPETITIONS\n");
  }
  const MpiExecutor executor(MPI_COMM_WORLD);
  surefoot::once(executor, [] { std::puts("processes,what,states,leaves,wall,jobs,exchange,rounds,bytes"); });
  if (what == "rfpi") {
    train(executor, amount);
  } else {
    draw_curve(executor, static_cast<std::size_t>(amount));
  }
  return session.end(0, "");
}
