#include "surefoot/forest/options.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "surefoot/core/error.hpp"

namespace surefoot {
namespace {

TEST_CASE("options of training that make no sense are named") {
  CHECK_NOTHROW(check(ExtraTreesOptions{}));
  const auto complains = [](const char* field, void (*spoil)(ExtraTreesOptions&)) {
    ExtraTreesOptions options;
    spoil(options);
    CHECK_THROWS_WITH_AS(check(options), doctest::Contains(field), ForestError);
  };
  complains("trees", [](ExtraTreesOptions& o) { o.trees = 0; });
  complains("candidates", [](ExtraTreesOptions& o) { o.candidates = -1; });
  complains("draws", [](ExtraTreesOptions& o) { o.draws = 0; });
  complains("split_samples", [](ExtraTreesOptions& o) { o.split_samples = -1; });
  complains("min_leaf", [](ExtraTreesOptions& o) { o.min_leaf = 0; });
  complains("max_depth", [](ExtraTreesOptions& o) { o.max_depth = -1; });
  complains("max_leaves", [](ExtraTreesOptions& o) { o.max_leaves = -1; });
  complains("ridge", [](ExtraTreesOptions& o) { o.ridge = std::numeric_limits<double>::infinity(); });
}

}  // namespace
}  // namespace surefoot
