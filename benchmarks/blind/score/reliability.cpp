#include "reliability.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace score {

std::vector<Statement> statements_of(const std::vector<Outcome>& outcomes) {
  std::vector<Statement> statements;
  for (const Outcome& outcome : outcomes)
    for (const Stated& one : outcome.answer.structures)
      statements.push_back({std::clamp(one.probability, 0.0, 1.0), is_right_structure(*outcome.truth, one.effects)});
  return statements;
}

std::vector<Bin> bins_of(const std::vector<Statement>& statements, int count) {
  std::vector<Bin> bins(static_cast<std::size_t>(count));
  for (const Statement& one : statements) {
    Bin& bin = bins[static_cast<std::size_t>(std::min(static_cast<int>(one.probability * count), count - 1))];
    bin.probability += one.probability;
    bin.share_right += one.right ? 1 : 0;
    ++bin.count;
  }
  for (std::size_t i = 0; i < bins.size(); ++i) {
    bins[i].low = static_cast<double>(i) / count, bins[i].high = static_cast<double>(i + 1) / count;
    if (bins[i].count > 0) bins[i].probability /= bins[i].count, bins[i].share_right /= bins[i].count;
  }
  std::erase_if(bins, [](const Bin& bin) { return bin.count == 0; });
  return bins;
}

double expected_calibration_error(const std::vector<Bin>& bins) {
  double sum = 0, all = 0;
  for (const Bin& bin : bins) {
    sum += bin.count * std::abs(bin.probability - bin.share_right);
    all += bin.count;
  }
  return all > 0 ? sum / all : std::numeric_limits<double>::quiet_NaN();
}

std::string reliability_data(const std::vector<Bin>& bins) {
  std::string text = "# stated_probability share_right standard_error statements\n";
  for (const Bin& bin : bins) {
    char line[96];
    const double error = std::sqrt(bin.share_right * (1 - bin.share_right) / bin.count);
    std::snprintf(line, sizeof line, "%.4f %.4f %.4f %d\n", bin.probability, bin.share_right, error, bin.count);
    text += line;
  }
  return text;
}

}  // namespace score
