#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "others.hpp"

namespace peers {
namespace {

class EachOutput final : public Model {
 public:
  explicit EachOutput(std::vector<std::unique_ptr<Model>> models) : models_(std::move(models)) {}

  void keep(const std::vector<float>& points) override {
    for (const auto& model : models_) model->keep(points);
    column_.resize(points.size() / inputs);
  }
  void predict_one(std::size_t kept, double* out) override {
    for (const auto& model : models_) model->predict_one(kept, out++);
  }
  void predict_all(double* out) override {
    for (std::size_t m = 0; m < models_.size(); ++m) {
      models_[m]->predict_all(column_.data());
      for (std::size_t i = 0; i < column_.size(); ++i) out[i * models_.size() + m] = column_[i];
    }
  }
  double leaves() const override {
    double sum = 0;
    for (const auto& model : models_) sum += model->leaves();
    return sum / static_cast<double>(models_.size());
  }
  std::size_t bytes() const override {
    std::size_t sum = 0;
    for (const auto& model : models_) sum += model->bytes();
    return sum;
  }

 private:
  std::vector<std::unique_ptr<Model>> models_;
  std::vector<double> column_;
};

}  // namespace

std::unique_ptr<Model> train_each_output(Train train, const Samples& samples, const Size& size) {
  std::vector<std::unique_ptr<Model>> models;
  Samples one{1, samples.x, std::vector<double>(samples.count())};
  for (std::size_t output = 0; output < samples.outputs; ++output) {
    for (std::size_t i = 0; i < one.count(); ++i) one.y[i] = samples.y[i * samples.outputs + output];
    models.push_back(train(one, size));
  }
  return std::make_unique<EachOutput>(std::move(models));
}

}  // namespace peers
