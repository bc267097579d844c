// Definitions of surefoot/diagnose/estimation/data_split.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/diagnose/estimation/data_split.hpp"
#include "surefoot/diagnose/estimation/items.hpp"
#include "surefoot/diagnose/estimation/sort_items.hpp"
#include "surefoot/diagnose/recording.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE RecordingSplit split_recordings(const std::vector<Recording>& recordings,
                                              const std::vector<std::string>& held_out, double share,
                                              std::size_t folds, std::uint64_t seed) {
  std::vector<std::size_t> order(recordings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Rng rng(seed, 0x5370u);
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[rng.below(static_cast<std::uint32_t>(i))]);
  }
  RecordingSplit split;
  for (const std::string& name : held_out) {
    const auto found = find_item(recordings, [&](const Recording& recording) { return recording.name == name; });
    if (found == nullptr) throw DiagnoseError("the held-out recording '" + name + "' is not among the recordings");
    split.held_out.push_back(static_cast<std::size_t>(found - recordings.data()));
  }
  split.cross_fitted = held_out.empty() && !(share > 0);
  if (held_out.empty() && share > 0) {
    const auto wanted = static_cast<std::size_t>(std::lround(share * static_cast<double>(recordings.size())));
    const std::size_t count = std::clamp<std::size_t>(wanted, 1, recordings.size() - 1);
    for (std::size_t i = 0; i < count; ++i) split.held_out.push_back(order[i]);
  }
  sort_items(split.held_out, std::less<>());
  for (const std::size_t r : order) {
    if (!std::binary_search(split.held_out.begin(), split.held_out.end(), r)) split.training.push_back(r);
  }
  if (split.training.empty()) throw DiagnoseError("no recording is left for the fit: name fewer held-out recordings");
  const std::size_t count = split.training.size();
  split.folds.resize(count <= folds + 2 ? count : folds);
  for (std::size_t i = 0; i < split.training.size(); ++i)
    split.folds[i % split.folds.size()].push_back(split.training[i]);
  for (auto& fold : split.folds) sort_items(fold, std::less<>());
  sort_items(split.training, std::less<>());
  if (split.cross_fitted) split.held_out = split.training;
  return split;
}

}  // namespace surefoot::diagnosis
