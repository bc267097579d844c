// Tasks for every library: learn from the same samples, predict the same points.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace peers {

constexpr std::size_t inputs = 6;
constexpr std::size_t most_outputs = 6;

/// Samples or points, one behind the other; nothing of any library.
struct Samples {
  std::size_t outputs = 1;
  std::vector<float> x;   // inputs per sample
  std::vector<double> y;  // outputs per sample; empty: points only

  std::size_t count() const { return x.size() / inputs; }
};

/// How large a forest is wanted. Some libraries take the leaves per tree, others the samples per leaf.
struct Size {
  int trees = 25;
  int leaves = 0;           // most per tree; 0: no limit
  int min_leaf = 1;         // samples per leaf, in the library's own sense
  std::size_t threads = 1;  // to train with; ours only
  bool balanced = false;    // ours only: the threshold rule that is better and slower for linear leaves
};

/// A trained forest. Points are handed over ahead of time, in the library's own type, so that only prediction is timed.
class Model {
 public:
  Model() = default;
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  virtual ~Model() = default;

  virtual void keep(const std::vector<float>& points) = 0;
  virtual void predict_one(std::size_t kept, double* out) = 0;
  virtual void predict_all(double* out) = 0;  // of all kept points, by the library's call for many if it has one

  virtual double leaves() const = 0;      // mean per tree
  virtual std::size_t bytes() const = 0;  // that predictions read
};

using Train = std::unique_ptr<Model> (*)(const Samples&, const Size&);

}  // namespace peers
