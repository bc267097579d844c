// A forest of this library behind the interface that all share.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "model.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/forest/dataset.hpp"
#include "surefoot/forest/forest.hpp"

namespace peers {
namespace {  // surefoot.cpp compiles it twice, differently

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

template <int Outputs>
surefoot::Dataset<width, Outputs> data_of(const Samples& samples) {
  const auto count = static_cast<Eigen::Index>(samples.count());
  surefoot::Dataset<width, Outputs> data;
  data.inputs = Eigen::Map<const Eigen::Matrix<float, width, Eigen::Dynamic>>(samples.x.data(), width, count);
  data.outputs = Eigen::Map<const Eigen::Matrix<double, Outputs, Eigen::Dynamic>>(samples.y.data(), Outputs, count);
  return data;
}

}  // namespace
}  // namespace peers
