#include "compare_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "../common/printed.hpp"

namespace calibrate_program {
namespace {

using surefoot::WalkChange;
using surefoot::WalkComparison;
using surefoot::WalkFalls;

constexpr double degree = std::numbers::pi / 180;

double former_value(const WalkComparison& comparison, std::string_view name) {
  for (const auto& one : comparison.coefficients) {
    if (one.info.name == name) return one.before;
  }
  return 0;
}

/// One component of a displacement or a command: how it is spoken of, and how large 1 of its unit is there.
struct SpokenAxis {
  std::string_view name, positive, negative, unit;
  double shown;  // of a displacement, in `unit`
};

constexpr std::array<SpokenAxis, 3> spoken_axes{{{"dx", "forward", "backward", "mm", 1e3},
                                                 {"dy", "to the left", "to the right", "mm", 1e3},
                                                 {"dt", "to the left", "to the right", "degrees", 1 / degree}}};

const SpokenAxis* axis_named(std::string_view name) {
  const auto found = std::ranges::find(spoken_axes, name, &SpokenAxis::name);
  return found == spoken_axes.end() ? nullptr : &*found;
}

/// "drifts to the left by 4 mm per cycle"
std::string drift(const SpokenAxis& of, double size) {
  const bool turn = of.name == "dt";
  return example::printed("%s %s by %.2g %s per cycle more than before", turn ? "turns by itself" : "drifts",
                          std::string(size > 0 ? of.positive : of.negative).c_str(), std::abs(size) * of.shown,
                          std::string(of.unit).c_str());
}

/// "walks shorter steps forward by 12 %"; `side` is empty for both.
std::string gain(std::string_view name, std::string side, double relative) {
  const double percent = 100 * std::abs(relative);
  if (name == "dx") {
    if (side.empty()) side = "forward and backward";
    return example::printed("walks %s steps %s by %.0f %%", relative < 0 ? "shorter" : "longer", side.c_str(), percent);
  }
  if (name == "dy") {
    if (side.empty()) side = "to both sides";
    return example::printed("makes %s steps %s by %.0f %%", relative < 0 ? "weaker" : "larger", side.c_str(), percent);
  }
  if (side.empty()) side = "to both sides";
  return example::printed("turns %s %s by %.0f %%", relative < 0 ? "less" : "more", side.c_str(), percent);
}

/// "a step of 10 cm forward takes it 8 mm more to the left"
std::string coupling(const SpokenAxis& of, const SpokenAxis& per, double size, bool last) {
  const bool turn = per.name == "dt";
  const double command = turn ? 10 * degree : 0.1;
  const std::string asked = example::printed("a command of %s %s%s", turn ? "10 degrees" : "10 cm",
                                             std::string(per.positive).c_str(), last ? " in the cycle before" : "");
  return example::printed("answers %s by %.2g %s more %s", asked.c_str(), std::abs(size) * command * of.shown,
                          std::string(of.unit).c_str(), std::string(size > 0 ? of.positive : of.negative).c_str());
}

/// A change of a coefficient, or of a gain to one side, by `size`.
std::string coefficient_sentence(const WalkComparison& comparison, const WalkChange& change, double size) {
  const std::string_view name = change.name;
  const SpokenAxis* of = axis_named(name.substr(0, 2));
  if (of == nullptr) return example::printed("%s changed by %.3g", change.name.c_str(), size);
  if (name.ends_with("offset")) return drift(*of, size);
  if (name.find(" and ") != std::string_view::npos) return gain(of->name, "", size);  // a factor
  const bool last = name.find(" last ") != std::string_view::npos;
  const std::string_view rest = name.substr(last ? 12 : 7);
  const SpokenAxis* per = axis_named(rest.substr(0, 2));
  if (per == nullptr) return example::printed("%s changed by %.3g", change.name.c_str(), size);
  if (of != per || last) return coupling(*of, *per, size, last);
  const std::string both = std::string(name.substr(0, 9));
  const std::string side = rest.size() > 3 ? std::string(rest.substr(3)) : "";
  const double sides = former_value(comparison, both.substr(0, 7) + "|" + std::string(of->name) + "|");
  const double before = former_value(comparison, both) + (side.empty() ? 0 : side == of->positive ? sides : -sides);
  return gain(of->name, side, size / before);
}

std::string noise_sentence(const surefoot::NoiseChange& noise) {
  const double factor = std::sqrt(noise.change.ratio);  // of what was measured, readings included
  std::string text = example::printed("has %s %s", factor > 1 ? "more" : "less", noise.name.c_str());
  if (noise.name == "noise") {
    text += ",";
  } else {
    const bool turns = noise.name == "noise of turns";
    const double unit = turns ? degree : 1e-3;
    text += example::printed(": %.2g %s in a cycle, it was %.2g; with the readings", noise.after / unit,
                             turns ? "degrees" : "mm", noise.before / unit);
  }
  return text + example::printed(" %.2f times as before (%.2f to %.2f)", factor, std::sqrt(noise.change.low),
                                 std::sqrt(noise.change.high));
}

std::string fall_sentence(const WalkComparison& comparison, const WalkFalls& falls) {
  const double then = static_cast<double>(falls.before.fell) / falls.before.sequences,
               now = static_cast<double>(falls.after.fell) / falls.after.sequences;
  return example::printed(
      "falls %s often: %d of %d sequences ended early or have no final position, before %d of %d (p = %.2g)",
      now > then ? "more" : "less", falls.after.fell, falls.after.sequences, falls.before.fell, falls.before.sequences,
      comparison.falls->p_value);
}

std::string delay_sentence(int delay) {
  return example::printed("responds %s by %d whole cycle%s", delay > 0 ? "later" : "earlier", std::abs(delay),
                          std::abs(delay) == 1 ? "" : "s");
}

/// What one change means, if it is it that happened and the likeliest set does not say otherwise.
std::string sentence(const WalkComparison& comparison, int index, const std::optional<WalkFalls>& falls) {
  if (index < 0) {
    const auto& sets = comparison.posterior.sets;
    const auto late = std::ranges::find_if(sets, [](const auto& set) { return set.delay != 0; });
    return delay_sentence(comparison.likeliest.delay != 0 ? comparison.likeliest.delay
                          : late == sets.end()            ? 0
                                                          : late->delay);
  }
  const WalkChange& change = comparison.changes[static_cast<std::size_t>(index)];
  for (const auto& noise : comparison.noise) {
    if (noise.name == change.name) return noise_sentence(noise);
  }
  if (change.direction.size() == 0) return fall_sentence(comparison, *falls);
  const double size = comparison.size_of(index);
  if (change.name == "part of a cycle") {
    return example::printed("responds %s by %.2f of a cycle", size > 0 ? "later" : "earlier", std::abs(size));
  }
  return coefficient_sentence(comparison, change, size);
}

}  // namespace

std::string name_of_change(const WalkComparison& comparison, int change) {
  return change < 0 ? "whole cycles" : comparison.changes[static_cast<std::size_t>(change)].name;
}

std::string likeliest_change(const WalkComparison& comparison, const std::optional<WalkFalls>& falls) {
  int likeliest = -1;
  double probability = comparison.posterior.any_of(std::array{-1});
  for (int i = 0; i < static_cast<int>(comparison.changes.size()); ++i) {
    const double other = comparison.posterior.any_of(std::array{i});
    if (other > probability) likeliest = i, probability = other;
  }
  return "the robot " + sentence(comparison, likeliest, falls) + ": " + name_of_change(comparison, likeliest) +
         example::printed(" (%.2f).", probability);
}

std::vector<std::string> possible_causes(const WalkComparison& comparison) {
  struct Cause {
    bool found;
    const char* sentence;
  };
  bool late = false, partly_late = false, offset = false, coefficient = false, noise = false;
  for (const surefoot::FoundChange& found : comparison.found) {
    const int change = found.any_of.front();  // the likeliest of them
    if (change < 0) {
      late = true;
      continue;
    }
    const WalkChange& what = comparison.changes[static_cast<std::size_t>(change)];
    if (what.direction.size() == 0) {
      noise = true;  // or falls
    } else if (what.name == "part of a cycle") {
      partly_late = true;
    } else {
      (what.name.ends_with("offset") ? offset : coefficient) = true;
    }
  }
  std::vector<std::string> result;
  for (const Cause& cause : {Cause{late, "A whole cycle: commands are passed on later."},
                             Cause{partly_late,
                                   "A part of a cycle: friction, a low supply or weaker gains of the servos; "
                                   "displacements do not tell these apart."},
                             Cause{offset,
                                   "A drift: the zero of a joint, legs of different length, a load that moved, or a "
                                   "slope; displacements do not tell these apart."},
                             Cause{coefficient,
                                   "Other steps for the same commands: free play, friction, the supply, the ground, or "
                                   "settings of the walk; displacements do not tell these apart."},
                             Cause{noise, "Noise and falls: a slope, soft or slippery ground, or loose parts."}}) {
    if (cause.found) result.emplace_back(cause.sentence);
  }
  return result;
}

std::vector<std::string> change_sentences(const WalkComparison& comparison, const std::optional<WalkFalls>& falls) {
  std::vector<std::string> result;
  for (const surefoot::FoundChange& found : comparison.found) {
    const std::string certain = example::printed(" (probability %.3f)", std::min(found.probability, 0.999));
    if (found.any_of.size() == 1) {
      const int only = found.any_of.front();
      result.push_back("The robot " + sentence(comparison, only, falls) + ": " + name_of_change(comparison, only) +
                       certain + ".");
      continue;
    }
    std::string text = "These cannot be told apart, at least one happened" + certain + ":";
    for (const int change : found.any_of) {
      text += "\n    it " + sentence(comparison, change, falls) + ": " + name_of_change(comparison, change) +
              example::printed(" (%.2f)", comparison.posterior.any_of(std::array{change}));
    }
    result.push_back(text);
  }
  return result;
}

}  // namespace calibrate_program
