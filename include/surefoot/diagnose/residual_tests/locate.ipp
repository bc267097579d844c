// Definitions of surefoot/diagnose/residual_tests/locate.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/residual_tests/features.hpp"
#include "surefoot/diagnose/residual_tests/locate.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE Eigen::VectorXd mismatch_energy(const BoundSimulator& bound, const std::vector<std::size_t>& recordings,
                                              const std::vector<SimulatedRun>& trajectories,
                                              const Eigen::VectorXd& sigma, const FeatureTable& table,
                                              Eigen::Index horizon) {
  Eigen::VectorXd energy = Eigen::VectorXd::Zero(table.values.cols());
  for (Eigen::Index j = 0; j < energy.size(); ++j) {
    const std::size_t i = table.recording[static_cast<std::size_t>(j)];
    const Eigen::Index row = table.row[static_cast<std::size_t>(j)], before = row - horizon;
    if (before < 0) continue;
    const auto off = [&](Eigen::Index k, Eigen::Index at) {
      const double value = trajectories[i].outputs(k, at) - bound.recordings[recordings[i]].outputs(k, at);
      return bound.wrapped[static_cast<std::size_t>(k)] ? wrap_angle(value) : value;
    };
    for (Eigen::Index k = 0; k < sigma.size(); ++k) {
      const double change = horizon > 0 ? off(k, row) - off(k, before) : off(k, row);
      if (std::isfinite(change)) energy[j] += std::min(change * change / (sigma[k] * sigma[k]), 50.0);
    }
  }
  return energy;
}

SUREFOOT_ONCE std::vector<std::vector<double>> deciles(const FeatureTable& table) {
  std::vector<std::vector<double>> result;
  for (Eigen::Index f = 0; f < table.values.rows(); ++f) {
    std::vector<double> sorted;
    for (Eigen::Index j = 0; j < table.values.cols(); ++j) sorted.push_back(table.values(f, j));
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> cuts;
    for (int k = 1; k < 10; ++k) {
      const double cut = sorted[sorted.size() * static_cast<std::size_t>(k) / 10];
      if (cut > sorted.front() && (cuts.empty() || cut > cuts.back())) cuts.push_back(cut);
    }
    result.push_back(std::move(cuts));
  }
  return result;
}

SUREFOOT_ONCE Condition best_condition(const FeatureTable& table, const std::vector<std::vector<double>>& cuts,
                                       const Eigen::VectorXd& energy, const std::vector<bool>& inside) {
  Condition best;
  double all = 0, count = 0;
  for (Eigen::Index j = 0; j < energy.size(); ++j) {
    if (!inside[static_cast<std::size_t>(j)]) continue;
    all += energy[j];
    ++count;
  }
  for (Eigen::Index f = 0; f < table.values.rows(); ++f) {
    const auto& thresholds = cuts[static_cast<std::size_t>(f)];
    std::vector<double> sum(thresholds.size() + 1), number(thresholds.size() + 1);
    for (Eigen::Index j = 0; j < energy.size(); ++j) {
      if (!inside[static_cast<std::size_t>(j)]) continue;
      const auto bin = static_cast<std::size_t>(
          std::upper_bound(thresholds.begin(), thresholds.end(), table.values(f, j)) - thresholds.begin());
      sum[bin] += energy[j];
      ++number[bin];
    }
    double low = 0, low_count = 0;
    for (std::size_t k = 0; k < thresholds.size(); ++k) {
      low += sum[k];
      low_count += number[k];
      const double high = all - low, high_count = count - low_count;
      if (low_count < 0.02 * count || high_count < 0.02 * count) continue;
      const double difference = low / low_count - high / high_count;
      const double score = difference * difference * low_count * high_count / (count * count);
      if (score > best.score) best = {f, thresholds[k], difference > 0, score};
    }
  }
  return best;
}

SUREFOOT_ONCE std::string in_words(const FeatureTable& table, const Condition& condition) {
  char text[160];
  std::snprintf(text, sizeof text, "%s %s %.3g", table.names[static_cast<std::size_t>(condition.feature)].c_str(),
                condition.below ? "<" : ">=", condition.threshold);
  return text;
}

