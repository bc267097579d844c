// Its random forest mode: one round of boosting with many trees side by side.
#include <xgboost/c_api.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "others.hpp"

namespace peers {
namespace {

void require(int failed) {
  if (failed != 0) throw std::runtime_error(std::string("XGBoost: ") + XGBGetLastError());
}

std::string array_of(const float* x, std::size_t rows) {
  return R"({"data": [)" + std::to_string(reinterpret_cast<std::size_t>(x)) + R"(, true], "shape": [)" +
         std::to_string(rows) + ", " + std::to_string(inputs) + R"(], "typestr": "<f4", "version": 3})";
}

struct Matrix {
  explicit Matrix(const Samples& samples) {
    const std::vector<float> y(samples.y.begin(), samples.y.end());
    require(XGDMatrixCreateFromMat(samples.x.data(), samples.count(), inputs, NAN, &handle));
    require(XGDMatrixSetFloatInfo(handle, "label", y.data(), y.size()));
  }
  Matrix(const Matrix&) = delete;
  Matrix& operator=(const Matrix&) = delete;
  ~Matrix() { XGDMatrixFree(handle); }
  DMatrixHandle handle = nullptr;
};

class XgBoost final : public Model {
 public:
  XgBoost(const Samples& samples, const Size& size) : trees_(static_cast<std::size_t>(size.trees)) {
    const double mean = std::accumulate(samples.y.begin(), samples.y.end(), 0.0) / static_cast<double>(samples.count());
    const Matrix matrix(samples);
    require(XGBoosterCreate(&matrix.handle, 1, &booster_));
    set("nthread", "1");
    set("objective", "reg:squarederror");
    set("base_score", std::to_string(mean));
    set("num_parallel_tree", std::to_string(size.trees));
    set("subsample", "0.632");
    set("learning_rate", "1");
    set("lambda", "0");
    set("tree_method", "hist");
    set("grow_policy", "lossguide");
    set("max_depth", "0");
    set("max_leaves", std::to_string(size.leaves));
    require(XGBoosterUpdateOneIter(booster_, 0, matrix.handle));
  }
  XgBoost(const XgBoost&) = delete;
  XgBoost& operator=(const XgBoost&) = delete;
  ~XgBoost() override { XGBoosterFree(booster_); }

  void keep(const std::vector<float>& points) override {
    points_ = points;
    const std::size_t count = points_.size() / inputs;
    rows_.clear();
    for (std::size_t i = 0; i < count; ++i) rows_.push_back(array_of(&points_[i * inputs], 1));
    all_ = array_of(points_.data(), count);
  }
  void predict_one(std::size_t kept, double* out) override { *out = static_cast<double>(*predict(rows_[kept])); }
  void predict_all(double* out) override { std::copy_n(predict(all_), rows_.size(), out); }

  double leaves() const override { return static_cast<double>(all_leaves()) / static_cast<double>(trees_); }
  std::size_t bytes() const override {
    constexpr std::size_t node = 20;  // parent, two children, input, threshold or value
    return (2 * all_leaves() - trees_) * node;
  }

 private:
  void set(const char* name, const std::string& value) { require(XGBoosterSetParam(booster_, name, value.c_str())); }

  const float* predict(const std::string& points) {
    constexpr const char* how =
        R"({"type": 0, "training": false, "iteration_begin": 0, "iteration_end": 0, "strict_shape": false, "cache_id": 0, "missing": NaN})";
    const bst_ulong* shape = nullptr;
    bst_ulong dimensions = 0;
    const float* result = nullptr;
    require(XGBoosterPredictFromDense(booster_, points.c_str(), how, nullptr, &shape, &dimensions, &result));
    return result;
  }

  std::size_t all_leaves() const {
    bst_ulong trees = 0;
    const char** texts = nullptr;
    require(XGBoosterDumpModel(booster_, "", 0, &trees, &texts));
    std::size_t leaves = 0;
    for (bst_ulong tree = 0; tree < trees; ++tree) {
      const std::string_view text = texts[tree];
      for (auto at = text.find("leaf="); at != text.npos; at = text.find("leaf=", at + 1)) ++leaves;
    }
    return leaves;
  }

  std::size_t trees_;
  BoosterHandle booster_ = nullptr;
  std::vector<float> points_;
  std::vector<std::string> rows_;
  std::string all_;
};

}  // namespace

std::unique_ptr<Model> train_xgboost(const Samples& samples, const Size& size) {
  return std::make_unique<XgBoost>(samples, size);
}

}  // namespace peers
