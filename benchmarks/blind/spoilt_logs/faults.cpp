#include "faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace spoilt {
namespace {

using plants::Random;

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

bool is_angle(const std::string& name) { return name.find("_rad") != std::string::npos; }

std::vector<std::size_t> angles(const Log& log) {
  std::vector<std::size_t> columns;
  for (std::size_t c = 1; c < log.recordings[0].names.size(); ++c) {
    if (is_angle(log.recordings[0].names[c])) columns.push_back(c);
  }
  return columns;
}

std::size_t any_channel(Random& random, const Log& log) {
  std::vector<std::size_t> all = log.outputs;
  all.insert(all.end(), log.inputs.begin(), log.inputs.end());
  return random.choice(all);
}

void scale(std::vector<double>& column, double factor) {
  for (double& value : column) value *= factor;
}

// Standard deviation of the noise from row to row, from the median third difference.
double noise_of(const std::vector<double>& y) {
  std::vector<double> differences;
  for (std::size_t i = 3; i < y.size(); ++i) {
    const double third = std::abs(y[i] - 3 * y[i - 1] + 3 * y[i - 2] - y[i - 3]);
    if (std::isfinite(third)) differences.push_back(third);
  }
  if (differences.empty()) return 0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return 1.4826 * *middle / std::sqrt(20.0);
}

// Readings of a column at other times, between rows; empty outside.
std::vector<double> read_at(Random& random, const Table& table, std::size_t column, const std::vector<double>& times) {
  const double noise = noise_of(table.columns[column]);
  const std::vector<double>&t = table.columns[0], &y = table.columns[column];
  std::vector<double> result;
  std::size_t i = 0;
  for (const double time : times) {
    while (i + 2 < t.size() && t[i + 1] < time) ++i;
    const double share = (time - t[i]) / (t[i + 1] - t[i]);
    if (time < t[0]) {
      result.push_back(y[0] + random.normal(noise));  // the machine was at rest before
    } else {
      result.push_back(share > 1 ? nothing : share < 1e-9 ? y[i] : (1 - share) * y[i] + share * y[i + 1]);
    }
  }
  return result;
}

void delay_outputs(Random& random, const Log& log, Table& table, const std::vector<double>& times) {
  const Table before = table;
  for (const std::size_t c : log.outputs) table.columns[c] = read_at(random, before, c, times);
}

Spoilt of_one(const Log& log, const std::string& kind, std::size_t r, std::size_t column, double size = 0) {
  return {kind, log.files[r], column > 0 ? log.recordings[r].names[column] : "", {}, size};
}

Spoilt spoil_sign(Random& random, Log& log) {
  const std::size_t r = random.index(log.recordings.size()), c = any_channel(random, log);
  scale(log.recordings[r].columns[c], -1);
  return of_one(log, "sign_flipped", r, c);
}

Spoilt spoil_unit(Random& random, Log& log) {
  const auto columns = angles(log);
  const bool time = log.timed && (columns.empty() || random.chance(0.3)), all = random.chance(0.4);
  const std::size_t c = time ? 0 : random.choice(columns), r = random.index(log.recordings.size());
  const double factor = time ? 1000 : 180 / std::numbers::pi;
  for (std::size_t i = 0; i < log.recordings.size(); ++i) {
    if (all || i == r) scale(log.recordings[i].columns[c], factor);
  }
  Spoilt spoilt = of_one(log, time ? "time_unit" : "angle_unit", r, c, factor);
  if (all) spoilt.recording.clear();
  return spoilt;
}

Spoilt spoil_swap(Random& random, Log& log) {
  const std::vector<std::size_t>& columns =
      log.outputs.size() > 1 && (log.inputs.size() < 2 || random.chance(0.7)) ? log.outputs : log.inputs;
  const std::size_t a = random.index(columns.size()), b = (a + 1) % columns.size();
  const std::size_t r = random.index(log.recordings.size());
  const bool all = random.chance(0.4);
  for (std::size_t i = 0; i < log.recordings.size(); ++i) {
    if (all || i == r) std::swap(log.recordings[i].columns[columns[a]], log.recordings[i].columns[columns[b]]);
  }
  Spoilt spoilt = of_one(log, "columns_swapped", r, columns[a]);
  spoilt.also = {log.recordings[0].names[columns[b]]};
  if (all) spoilt.recording.clear();
  return spoilt;
}

// Each recording late by 0 to 100 ms, or 0 to 20 rows where these are longer.
Spoilt spoil_offset(Random& random, Log& log) {
  double longest = 0;
  for (Table& table : log.recordings) {
    const double interval = table.columns[0].back() / static_cast<double>(table.rows() - 1);
    const double late = random.uniform(0, std::max(0.1, interval > 0.1 ? 20 * interval : 0));
    longest = std::max(longest, late);
    std::vector<double> times = table.columns[0];
    for (double& t : times) t -= late;
    delay_outputs(random, log, table, times);
  }
  return {"clock_offset", "", "", {}, longest};
}

// One recording's time runs 2 % fast or slow: of its outputs against its inputs, or of both.
Spoilt spoil_skew(Random& random, Log& log) {
  const std::size_t r = random.index(log.recordings.size());
  const double skew = random.sign() * random.uniform(0.015, 0.03);
  Table& table = log.recordings[r];
  if (random.chance(0.5)) {
    scale(table.columns[0], 1 + skew);
  } else {
    std::vector<double> times = table.columns[0];
    for (double& t : times) t /= 1 + skew;
    delay_outputs(random, log, table, times);
  }
  return of_one(log, "clock_skew", r, 0, skew);
}

Spoilt spoil_stuck_or_clipped(Random& random, Log& log) {
  const std::size_t r = random.index(log.recordings.size()), c = random.choice(log.outputs);
  std::vector<double>& y = log.recordings[r].columns[c];
  if (random.chance(0.5)) {
    const auto length = static_cast<std::size_t>(static_cast<double>(y.size()) * random.uniform(0.1, 0.3));
    const std::size_t from = random.index(y.size() - length);
    if (std::isnan(y[from])) y[from] = y[from > 0 ? from - 1 : from + 1];
    for (std::size_t i = from; i < from + length; ++i) y[i] = y[from];
    return of_one(log, "stuck_sensor", r, c, static_cast<double>(length));
  }
  std::vector<double> sorted = y;
  std::erase_if(sorted, [](double value) { return std::isnan(value); });
  std::ranges::sort(sorted);
  const double end = sorted[static_cast<std::size_t>(static_cast<double>(sorted.size()) * random.uniform(0.7, 0.9))];
  for (double& value : y) value = std::min(value, end);
  return of_one(log, "clipped", r, c, end);
}

Spoilt spoil_dropped(Random& random, Log& log) {
  const std::size_t r = random.index(log.recordings.size());
  Table& table = log.recordings[r];
  const std::size_t rows = table.rows();
  if (random.chance(0.5)) {  // rows are missing
    const auto length = static_cast<std::size_t>(static_cast<double>(rows) * random.uniform(0.05, 0.2));
    const std::size_t from = 1 + random.index(rows - length - 1);
    for (auto& column : table.columns) {
      column.erase(column.begin() + static_cast<std::ptrdiff_t>(from),
                   column.begin() + static_cast<std::ptrdiff_t>(from + length));
    }
    return of_one(log, "dropped_samples", r, 0, static_cast<double>(length));
  }
  const double share = random.uniform(0.1, 0.3);  // the logger repeats what it missed
  for (std::size_t row = 1; row < rows; ++row) {
    if (!random.chance(share)) continue;
    for (const std::size_t c : log.outputs) table.columns[c][row] = table.columns[c][row - 1];
  }
  return of_one(log, "dropped_samples", r, 0, share);
}

Spoilt spoil_odd(Random& random, Log& log, const Log& donor) {
  const std::size_t r = random.index(log.recordings.size());
  const Table& other = donor.recordings[random.index(donor.recordings.size())];
  // Commands of one recording with the readings of another experiment on another machine.
  Table& table = log.recordings[r];
  for (const std::size_t c : log.outputs) {
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const bool measured = std::isfinite(table.columns[c][row]);
      const std::size_t last = other.rows() - 1, there_and_back = row % (2 * last);
      const std::size_t from = row + 1 == table.rows() ? last : std::min(there_and_back, 2 * last - there_and_back);
      if (measured) table.columns[c][row] = other.columns[c][from];
    }
  }
  return of_one(log, "odd_recording", r, 0);
}

}  // namespace

