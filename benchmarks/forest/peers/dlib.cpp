#include <dlib/random_forest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "others.hpp"

namespace peers {
namespace {

using Trainer = dlib::random_forest_regression_trainer<dlib::dense_feature_extractor>;
using Point = Trainer::sample_type;

std::vector<Point> to_points(const std::vector<float>& x) {
  std::vector<Point> points(x.size() / inputs, Point(inputs));
  for (std::size_t i = 0; i < points.size(); ++i) std::copy_n(&x[i * inputs], inputs, points[i].begin());
  return points;
}

class Dlib final : public Model {
 public:
  explicit Dlib(Trainer::trained_function_type forest) : forest_(std::move(forest)) {}

  void keep(const std::vector<float>& points) override { points_ = to_points(points); }
  void predict_one(std::size_t kept, double* out) override { *out = forest_(points_[kept]); }
  void predict_all(double* out) override {
    for (const Point& point : points_) *out++ = forest_(point);
  }
  double leaves() const override {
    std::size_t sum = 0;
    for (const auto& leaves : forest_.get_tree_leaves()) sum += leaves.size();
    return static_cast<double>(sum) / static_cast<double>(forest_.get_num_trees());
  }
  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const auto& nodes : forest_.get_internal_tree_nodes()) sum += nodes.size() * sizeof(nodes[0]);
    for (const auto& leaves : forest_.get_tree_leaves()) sum += leaves.size() * sizeof(leaves[0]);
    return sum;
  }

 private:
  Trainer::trained_function_type forest_;
  std::vector<Point> points_;
};

}  // namespace

std::unique_ptr<Model> train_dlib(const Samples& samples, const Size& size) {
  Trainer trainer;
  trainer.set_num_trees(static_cast<std::size_t>(size.trees));
  trainer.set_feature_subsampling_fraction(1);  // better on so few inputs than a part of them
  trainer.set_min_samples_per_leaf(static_cast<std::size_t>(size.min_leaf));
  return std::make_unique<Dlib>(trainer.train(to_points(samples.x), samples.y));
}

}  // namespace peers
