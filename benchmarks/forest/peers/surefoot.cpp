// Compiled twice: as it is, and with SUREFOOT_PORTABLE and the namespace surefoot renamed, so that both can be linked.
#include "surefoot.hpp"

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"

namespace peers {
namespace {

constexpr int width = static_cast<int>(inputs);

template <int Outputs, class Leaf>
class Surefoot final : public Model {
 public:
  using Forest = surefoot::Forest<width, Outputs, Leaf>;
  explicit Surefoot(Forest forest) : forest_(std::move(forest)) {}

  void keep(const std::vector<float>& points) override {
    batch_ = points;
    points_.clear();
    for (std::size_t i = 0; i < points.size(); i += inputs) {
      points_.push_back(Eigen::Map<const Eigen::Matrix<float, width, 1>>(&points[i]).template cast<double>());
    }
  }
  void predict_one(std::size_t kept, double* out) override {
    Eigen::Map<surefoot::Vec<Outputs>>{out} = forest_.predict(points_[kept]);
  }
  void predict_all(double* out) override { forest_.predict(batch_.data(), points_.size(), out); }
  double leaves() const override {
    return static_cast<double>(forest_.leaves()) / static_cast<double>(forest_.trees());
  }
  std::size_t bytes() const override { return forest_.bytes(); }

 private:
  Forest forest_;
  std::vector<float> batch_;
  std::vector<surefoot::Vec<width>> points_;
};

template <int Outputs, class Leaf>
std::unique_ptr<Model> train(const Samples& samples, const Size& size) {
  const auto count = static_cast<Eigen::Index>(samples.count());
  surefoot::Dataset<width, Outputs> data;
  data.inputs = Eigen::Map<const Eigen::Matrix<float, width, Eigen::Dynamic>>(samples.x.data(), width, count);
  data.outputs = Eigen::Map<const Eigen::Matrix<double, Outputs, Eigen::Dynamic>>(samples.y.data(), Outputs, count);
  surefoot::ExtraTreesOptions options{.trees = size.trees, .min_leaf = size.min_leaf, .max_leaves = size.leaves};
  if (size.balanced) options.threshold_rule = surefoot::ThresholdRule::balanced;
  return std::make_unique<Surefoot<Outputs, Leaf>>(
      surefoot::train_extra_trees<Leaf>(data, options, surefoot::Threads(size.threads), 1));
}

template <class Leaf>
std::unique_ptr<Model> train(const Samples& samples, const Size& size) {
  switch (samples.outputs) {
    case 1:
      return train<1, Leaf>(samples, size);
    case 3:
      return train<3, Leaf>(samples, size);
    case 6:
      return train<6, Leaf>(samples, size);
    default:
      throw std::invalid_argument("forests of 1, 3 or 6 outputs only");
  }
}

}  // namespace

#ifdef SUREFOOT_PORTABLE
std::unique_ptr<Model> train_constant_portable(const Samples& samples, const Size& size) {
  return train<surefoot::ConstantLeaf>(samples, size);
}
std::unique_ptr<Model> train_linear_portable(const Samples& samples, const Size& size) {
  return train<surefoot::LinearLeaf>(samples, size);
}
#else
std::unique_ptr<Model> train_constant(const Samples& samples, const Size& size) {
  return train<surefoot::ConstantLeaf>(samples, size);
}
std::unique_ptr<Model> train_linear(const Samples& samples, const Size& size) {
  return train<surefoot::LinearLeaf>(samples, size);
}
#endif

}  // namespace peers
