// `export`: a policy as one C file for the robot's computer, distilled to a smaller one where it must be small.
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "../../../apps/common/files.hpp"
#include "any_policy.hpp"
#include "commands.hpp"
#include "distill.hpp"
#include "motion.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/forest/short_floats.hpp"
#include "surefoot/solve/export_policy.hpp"
#include "surefoot/solve/forest_policy.hpp"

namespace sigmaban {
namespace {

using example::prepare_output;
using example::write_text;

struct ExportOptions {
  std::filesystem::path policy, out;
  std::string motion;
  std::size_t max_kb = 2000;  // [1000 bytes]
  int runs = DistillOptions{}.runs;
  int trials = 10'000;
  std::uint64_t seed = 1;
  std::size_t threads = 0;
};

/// The problem, `named` ha or anha, is the one whose action box the file holds.
template <class Named>
auto load_forest(const std::filesystem::path& path, Named&& named) {
  try {
    return surefoot::load_policy(named("ha"), path);
  } catch (const surefoot::SolveError&) {
    return surefoot::load_policy(named("anha"), path);
  }
}

std::string braces(const auto& numbers) {
  std::string list = "{";
  char text[40];
  for (const double number : numbers) {
    std::snprintf(text, sizeof text, "%.17g, ", number);
    list += text;
  }
  list.resize(list.size() - 2);
  return list + "}";
}

/// What a walk does at a speed that stays the same.
Eigen::Matrix<double, 3, 4> steady_walk(const surefoot::FullLinearCorrection& walk) { return walk.matrix(); }
Eigen::Matrix<double, 3, 4> steady_walk(const surefoot::PreviousCommandCorrection& walk) {
  Eigen::Matrix<double, 3, 4> result = walk.present().matrix();
  result.rightCols<3>() += walk.previous();
  return result;
}

/// The same sums in C, in the same order, as Approach::features makes.
template <class Problem>
std::string wrapper(const Problem& problem) {
  const ApproachConstants& c = problem.constants;
  std::string walk;
  const Eigen::Matrix<double, 3, 4> steady = steady_walk(problem.walk);
  for (int row = 0; row < 3; ++row) walk += (row == 0 ? "" : ", ") + braces(steady.row(row));
  // Calibrated displacements are seen from the robot as it was before it turned.
  const std::string turned = c.turn_first ? "" : R"(
  ck = cos(move[2]);
  sk = sin(move[2]);
  x = ck * move[0] + sk * move[1];
  move[1] = ck * move[1] - sk * move[0];
  move[0] = x;)";
  return R"(#include <math.h>

/* state: ball distance [m], ball direction [rad], kick direction [rad], commanded speed forward, left [m/step], turn
   [rad/step]; x forward, y left, angles counterclockwise in [-pi, pi). action: what to add to the commanded speed, once
   per walk cycle, in the same units. */
void surefoot_policy(const double state[6], double action[3]);
void surefoot_policy(const double state[6], double action[3]) {
  static const double walk[3][4] = {)" +
         walk + R"(};
  const double steps = )" +
         std::to_string(c.steps_per_cycle) + R"(, pi = 3.14159265358979323846;
  double move[3], features[11], turn, kick, x, y, ck, sk;
  int i;
  for (i = 0; i < 3; ++i) {
    move[i] = walk[i][0] + (walk[i][1] * (steps * state[3]) + walk[i][2] * (steps * state[4]) +
                            walk[i][3] * (steps * state[5]));
  })" + turned +
         R"(
  turn = state[1] - move[2];
  kick = state[2] - move[2];
  x = state[0] * cos(turn) - move[0];
  y = state[0] * sin(turn) - move[1];
  ck = cos(kick);
  sk = sin(kick);
  features[0] = x;
  features[1] = y;
  features[2] = atan2(y, x);
  features[3] = kick;
  features[4] = ck * x + sk * y;
  features[5] = ck * y - sk * x;
  features[6] = state[0];
  features[7] = state[1] - state[2];
  if (features[7] < -pi) features[7] += 2 * pi;
  if (features[7] >= pi) features[7] -= 2 * pi;
  for (i = 0; i < 3; ++i) features[8 + i] = state[3 + i];
  surefoot_forest(features, action);
}
)";
}
static_assert(Approach::feature_dim == 11, "wrapper() must write the features of Approach");

