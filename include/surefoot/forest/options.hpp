// Options of training.
#pragma once

#include "surefoot/core/compiled.hpp"

namespace surefoot {

/// How a candidate threshold is drawn.
enum class ThresholdRule {
  uniform,   // between the smallest and the largest value in the node, as in the paper
  balanced,  // between the min_leaf-th smallest and the min_leaf-th largest value: never a child that is too small
};

struct ExtraTreesOptions {
  int trees = 25;
  int candidates = 0;      // K, inputs tried per split; 0: all
  int draws = 1;           // thresholds tried for each of them; 1, as in the paper, for trees to be averaged
  int min_leaf = 4;        // fewest samples in a leaf (n_min)
  int max_depth = 0;       // splits from the root to any leaf; 0: no limit
  int max_leaves = 0;      // per tree, grown best first; 0: no limit
  bool bootstrap = false;  // each tree draws its samples with replacement; train_with_report then tells the error
  ThresholdRule threshold_rule = ThresholdRule::uniform;
  bool model_score = true;  // linear leaves: score splits by affine fits, not by variance
  int split_samples = 0;    // linear leaves: so many samples of a node, or up to twice as many, score splits; 0: all
  double ridge = 1;         // linear leaves: see LeafOptions
  bool clamp = true;        // linear leaves: see LeafOptions
};

/// Throws a ForestError that names the field and its range.
void check(const ExtraTreesOptions& options);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/options.ipp"
#endif
