#include "compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace score {
namespace {

using Effects = std::vector<Effect>;

const Effect* find(const Effects& effects, const std::string& name) {
  const auto at = std::ranges::find(effects, name, &Effect::name);
  return at == effects.end() ? nullptr : &*at;
}

// Another name and place of which no test could tell the hidden effect.
bool is_equivalent(const Effect& named, const Effect& truth) {
  return std::ranges::find(truth.equivalents, std::pair(named.name, named.attached_to)) != truth.equivalents.end();
}

bool right_name(const Effect& named, const Effect& truth) {
  return named.name == truth.name || is_equivalent(named, truth);
}

bool any_right(const Effects& named, const Effects& truth) {
  return std::ranges::any_of(named, [&](const Effect& one) {
    return std::ranges::any_of(truth, [&](const Effect& t) { return right_name(one, t); });
  });
}

bool all_right(const Effects& named, const Effects& truth) {
  return !truth.empty() && std::ranges::all_of(truth, [&](const Effect& t) {
    return std::ranges::any_of(named, [&](const Effect& one) { return right_name(one, t); });
  });
}

bool right_place(const Effect& named, const Effect& truth) {
  return named.attached_to == truth.attached_to || is_equivalent(named, truth) ||
         std::ranges::find(truth.also_accepted, named.attached_to) != truth.also_accepted.end();
}

bool right_both(const Effect& named, const Effect& truth) {
  return is_equivalent(named, truth) || (named.name == truth.name && right_place(named, truth));
}

// Some hidden effect is named at its right place.
bool any_attached(const Effects& named, const Effects& truth) {
  return std::ranges::any_of(named, [&](const Effect& one) {
    return std::ranges::any_of(truth, [&](const Effect& t) { return right_both(one, t); });
  });
}

// Other words for a parameter.
const std::set<std::string>& words(const std::string& name) {
  static const std::vector<std::set<std::string>> same{{"level", "weight", "force", "torque"},
                                                       {"extra", "breakaway"},
                                                       {"stribeck_speed", "speed"},
                                                       {"coefficient", "damping", "drag"},
                                                       {"yield", "width"},
                                                       {"half_width", "width"},
                                                       {"position", "level"},
                                                       {"rate", "leak"},
                                                       {"gain", "excess"},
                                                       {"error", "excess", "scale"},
                                                       {"sag"},
                                                       {"time_constant", "time"},
                                                       {"frequency"},
                                                       {"damping"},
                                                       {"bias", "offset"}};
  for (const std::set<std::string>& group : same)
    if (group.contains(name)) return group;
  static const std::set<std::string> none;
  return none;
}

const double* value_of(const Effect& effect, const std::string& name) {
  const auto exact = effect.parameters.find(name);
  if (exact != effect.parameters.end()) return &exact->second;
  for (const std::string& word : words(name)) {
    const auto at = effect.parameters.find(word);
    if (at != effect.parameters.end()) return &at->second;
  }
  return nullptr;
}

std::vector<double> parameter_errors(const Effects& named, const Effects& truth) {
  std::vector<double> errors;
  for (const Effect& t : truth) {
    const Effect* found = find(named, t.name);
    if (!t.same_formula || found == nullptr || is_equivalent(*found, t) || !right_place(*found, t)) continue;
    for (const auto& [name, value] : t.parameters) {
      const double* estimate = value_of(*found, name);
      if (estimate != nullptr && value != 0) errors.push_back(std::abs(*estimate - value) / std::abs(value));
    }
  }
  return errors;
}

double root_mean_square(const std::vector<std::string>& recordings, const std::map<std::string, double>& errors) {
  double sum = 0, count = 0;
  for (const std::string& recording : recordings) {
    const auto at = errors.find(std::filesystem::path(recording).filename().string());
    if (at == errors.end()) continue;
    sum += at->second * at->second;
    count += 1;
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

// From errors in the outputs' own units where they are given; else from before and after, taking the method's
// calibrated model to be as good as the one fitted when the case was made.
double error_ratio(const Truth& truth, const Answer& answer) {
  const double actual = root_mean_square(answer.test, truth.rmse);
  double sum = 0;
  for (const auto& [output, noise] : truth.noise) {
    const auto at = answer.rmse_after.find(output);
    const double after = at == answer.rmse_after.end() ? std::numeric_limits<double>::quiet_NaN() : at->second;
    sum += after * after / (noise * noise);
  }
  const double after = std::sqrt(sum / static_cast<double>(truth.noise.size()));
  if (std::isfinite(after)) return after / actual;
  return answer.after / answer.before * root_mean_square(answer.test, truth.calibrated) / actual;
}

}  // namespace

bool is_right_structure(const Truth& truth, const Effects& effects) {
  if (truth.kind == "outside" || effects.size() != truth.effects.size()) return false;
  return std::ranges::all_of(truth.effects, [&](const Effect& t) {
    return std::ranges::any_of(effects, [&](const Effect& one) { return right_both(one, t); });
  });
}

Outcome compare(const Truth& truth, const Answer& answer) {
  Outcome outcome;
  outcome.truth = &truth;
  outcome.answer = answer;
  outcome.detected = answer.verdict == "missing-physics" || answer.verdict == "unexplained";
  outcome.error_ratio = error_ratio(truth, answer);
  outcome.parameter_errors = parameter_errors(answer.effects, truth.effects);
  for (const Effect& one : answer.effects) outcome.superfluous += any_right({one}, truth.effects) ? 0 : 1;

  const Effects first(answer.effects.begin(), answer.effects.begin() + (answer.effects.empty() ? 0 : 1));
  outcome.named_first = any_right(first, truth.effects);
  outcome.attached = any_attached(answer.effects, truth.effects);
  outcome.named_in_three = any_right(answer.effects, truth.effects);
  outcome.all_named = all_right(answer.effects, truth.effects);
  outcome.structure_right = is_right_structure(truth, answer.effects);
  const double floor = root_mean_square(answer.test, truth.floor) / root_mean_square(answer.test, truth.rmse);
  const bool open = answer.verdict == "unexplained" || answer.verdict == "search-not-finished";
  outcome.against_noise = !open && outcome.error_ratio / floor > unexplained_error;
  for (std::size_t i = 0; i < answer.alternatives.size(); ++i) {
    const Alternative& other = answer.alternatives[i];
    const bool right = any_right(other.effects, truth.effects);
    if (i < 2) outcome.named_in_three |= right;
    if (!other.indistinguishable) continue;
    ++outcome.class_size;
    outcome.named_first |= right;
    outcome.named_in_three |= right;
    outcome.attached |= any_attached(other.effects, truth.effects);
    outcome.all_named |= all_right(other.effects, truth.effects);
    outcome.structure_right |= is_right_structure(truth, other.effects);
  }
  return outcome;
}

std::string complaint(const Outcome& outcome) {
  const std::string& kind = outcome.truth->kind;
  if (kind == "nothing" && outcome.detected) return "false alarm";
  if (kind == "nothing") return outcome.against_noise ? "error above the noise" : "";
  if (!outcome.detected) return "not detected";
  if (kind == "outside") return outcome.answer.verdict == "unexplained" ? "" : "misnamed";
  if (outcome.answer.verdict == "unexplained" && outcome.answer.effects.empty()) return "unexplained, but has a name";
  if (!outcome.named_first) return outcome.named_in_three ? "right name not first" : "wrong name";
  if (!outcome.attached) return "wrong place";
  if (kind == "two" && !outcome.all_named) return "second effect not named";
  return outcome.against_noise ? "error above the noise" : "";
}

}  // namespace score
