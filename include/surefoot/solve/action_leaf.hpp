// The leaf model that policies are learnt with: a linear leaf fitted to one opinion. Where neighbouring states of equal
// worth have different best actions (forwards to the left or backwards to the right), a mean over them is what none of
// them wants, often to stand still for ever. What is learnt is an ordinary LinearLeaf.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "surefoot/forest/leaf.hpp"
#include "surefoot/solve/agreement.hpp"

namespace surefoot {

/// Outputs are actions in half widths of the action box. A leaf whose samples lie around its affine fit is that fit.
/// Else it is fitted anew to the largest group of samples whose actions are of one opinion. Actions, not distances from
/// the first fit: across a step from full left to full right that fit is a slope, most samples are near it, and in the
/// middle it says to stand still. Cost: that of two fits, and of `most_centres` comparisons per sample.
struct ActionLeaf : LinearLeaf {
  static constexpr std::size_t most_centres = 32;  // samples tried as the centre of a group
  static constexpr double few = 0.1;               // share of samples off the fit that are noise and no second opinion

  static void fit(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters) {
    LinearLeaf::fit(samples, options, parameters);
    const std::size_t count = samples.count();
    const auto outputs = static_cast<std::size_t>(samples.outputs());
    std::vector<double> fitted(outputs);
    std::size_t far = 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::ranges::fill(fitted, 0.0);
      LinearLeaf::add(parameters.data(), samples.input(i), samples.inputs(), samples.outputs(), fitted.data());
      bool near = true;
      for (std::size_t o = 0; o < outputs; ++o) {
        near = near && std::abs(samples.output(i)[o] - static_cast<float>(fitted[o])) <= reach;
      }
      far += near ? 0 : 1;
    }
    if (static_cast<double>(far) <= few * static_cast<double>(count)) return;
    fit_group(samples, options, parameters, largest_group(samples));
  }

 private:
  static constexpr auto reach = static_cast<float>(same_opinion);

  static bool together(const LeafSamples& samples, std::size_t a, std::size_t b) {
    const float *const of_a = samples.output(a), *const of_b = samples.output(b);
    for (int o = 0; o < samples.outputs(); ++o) {
      if (std::abs(of_a[o] - of_b[o]) > reach) return false;
    }
    return true;
  }

  /// Its centre.
  static std::size_t largest_group(const LeafSamples& samples) {
    const std::size_t count = samples.count();
    const std::size_t stride = (count + most_centres - 1) / most_centres;
    std::size_t best = 0, most = 0;
    for (std::size_t centre = 0; centre < count; centre += stride) {
      std::size_t members = 0;
      for (std::size_t i = 0; i < count; ++i) members += together(samples, centre, i) ? 1 : 0;
      if (members > most) {
        most = members;
        best = centre;
      }
    }
    return best;
  }

  static void fit_group(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters,
                        std::size_t centre) {
    const auto inputs = static_cast<std::size_t>(samples.inputs());
    const auto outputs = static_cast<std::size_t>(samples.outputs());
    const std::size_t stride = inputs + outputs + 1;
    std::vector<float> records;
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples.count(); ++i) {
      if (!together(samples, centre, i)) continue;
      records.insert(records.end(), samples.input(i), samples.input(i) + inputs + outputs);
      records.push_back(static_cast<float>(samples.weight(i)));
      ++count;
    }
    LinearLeaf::fit(LeafSamples(records.data(), count, stride, samples.inputs(), samples.outputs(), true), options,
                    parameters);
  }
};

static_assert(LeafModel<ActionLeaf>);

}  // namespace surefoot
