// Records: the samples as training moves them about, each in whole vectors of 4 floats: inputs, outputs, weight if any.
#pragma once

#include <cstddef>
#include <vector>

#include "surefoot/forest/trees.hpp"

namespace surefoot::detail {

/// Where things are in a record.
struct RecordShape {
  int inputs = 0;
  int outputs = 0;
  bool weighted = false;

  std::size_t input_quads() const { return (static_cast<std::size_t>(inputs) + 3) / 4; }
  std::size_t stride() const {
    return (static_cast<std::size_t>(inputs) + static_cast<std::size_t>(outputs) + (weighted ? 1 : 0) + 3) / 4 * 4;
  }
  std::size_t output_at() const { return static_cast<std::size_t>(inputs); }
  std::size_t weight_at() const { return static_cast<std::size_t>(inputs) + static_cast<std::size_t>(outputs); }
};

using Records = std::vector<float, CacheLineAllocator<float>>;

/// Some consecutive records.
struct RecordSpan {
  const float* first = nullptr;
  std::size_t count = 0;
  std::size_t stride = 0;

  const float* operator[](std::size_t i) const { return first + i * stride; }
};

}  // namespace surefoot::detail