SUREFOOT_ONCE std::vector<MismatchRegion> find_region(const FeatureTable& table, const Eigen::VectorXd& energy,
                                                      int conditions, int permutations, std::uint64_t seed) {
  constexpr double denser = 1.3;  // than what a condition is cut out of, or it says nothing
  const auto samples = static_cast<std::size_t>(energy.size());
  if (samples < 50 || !(energy.sum() > 0)) return {};
  const auto cuts = deciles(table);
  std::vector<bool> inside(samples, true);
  MismatchRegion region;
  double first_score = 0;
  std::vector<Condition> rule;
  for (int c = 0; c < conditions; ++c) {
    const Condition condition = best_condition(table, cuts, energy, inside);
    if (condition.feature < 0) break;
    if (c == 0) first_score = condition.score;
    std::vector<bool> smaller = inside;
    double share = 0, count = 0, before = 0, before_count = 0;
    for (std::size_t j = 0; j < samples; ++j) {
      if (!inside[j]) continue;
      before += energy[static_cast<Eigen::Index>(j)];
      ++before_count;
      smaller[j] = condition.holds(table, static_cast<Eigen::Index>(j));
      if (!smaller[j]) continue;
      share += energy[static_cast<Eigen::Index>(j)];
      ++count;
    }
    if (share / count < denser * before / before_count) break;
    inside = smaller;
    drop_items(rule, [&](const Condition& one) {  // a tighter limit of the same
      return one.feature == condition.feature && one.below == condition.below;
    });
    rule.push_back(condition);
    region.share_of_excess = share / energy.sum();
    region.share_of_samples = count / static_cast<double>(samples);
  }
  if (rule.empty()) return {};
  for (const Condition& one : rule) region.rule += (region.rule.empty() ? "" : " and ") + in_words(table, one);
  // Blocks of a twentieth of a recording, dealt anew.
  std::vector<std::size_t> begin;
  for (std::size_t from = 0; from < samples;) {
    std::size_t to = from;
    while (to < samples && table.recording[to] == table.recording[from]) ++to;
    for (std::size_t part = 0; part < 20; ++part) begin.push_back(from + (to - from) * part / 20);
    from = to;
  }
  begin.push_back(samples);
  std::vector<std::size_t> order(begin.size() - 1);
  std::iota(order.begin(), order.end(), std::size_t{0});
  Rng rng(seed, 0x10ca7eu);
  int above = 1;
  for (int k = 0; k < permutations; ++k) {
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[rng.below(static_cast<std::uint32_t>(i))]);
    Eigen::VectorXd dealt(energy.size());
    Eigen::Index at = 0;
    for (const std::size_t block : order) {
      const auto length = static_cast<Eigen::Index>(begin[block + 1] - begin[block]);
      std::copy_n(energy.data() + begin[block], length, dealt.data() + at);
      at += length;
    }
    if (best_condition(table, cuts, dealt, std::vector<bool>(samples, true)).score >= first_score) ++above;
  }
  region.p_value = static_cast<double>(above) / (permutations + 1);
  return {region};
}

SUREFOOT_ONCE std::vector<MismatchInterval> find_intervals(const BoundSimulator& bound,
                                                           const std::vector<std::size_t>& recordings,
                                                           const FeatureTable& table, const Eigen::VectorXd& energy,
                                                           std::size_t count) {
  std::vector<MismatchInterval> all;
  const double total = energy.sum();
  if (!(total > 0)) return all;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const Recording& recording = bound.recordings[recordings[i]];
    std::vector<double> parts(20);
    for (Eigen::Index j = 0; j < energy.size(); ++j) {
      if (table.recording[static_cast<std::size_t>(j)] != i) continue;
      const auto part = static_cast<std::size_t>(20 * table.row[static_cast<std::size_t>(j)] / recording.rows());
      parts[part] += energy[j];
    }
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const auto from = static_cast<Eigen::Index>(part) * recording.rows() / 20;
      const auto to = std::min(static_cast<Eigen::Index>(part + 1) * recording.rows() / 20, recording.rows() - 1);
      all.push_back({recording.name, recording.time[from], recording.time[to], parts[part] / total});
    }
  }
  sort_items(
      all, [](const MismatchInterval& a, const MismatchInterval& b) { return a.share_of_excess > b.share_of_excess; });
  if (all.size() > count) all.resize(count);
  return all;
}

}  // namespace surefoot::diagnosis
