// The leaf models that policies are learnt with: linear leaves fitted to one opinion. Where neighbouring states of
// equal worth have different best actions (forwards to the left or backwards to the right), a mean over them is what
// none of them wants, often to stand still for ever. What is learnt is an ordinary LinearLeaf.
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

/// What samples of one opinion have in common: their distance from an affine fit to all of a leaf, so that a steep
/// feedback is one opinion however noisy; or their actions, so that a step from full left to full right is two: a fit
/// across it is a slope, most samples are near it, and in the middle it says to stand still.
enum class OpinionsOf { distances, actions };

/// Outputs are actions in half widths of the action box. A leaf whose samples lie around its affine fit is that fit.
/// Else it is fitted anew to the largest group of samples of one opinion. Cost: that of two fits, and of `most_centres`
/// comparisons per sample.
template <OpinionsOf By>
struct OpinionLeaf : LinearLeaf {
  static constexpr std::size_t most_centres = 32;  // samples tried as the centre of a group
  static constexpr double few = 0.1;               // share of samples off the fit that are noise and no second opinion

  static void fit(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters) {
    LinearLeaf::fit(samples, options, parameters);
    const std::size_t count = samples.count();
    const auto outputs = static_cast<std::size_t>(samples.outputs());
    std::vector<float> places(count * outputs);  // what samples of one opinion have in common
    std::vector<double> fitted(outputs);
    std::size_t far = 0;
    for (std::size_t i = 0; i < count; ++i) {
      std::ranges::fill(fitted, 0.0);
      LinearLeaf::add(parameters.data(), samples.input(i), samples.inputs(), samples.outputs(), fitted.data());
      bool near = true;
      for (std::size_t o = 0; o < outputs; ++o) {
        const float action = samples.output(i)[o];
        const float distance = action - static_cast<float>(fitted[o]);
        places[i * outputs + o] = By == OpinionsOf::actions ? action : distance;
        near = near && std::abs(distance) <= static_cast<float>(same_opinion);
      }
      far += near ? 0 : 1;
    }
    if (static_cast<double>(far) <= few * static_cast<double>(count)) return;
    fit_group(samples, options, parameters, places, largest_group(places, count, outputs));
  }

 private:
  static bool together(const std::vector<float>& places, std::size_t a, std::size_t b, std::size_t outputs) {
    for (std::size_t o = 0; o < outputs; ++o) {
      if (std::abs(places[a * outputs + o] - places[b * outputs + o]) > static_cast<float>(same_opinion)) return false;
    }
    return true;
  }

  /// Its centre.
  static std::size_t largest_group(const std::vector<float>& places, std::size_t count, std::size_t outputs) {
    const std::size_t stride = (count + most_centres - 1) / most_centres;
    std::size_t best = 0, most = 0;
    for (std::size_t centre = 0; centre < count; centre += stride) {
      std::size_t members = 0;
      for (std::size_t i = 0; i < count; ++i) members += together(places, centre, i, outputs) ? 1 : 0;
      if (members > most) {
        most = members;
        best = centre;
      }
    }
    return best;
  }

  static void fit_group(const LeafSamples& samples, const LeafOptions& options, std::span<float> parameters,
                        const std::vector<float>& places, std::size_t centre) {
    const auto inputs = static_cast<std::size_t>(samples.inputs());
    const auto outputs = static_cast<std::size_t>(samples.outputs());
    const std::size_t stride = inputs + outputs + 1;
    std::vector<float> records;
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples.count(); ++i) {
      if (!together(places, centre, i, outputs)) continue;
      records.insert(records.end(), samples.input(i), samples.input(i) + inputs + outputs);
      records.push_back(static_cast<float>(samples.weight(i)));
      ++count;
    }
    LinearLeaf::fit(LeafSamples(records.data(), count, stride, samples.inputs(), samples.outputs(), true), options,
                    parameters);
  }
};

/// The usual one, and the one that is tried beside it.
using ActionLeaf = OpinionLeaf<OpinionsOf::distances>;
using LikeActionLeaf = OpinionLeaf<OpinionsOf::actions>;

static_assert(LeafModel<ActionLeaf>);
static_assert(LeafModel<LikeActionLeaf>);

}  // namespace surefoot
