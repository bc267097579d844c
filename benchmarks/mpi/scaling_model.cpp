// How RFPI on the ball approach would scale, from one process: every job of a training is timed, every byte counted,
// and the training is then dealt out to 1 ... 512 processes on paper.
//   scaling_model BUDGET
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "benchmarks/mpi/traced_executor.hpp"
#include "examples/sigmaban/approach/approach.hpp"
#include "examples/sigmaban/approach/seed_states.hpp"
#include "surefoot/solve/rfpi.hpp"

int main(int argc, char** argv) {
  const double budget = argc == 2 ? std::atof(argv[1]) : 0;
  if (!(budget > 0)) {
    std::fputs("usage: scaling_model BUDGET\n", stderr);
    return 2;
  }
  const auto problem = sigmaban::Approach::ha();
  surefoot::RfpiOptions options;
  options.budget.counted_seconds = budget;
  const scaling::TracedExecutor executor;
  std::size_t told = 0;
  std::puts("iteration  states  leaves of the policy  rounds     bytes  bytes per state  job seconds");
  options.on_progress = [&](const surefoot::RfpiProgress& p) {
    std::size_t bytes = 0;
    double jobs = 0;
    const std::size_t first = std::exchange(told, executor.rounds().size());
    for (std::size_t i = first; i < told; ++i) {
      bytes += executor.rounds()[i].bytes;
      for (const double seconds : executor.rounds()[i].jobs) jobs += seconds;
    }
    std::printf("%9d %7zu %21zu %7zu %9zu %16.1f %12.3f\n", p.iteration, p.states, p.leaves, told - first, bytes,
                static_cast<double>(bytes) / static_cast<double>(p.states), jobs);
  };
  const double began = scaling::cpu_seconds();
  surefoot::rfpi(problem, options, executor, 1, sigmaban::seed_states(problem, 1));
  const double all = scaling::cpu_seconds() - began;

  double known = 0;
  std::size_t bytes = 0;
  for (const scaling::Round& round : executor.rounds()) {
    for (const double seconds : round.jobs) known += seconds;
    known += round.pack + round.unpack;
    bytes += round.bytes;
  }
  const scaling::Network networks[] = {{"10 Gbit/s Ethernet", 20e-6, 1.1e9}, {"100 Gbit/s InfiniBand", 2e-6, 11e9}};
  const double replicated = all - known;  // what every process does: choosing states, preparing samples
  const double one = replicated + scaling::predict(executor.rounds(), 1, networks[0]).jobs;
  std::printf("\n%zu rounds, %.1f MB in all, %.1f s on one process of which %.2f s are done by every process\n",
              executor.rounds().size(), 1e-6 * static_cast<double>(bytes), one, replicated);
  for (const scaling::Network& network : networks) {
    std::printf("\n%s\nprocesses  jobs [s]  by all [s]  packing [s]  network [s]  speed-up\n", network.name);
    for (std::size_t processes = 1; processes <= 512; processes *= 2) {
      const scaling::Prediction part = scaling::predict(executor.rounds(), processes, network);
      const double sum = part.jobs + replicated + part.packing + part.network;
      std::printf("%9zu %9.2f %11.2f %12.3f %12.3f %9.2f\n", processes, part.jobs, replicated, part.packing,
                  part.network, one / sum);
    }
  }
}