template <class Problem>
std::string c_file(const surefoot::ForestPolicy<Problem>& policy) {
  return surefoot::export_c(policy, {.table = surefoot::CTable::text, .wrapper = wrapper(policy.problem())});
}

double kilobytes(const std::string& text) { return static_cast<double>(text.size()) / 1000; }

/// The largest imitation whose C file fits.
template <class Problem>
surefoot::ForestPolicy<Problem> shrink(const surefoot::ForestPolicy<Problem>& policy, const ExportOptions& options,
                                       const surefoot::Threads& threads) {
  const DistillOptions distill{.runs = options.runs};
  int leaves = static_cast<int>(1000 * options.max_kb / 143);  // about what a leaf takes in the file [bytes]
  const auto data = demonstrations_to_imitators(policy, leaves, distill, threads, options.seed);
  for (;;) {
    const auto exact = imitate(policy.problem(), data, leaves, distill, threads, options.seed);
    const surefoot::ForestPolicy<Problem> small{policy.problem(), surefoot::with_short_floats(exact.forest())};
    const double share = kilobytes(c_file(small)) / static_cast<double>(options.max_kb);
    if (share <= 1 || leaves == 1) return small;
    leaves = std::max(1, static_cast<int>(0.99 * leaves / share));
  }
}

template <class Problem>
void run(const surefoot::ForestPolicy<Problem>& policy, const ExportOptions& options) {
  prepare_output(options.out);
  std::string code = c_file(policy);
  if (options.max_kb > 0 && kilobytes(code) > static_cast<double>(options.max_kb)) {
    std::printf("The policy itself would take %.0f kB in C; learning a smaller one from it.\n", kilobytes(code));
    std::fflush(stdout);
    const surefoot::Threads threads(options.threads);
    const surefoot::RolloutOptions trials{.runs = options.trials, .horizon = Problem::horizon};
    const auto small = shrink(policy, options, threads);
    const auto& problem = policy.problem();
    const auto before = surefoot::evaluate(problem, policy, trials, threads, evaluation_seed);
    const auto after = surefoot::evaluate(problem, small, trials, threads, evaluation_seed);
    const auto rise = surefoot::compare(problem, policy, small, trials, threads, evaluation_seed);
    code = c_file(small);
    const std::filesystem::path file = options.out.string() + ".policy";
    surefoot::save_policy(file, small);
    std::printf("Cost %.2f +- %.2f before, %.2f +- %.2f after: the smaller size costs %.2f +- %.2f (95 %%).\n",
                -before.mean, before.half_width(), -after.mean, after.half_width(), rise.mean, rise.half_width());
    std::printf("%s: the smaller policy, for the other commands\n", file.c_str());
  }
  write_text(options.out, code);
  std::printf("%s: %.0f kB, void surefoot_policy(const double state[6], double action[3])\n", options.out.c_str(),
              kilobytes(code));
}

}  // namespace

void add_export(example::Command& program) {
  auto options = std::make_shared<ExportOptions>();
  example::Command* command =
      program.add_subcommand("export", "Write a policy as one C99 file without dependencies but libm");
  command->add_option("--policy", options->policy, "policy file of train")->required();
  command->add_option("--out", options->out, "C file")->required();
  add_motion_option(*command, options->motion);
  command
      ->add_option(
          "--max-kb", options->max_kb,
          "largest C file [kB]; a policy that does not fit is replaced by a smaller one learnt from it, and the "
          "price is told; 0: no limit")
      ->check(example::between(0, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--runs", options->runs,
                   "runs that the smaller policy learns from: of the policy, and twice of smaller ones")
      ->check(example::between(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--trials", options->trials, "independent runs that tell its price")
      ->check(example::between(2, 100'000'000))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of that learning")->capture_default_str();
  add_threads_option(*command, options->threads);
  command->callback([options] {
    check_motion(options->policy, options->motion);
    if (options->motion.empty()) {
      run(load_forest(options->policy, [](const char* name) { return problem_named(name); }), *options);
    } else {
      run(load_forest(options->policy, [&](const char* name) { return calibrated_approach(name, options->motion); }),
          *options);
    }
  });
}

}  // namespace sigmaban
