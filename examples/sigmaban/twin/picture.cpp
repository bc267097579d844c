// `picture`: ball approaches from above, as the model expects them and as the twin walks them.
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "../../../apps/calibrate/stoppable.hpp"
#include "../../../apps/common/files.hpp"
#include "../../../apps/common/gnuplot.hpp"
#include "../approach/commands.hpp"
#include "../approach/plot.hpp"
#include "../robot/policy_option.hpp"
#include "commands.hpp"
#include "play_approach.hpp"
#include "robot_strip.hpp"
#include "surefoot/core/rollout.hpp"

namespace sigmaban {
namespace {

struct PictureOptions {
  TwinOptions twin;
  std::string problem = "ha", motion, policy = "expert";
  std::filesystem::path out;
  bool robot = false;
};

/// Ball distance [m] and direction [rad], kick direction [rad].
struct Start {
  double distance = 0, direction = 0, kick = 0;
};

std::vector<Start> starts() {
  constexpr double left = std::numbers::pi / 2;
  return {{0.9, 0, 0}, {0.9, left, 0}, {0.9, -left, 0}, {0.6, 0, -2}, {0.6, left, 2}, {0.6, -left, 2.5}};
}

/// x, y and angle of a pose in the frame that has the ball at its origin and the kick along x, then a colour.
void write(std::ostream& out, const surefoot::Pose2& pose, int colour) {
  out << pose.x << ' ' << pose.y << ' ' << pose.angle << ' ' << colour << '\n';
}

/// Paths of two blocks: every pose of a path, then those after each walk cycle.
struct Paths {
  std::ostringstream path, cycles;
};

template <class Problem, class Policy>
void write_model(Paths& out, const Problem& problem, const Policy& policy, const typename Problem::State& start,
                 int colour, const surefoot::Rng& rng) {
  const auto run = surefoot::trajectory(problem, policy, start, Problem::horizon, rng);
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const auto& s = run.states[i];
    const surefoot::Pose2 seen{s[0] * std::cos(s[1]), s[0] * std::sin(s[1]), s[2]};  // the ball
    write(out.path, seen.inverse(), colour);
    write(out.cycles, seen.inverse(), colour);
    if (i > 0 && run.rewards[i - 1] == 0) break;
  }
  out.path << '\n';
}

void write_twin(Paths& out, const PlayedApproach& played, int colour) {
  const surefoot::Pose2 from = played.ball.inverse();
  const std::size_t cycles = played.kick ? static_cast<std::size_t>(*played.kick) : played.cycle.size() - 1;
  const std::size_t ticks = cycles * played.tick.size() / (played.cycle.size() - 1);
  for (std::size_t i = 0; i < ticks; ++i) write(out.path, from * played.tick[i], colour);
  for (std::size_t i = 0; i <= cycles; ++i) write(out.cycles, from * played.cycle[i], colour);
  out.path << '\n';
}

std::string block(const Paths& paths) { return paths.path.str() + "\n\n" + paths.cycles.str() + "\n\n"; }

std::string panel(const std::string& title, int index) {
  std::ostringstream out;
  out << "set title '" << title << "'\nplot data index " << index
      << " using 1:2:4 with lines lc variable lw 1, '' index " << index + 1
      << " using 1:2:(0.055*cos($3)):(0.055*sin($3)):4 with vectors head filled size 0.03,25 lc variable\n";
  return out.str();
}

template <class Problem>
void run_problem(const Problem& problem, const PictureOptions& options) {
  const auto any_policy = load_policy_option(problem, options.policy, options.motion);
  const WalkingTwinOptions twin = walking_twin_options(options.twin);
  example::prepare_output(options.out.string() + ".svg");
  const std::vector<Start> all = starts();
  Paths model, walked;
  calibrate_program::until_interrupted(options.twin.threads, [&](const calibrate_program::StoppableThreads& threads) {
    const auto played = surefoot::map(threads, all.size(), [&](std::size_t i) {
      typename Problem::State start = Problem::State::Zero();
      start.template head<3>() << all[i].distance, all[i].direction, all[i].kick;
      const surefoot::Rng rng(options.twin.seed, i);
      WalkingTwin robot(twin, rng.stream(2));
      return std::visit([&](const auto& p) { return play_approach(problem, p, robot, start, rng.stream(1)); },
                        any_policy);
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      typename Problem::State start = Problem::State::Zero();
      start.template head<3>() << all[i].distance, all[i].direction, all[i].kick;
      const int colour = static_cast<int>(i) + 1;
      std::visit(
          [&](const auto& p) { write_model(model, problem, p, start, colour, surefoot::Rng(options.twin.seed, i)); },
          any_policy);
      write_twin(walked, played[i], colour);
    }
  });
  example::draw(options.out,
                "set multiplot layout 1,2 margins 0.06,0.99,0.09,0.90 spacing 0.07\n" + std::string(approach_frame) +
                    panel("as the model expects, one arrow per walk cycle", 0) +
                    panel("as the robot walks in MuJoCo", 2) + "unset multiplot\n",
                block(model) + block(walked), 1200, 640);
  if (options.robot) draw_robot_strip(options.out.string() + "_robot", twin, {0.03, 0, 0.1});
}

}  // namespace

void add_picture(example::Command& program) {
  auto options = std::make_shared<PictureOptions>();
  example::Command* command = program.add_subcommand("picture", "Draw six ball approaches from above (gnuplot)");
  add_problem_option(*command, options->problem);
  add_motion_option(*command, options->motion);
  command->add_option("--policy", options->policy, policy_help)->required();
  add_twin_options(*command, options->twin);
  command->add_flag("--robot", options->robot, "also draw the robot itself through a walk cycle, as OUT_robot");
  command->add_option("--out", options->out, "files to write, without .svg and .png")->required();
  command->callback([options] {
    with_problem(options->problem, options->motion, [&](const auto& problem) { run_problem(problem, *options); });
  });
}

}  // namespace sigmaban