const std::vector<std::string>& kinds() {
  static const std::vector<std::string> all{"sign_flipped",  "unit",       "columns_swapped", "clock_offset",
                                            "clock_skew",    "readings",   "dropped_samples", "odd_recording"};
  return all;
}

bool possible(const Log& log, const std::string& kind) {
  const bool final_only = log.family == "walk_final";
  if (kind == "unit") return log.timed || !angles(log).empty();
  if (kind == "columns_swapped") return log.outputs.size() > 1 || log.inputs.size() > 1;
  if (kind == "clock_offset" || kind == "clock_skew" || kind == "dropped_samples") return log.timed;
  if (kind == "readings") return !final_only;
  return true;
}

Spoilt spoil(Random& random, Log& log, const std::string& kind, const Log& donor) {
  if (kind == "sign_flipped") return spoil_sign(random, log);
  if (kind == "unit") return spoil_unit(random, log);
  if (kind == "columns_swapped") return spoil_swap(random, log);
  if (kind == "clock_offset") return spoil_offset(random, log);
  if (kind == "clock_skew") return spoil_skew(random, log);
  if (kind == "readings") return spoil_stuck_or_clipped(random, log);
  if (kind == "dropped_samples") return spoil_dropped(random, log);
  if (kind == "odd_recording") return spoil_odd(random, log, donor);
  throw std::invalid_argument("unknown kind " + kind);
}

}  // namespace spoilt
