// `trajectories`: how three policies walk to the ball from the paper's starts, and the learning curves.
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "../../../apps/common/gnuplot.hpp"
#include "any_policy.hpp"
#include "commands.hpp"
#include "learning_curve.hpp"
#include "plot.hpp"
#include "results.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/core/rollout.hpp"

namespace sigmaban {
namespace {

using example::draw;

struct TrajectoriesOptions {
  Results results{"results"};
  std::uint64_t seed = 1;
};

constexpr double far_start = 0.95;  // [m]; the paper's 1 m is the very edge of what counts as a lost ball
constexpr double near_start = 0.5;  // [m]

/// One line per walk cycle until the robot may kick: its position and heading in the frame that has the ball at its
/// origin and the kick target along x, then the number of the start (for the colour).
template <class Policy>
void write_run(std::ostream& out, const Approach& problem, const Policy& policy, const Approach::State& start,
               int number, const surefoot::Rng& rng) {
  const auto run = surefoot::trajectory(problem, policy, start, Approach::horizon, rng);
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const Approach::State& s = run.states[i];
    out << -s[0] * std::cos(s[1] - s[2]) << ' ' << -s[0] * std::sin(s[1] - s[2]) << ' ' << -s[2] << ' ' << number
        << '\n';
    if (i > 0 && run.rewards[i - 1] == 0) break;
  }
  out << '\n';
}

/// The six starts with the kick target in one direction as a data block of gnuplot.
std::string runs(const Approach& problem, const AnyPolicy& policy, double kick, std::uint64_t seed) {
  constexpr double left = std::numbers::pi / 2;
  std::ostringstream out;
  int number = 0;
  for (const double distance : {near_start, far_start}) {
    for (const double direction : {0.0, left, -left}) {
      Approach::State start = Approach::State::Zero();
      start.head<3>() << distance, direction, kick;
      ++number;
      std::visit([&](const auto& p) { write_run(out, problem, p, start, number, surefoot::Rng(seed, number)); },
                 policy);
    }
  }
  return out.str() + "\n";
}

std::string commands(const std::string& problem, const std::vector<std::pair<std::string, AnyPolicy>>& policies) {
  std::ostringstream out;
  out << R"(set multiplot layout 2,3 margins 0.055,0.99,0.055,0.92 spacing 0.055,0.1 title ')" << problem
      << R"(: approaches to the ball (black), one arrow per walk cycle, until the robot may kick (from the grey zone)'
)" << approach_frame;
  int block = 0;
  for (const char* target : {"target ahead at the start", "target behind at the start"}) {
    for (const auto& [name, policy] : policies) {
      out << "set title '" << name << ", " << target << "'\n"
          << "plot data index " << block << " using 1:2:4 with lines lc variable lw 1, '' index " << block
          << " using 1:2:(0.055*cos($3)):(0.055*sin($3)):4 with vectors head filled size 0.03,25 lc variable\n";
      ++block;
    }
  }
  out << "unset multiplot\n";
  return out.str();
}

void run(const TrajectoriesOptions& options) {
  for (const std::string name : {"ha", "anha"}) {
    const Approach problem = problem_named(name);
    const auto tuned = options.results.tuned(name);
    const std::vector<std::pair<std::string, AnyPolicy>> policies{
        {"Winner2016", load_any_policy(problem, "winner2016")},
        {"tuned by CMA-ES", load_any_policy(problem, exists(tuned) ? tuned.string() : "tuned")},
        {"RFPI", load_any_policy(problem, options.results.rfpi(name).string())}};
    std::string data;
    for (const double kick : {0.0, -std::numbers::pi}) {
      for (const auto& [title, policy] : policies) data += runs(problem, policy, kick, options.seed);
    }
    draw(options.results.folder / ("trajectories_" + name), commands(name == "ha" ? "HA" : "ANHA", policies), data,
         1200, 860);
  }
  draw_learning_curves(options.results);
}

}  // namespace

void add_trajectories(example::Command& program) {
  auto options = std::make_shared<TrajectoriesOptions>();
  example::Command* command =
      program.add_subcommand("trajectories", "Draw the approaches and the learning curves (gnuplot)");
  command->add_option("--results", options->results.folder, "folder with the policies, and for the pictures")
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of the noise")->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace sigmaban
