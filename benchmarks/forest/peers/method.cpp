#include "method.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "others.hpp"
#include "surefoot.hpp"

namespace peers {

std::vector<Method> all_methods() {
  std::vector<Method> methods = {
      {.name = "surefoot constant", .train = train_constant, .min_leaf = 2},
      {.name = "surefoot constant, portable", .train = train_constant_portable, .min_leaf = 2},
      {.name = "surefoot linear", .train = train_linear, .min_leaf = 10, .balanced = true},
      {.name = "surefoot linear, portable", .train = train_linear_portable, .min_leaf = 10, .balanced = true},
      {.name = "surefoot pruned", .train = train_pruned, .min_leaf = 10},
      {.name = "surefoot distilled", .train = train_distilled, .min_leaf = 10, .one_tree = true},
      {.name = "surefoot one tree", .train = train_one_tree, .min_leaf = 10, .one_tree = true},
#ifdef HAVE_DLIB
      {.name = "dlib", .train = train_dlib},
#endif
#ifdef HAVE_OPENCV
      {.name = "OpenCV", .train = train_opencv},
#endif
#ifdef HAVE_XGBOOST
      {.name = "XGBoost", .train = train_xgboost, .min_leaf = 1},
#endif
      {.name = "surefoot constant", .outputs = 3, .train = train_constant, .min_leaf = 2},
      {.name = "surefoot constant, portable", .outputs = 3, .train = train_constant_portable, .min_leaf = 2},
      {.name = "surefoot linear", .outputs = 3, .train = train_linear, .min_leaf = 10, .balanced = true},
      {.name = "surefoot pruned", .outputs = 3, .train = train_pruned, .min_leaf = 10},
      {.name = "surefoot distilled", .outputs = 3, .train = train_distilled, .min_leaf = 10, .one_tree = true},
      {.name = "surefoot one tree", .outputs = 3, .train = train_one_tree, .min_leaf = 10, .one_tree = true},
#ifdef HAVE_DLIB
      {.name = "dlib", .outputs = 3, .train = train_dlib, .each_output = true},
#endif
  };
  if (have_c_compiler()) {
    const auto after_ours = std::find_if(methods.begin(), methods.end(),
                                         [](const Method& method) { return !method.name.starts_with("surefoot"); });
    methods.insert(after_ours,
                   {{.name = "surefoot C tables", .train = train_c_tables, .min_leaf = 2},
                    {.name = "surefoot C tables, int16", .train = train_c_tables_int16, .min_leaf = 2},
                    {.name = "surefoot C, no floating point", .train = train_c_whole, .min_leaf = 2},
                    {.name = "surefoot C branches", .train = train_c_branches, .min_leaf = 2, .most_leaves = 2'000}});
  }
  return methods;
}

std::unique_ptr<Model> train(const Method& method, const Samples& samples, const Size& size) {
  return method.each_output ? train_each_output(method.train, samples, size) : method.train(samples, size);
}

Size size_for(const Method& method, const Samples& samples, int trees, int leaves) {
  if (method.min_leaf > 0) {  // fewer samples per leaf where so many leaves need it
    const int spare = static_cast<int>(samples.count()) / (2 * leaves);
    return {trees, leaves, std::max(1, std::min(method.min_leaf, spare)), 1, method.balanced};
  }
  // Leaves fall as samples per leaf grow, about inversely: improve the guess as long as that brings new ones.
  std::map<int, double> error;  // of what was tried
  double guess = 1.3 * static_cast<double>(samples.count()) / leaves;
  for (;;) {
    const int min_leaf = std::max(1, static_cast<int>(std::lround(guess)));
    if (error.contains(min_leaf)) break;
    const double got = train(method, samples, {1, 0, min_leaf})->leaves();
    error[min_leaf] = std::abs(std::log(got / leaves));
    if (error[min_leaf] < 0.01) break;
    guess = min_leaf * got / leaves;
  }
  const auto best =
      std::min_element(error.begin(), error.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return {trees, 0, best->first};
}

}  // namespace peers
