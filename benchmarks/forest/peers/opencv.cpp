#include <cstddef>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/ml.hpp>
#include <utility>
#include <vector>

#include "others.hpp"

namespace peers {
namespace {

constexpr int width = static_cast<int>(inputs);

cv::Mat to_rows(const std::vector<float>& x) {
  return cv::Mat(static_cast<int>(x.size() / inputs), width, CV_32F, const_cast<float*>(x.data())).clone();
}

class OpenCv final : public Model {
 public:
  explicit OpenCv(cv::Ptr<cv::ml::RTrees> forest) : forest_(std::move(forest)) {}

  void keep(const std::vector<float>& points) override {
    points_ = to_rows(points);
    rows_.clear();
    for (int i = 0; i < points_.rows; ++i) rows_.push_back(points_.row(i));
  }
  void predict_one(std::size_t kept, double* out) override {
    *out = static_cast<double>(forest_->predict(rows_[kept]));
  }
  void predict_all(double* out) override {
    forest_->predict(points_, results_);
    for (int i = 0; i < points_.rows; ++i) out[i] = static_cast<double>(results_.at<float>(i));
  }
  double leaves() const override {  // every inner node has one split
    const double leaves = static_cast<double>(forest_->getNodes().size() - forest_->getSplits().size());
    return leaves / static_cast<double>(forest_->getRoots().size());
  }
  std::size_t bytes() const override {
    return forest_->getNodes().size() * sizeof(cv::ml::DTrees::Node) +
           forest_->getSplits().size() * sizeof(cv::ml::DTrees::Split);
  }

 private:
  cv::Ptr<cv::ml::RTrees> forest_;
  cv::Mat points_;
  cv::Mat results_;
  std::vector<cv::Mat> rows_;
};

}  // namespace

std::unique_ptr<Model> train_opencv(const Samples& samples, const Size& size) {
  cv::setNumThreads(1);
  const cv::Mat x = to_rows(samples.x);
  const cv::Mat y(std::vector<float>(samples.y.begin(), samples.y.end()), true);
  const auto forest = cv::ml::RTrees::create();
  forest->setMaxDepth(100);
  forest->setMinSampleCount(size.min_leaf);
  forest->setRegressionAccuracy(0);
  forest->setActiveVarCount(width);  // better on so few inputs than a part of them
  forest->setTermCriteria(cv::TermCriteria(cv::TermCriteria::MAX_ITER, size.trees, 0));
  forest->train(cv::ml::TrainData::create(x, cv::ml::ROW_SAMPLE, y));
  return std::make_unique<OpenCv>(forest);
}

}  // namespace peers
