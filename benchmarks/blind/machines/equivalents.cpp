#include "equivalents.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <span>

#include "../plants/calibrate.hpp"

namespace machines {
namespace {

using plants::How;
using plants::System;

// Effects that coincide in some machines: delays where nothing else happens between command and reading, offsets that
// pass through linear equations, friction, dead zones and asymmetries while everything goes one way, friction that is
// larger near rest while nothing is.
const std::map<std::string, std::vector<std::string>>& relatives() {
  static const std::map<std::string, std::vector<std::string>> table{
      {"input_delay", {"sensor_delay"}},
      {"sensor_delay", {"input_delay"}},
      {"input_gain", {"sensor_scale", "input_asymmetry"}},
      {"input_asymmetry", {"input_gain"}},
      {"sensor_scale", {"input_gain"}},
      {"constant_force", {"sensor_bias", "constant_rate", "dead_zone", "coulomb_friction"}},
      {"constant_rate", {"sensor_bias", "sensor_drift", "constant_force", "dead_zone"}},
      {"sensor_bias", {"constant_force", "constant_rate"}},
      {"sensor_drift", {"constant_rate"}},
      {"dead_zone", {"constant_force", "constant_rate", "coulomb_friction"}},
      {"coulomb_friction", {"constant_force", "dead_zone"}},
      {"stribeck_friction", {"coulomb_friction"}},
      {"leak", {"viscous_friction"}},
      {"viscous_friction", {"input_gain", "leak"}}};
  return table;
}

// The alternative fitted to `reference` (its readings are noise-free): squared differences that remain.
double remaining(const Drawn& drawn, const std::vector<Hidden>& hidden, std::size_t k,
                 std::span<const Recording> reference, const Same& same) {
  const System system = with_free_strength(drawn.one.system, drawn.machine, hidden, k);
  const How how{same.substeps, false, false, nullptr, true};
  const Values fitted = plants::calibrate_from(system, plants::actual_values(system), {}, reference, how);
  double squares = 0;
  for (const double one : plants::residuals(system, fitted, {}, reference, how)) squares += one * one;
  return squares;
}

// The same from either sign of the strength where it has one: what is too much on one side may be too little on
// another.
double remaining_from_both(const Drawn& drawn, std::vector<Hidden> hidden, std::size_t k,
                           std::span<const Recording> reference, const Same& same) {
  const double as_drawn = remaining(drawn, hidden, k, reference, same);
  if (!is_signed(hidden[k].name)) return as_drawn;
  hidden[k].a = -hidden[k].a;
  return std::min(as_drawn, remaining(drawn, hidden, k, reference, same));
}

// Recordings whose readings are what the true machine gives in as many integration steps as will be compared: those in
// which the effect shows most.
std::vector<Recording> references(const Drawn& drawn, std::size_t k, const Same& same) {
  const Values actual = plants::actual_values(drawn.one.system);
  const How how{same.substeps, false, false, nullptr};
  std::vector<Hidden> others = drawn.hidden;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
  std::vector<std::pair<double, Recording>> all;
  for (Recording one : drawn.one.system.recordings) {
    one.readings = simulate(*drawn.machine, actual, drawn.hidden, one, how).outputs;
    for (std::vector<bool>& outliers : one.outliers) outliers.assign(outliers.size(), false);
    const std::vector<Column> without = simulate(*drawn.machine, actual, others, one, how).outputs;
    double squares = 0;
    for (std::size_t j = 0; j < without.size(); ++j)
      for (std::size_t i = 0; i < without[j].size(); ++i)
        squares += std::pow((without[j][i] - one.readings[j][i]) / drawn.one.system.noise[j], 2);
    all.emplace_back(squares, std::move(one));
  }
  std::ranges::sort(all, std::greater<>(), [](const auto& entry) { return entry.first; });
  std::vector<Recording> chosen;
  for (std::size_t i = 0; i < std::min(same.recordings, all.size()); ++i) chosen.push_back(std::move(all[i].second));
  return chosen;
}

double rows_of(std::span<const Recording> recordings) {
  double rows = 0;
  for (const Recording& one : recordings) rows += static_cast<double>(one.time.size());
  return rows;
}

// Whether the alternative is the same in all recordings, as far as those of the reference say. What it leaves of one
// alone is the least that it can leave of all: most alternatives are refused by that.
bool coincides(const Drawn& drawn, const std::vector<Hidden>& hidden, std::size_t k,
               std::span<const Recording> reference, const Same& same) {
  const double scale = rows_of(drawn.one.system.recordings) / rows_of(reference);
  for (const std::size_t count : {std::size_t{1}, reference.size()})
    if (!(scale * remaining_from_both(drawn, hidden, k, reference.first(count), same) < same.most_squares))
      return false;
  return true;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> equivalents(const Drawn& drawn, std::size_t k, const Same& criterion) {
  const Hidden& truth = drawn.hidden[k];
  Same same = criterion;
  if (truth.law == Law::delay || truth.law == Law::sensor_delay) same.substeps = same.substeps_of_delays;
  const Machine& machine = drawn.machine->machine;
  const Sizes sizes = measure(*drawn.machine, drawn.one.system.recordings);
  const auto related = relatives().find(truth.name);
  const std::vector<Recording> reference = references(drawn, k, same);
  std::set<std::pair<std::string, std::string>> found;
  std::set<std::pair<std::string, std::string>> tried{{truth.name, truth.attached_to}};
  for (const std::string& place : truth.also) tried.insert({truth.name, place});
  for (const std::string& place : truth.multiples) tried.insert({truth.name, place});
  for (const Candidate& candidate : named_candidates(machine)) {
    const bool same_name = candidate.name == truth.name;
    const bool relative =
        related != relatives().end() && std::ranges::find(related->second, candidate.name) != related->second.end();
    if (!same_name && !relative) continue;
    Random random(1);  // for what the alternative has beside its strength
    Hidden other = draw_hidden(random, {}, machine, sizes, candidate, drawn.one.system.noise);
    if (!tried.insert({other.name, other.attached_to}).second) continue;
    if (same_name && other.where == truth.where) {
      other.law = truth.law, other.b = truth.b, other.c = truth.c, other.d = truth.d;
    }
    if (truth.law == Law::delay || truth.law == Law::sensor_delay || truth.law == Law::gain || truth.law == Law::scale)
      other.a = truth.a;
    std::vector<Hidden> hidden = drawn.hidden;
    hidden[k] = other;
    if (!coincides(drawn, hidden, k, reference, same)) continue;
    found.emplace(other.name, other.attached_to);
    for (const std::string& place : other.also) found.emplace(other.name, place);
    for (const std::string& place : other.multiples) found.emplace(other.name, place);
  }
  return {found.begin(), found.end()};
}

}  // namespace machines
