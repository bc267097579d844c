#include "surefoot/forest/train/linear_score.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "surefoot/core/rng.hpp"

namespace surefoot {
namespace {

using detail::LinearScore;
using detail::RecordShape;
using detail::RecordSpan;

// What a weighted ridge fit to some samples explains of the outputs' squares about `center`, by the textbook.
double explained_by_fit(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs, const Eigen::VectorXd& weights,
                        const Eigen::VectorXd& center, const Eigen::VectorXd& scale, double ridge) {
  const double weight = weights.sum();
  const Eigen::VectorXd x_mean = inputs * weights / weight;
  const Eigen::VectorXd y_mean = outputs * weights / weight;
  const Eigen::MatrixXd x = inputs.colwise() - x_mean;
  Eigen::MatrixXd normal = x * weights.asDiagonal() * x.transpose();
  normal.diagonal() *= 1 + ridge / static_cast<double>(weights.size());
  const Eigen::MatrixXd right = x * weights.asDiagonal() * (outputs.colwise() - y_mean).transpose();
  const Eigen::MatrixXd slopes = normal.llt().solve(right);
  double sum = 0;
  for (Eigen::Index o = 0; o < outputs.rows(); ++o) {
    const double offset = y_mean[o] - center[o];
    sum += scale[o] * (weight * offset * offset + right.col(o).dot(slopes.col(o)));
  }
  return sum;
}

TEST_CASE("running sums explain as much as fits to the samples themselves") {
  for (const auto& [inputs, outputs, weighted] :
       {RecordShape{2, 1, false}, RecordShape{3, 1, false}, RecordShape{6, 1, true}, RecordShape{6, 3, false},
        RecordShape{4, 4, false}, RecordShape{9, 2, true}}) {
    const RecordShape shape{inputs, outputs, weighted};
    CAPTURE(inputs);
    CAPTURE(outputs);
    constexpr int count = 333;
    Rng rng(1);
    std::vector<float> numbers(count * shape.stride(), 0.0F);
    Eigen::MatrixXd x(inputs, count);
    Eigen::MatrixXd y(outputs, count);
    Eigen::VectorXd w = Eigen::VectorXd::Ones(count);
    for (int i = 0; i < count; ++i) {
      float* record = numbers.data() + static_cast<std::size_t>(i) * shape.stride();
      for (int k = 0; k < inputs; ++k) record[k] = static_cast<float>((k + 1) * rng.uniform(5, 6));
      for (int o = 0; o < outputs; ++o)
        record[inputs + o] = static_cast<float>(record[o % inputs] + 100 + rng.normal());
      if (weighted) record[shape.weight_at()] = static_cast<float>(rng.uniform(0.5, 2));
      for (int k = 0; k < inputs; ++k) x(k, i) = static_cast<double>(record[k]);
      for (int o = 0; o < outputs; ++o) y(o, i) = static_cast<double>(record[inputs + o]);
      if (weighted) w[i] = static_cast<double>(record[shape.weight_at()]);
    }
    const RecordSpan records{numbers.data(), count, shape.stride()};
    std::vector<float> low(shape.stride());
    std::vector<float> high(shape.stride());
    std::vector<float> mean(shape.stride());
    detail::find_range(records, low.data(), high.data(), mean.data());
    const std::vector<int> chosen{1, 0};
    std::vector<float> thresholds(shape.stride(), 0.0F);
    thresholds[0] = 5.3F;
    thresholds[1] = 11.7F;
    const Eigen::VectorXd scale = Eigen::VectorXd::LinSpaced(outputs, 1, 2);
    const std::span<const double> scales(scale.data(), static_cast<std::size_t>(outputs));
    LinearScore score(shape);
    score.measure(records, chosen, thresholds.data(), low.data(), high.data(), mean.data());

    Eigen::VectorXd center(outputs);
    for (int o = 0; o < outputs; ++o) center[o] = static_cast<double>(mean[static_cast<std::size_t>(inputs + o)]);
    const double ridge = 0.5;
    CHECK(score.explained_together(scales, ridge) ==
          doctest::Approx(explained_by_fit(x, y, w, center, scale, ridge)).epsilon(1e-4));
    for (std::size_t c = 0; c < chosen.size(); ++c) {
      std::vector<int> side[2];
      for (int i = 0; i < count; ++i) {
        const bool right = x(chosen[c], i) > static_cast<double>(thresholds[static_cast<std::size_t>(chosen[c])]);
        side[right ? 1 : 0].push_back(i);
      }
      CHECK(score.left_count(c) == side[0].size());
      double apart = 0;
      for (const auto& s : side) {
        apart += explained_by_fit(x(Eigen::all, s), y(Eigen::all, s), w(s), center, scale, ridge);
      }
      CHECK(score.explained_apart(c, scales, ridge) == doctest::Approx(apart).epsilon(1e-4));
    }
  }
}

TEST_CASE("an input that is constant on one side, or copies another, explains nothing more") {
  const RecordShape shape{3, 1, false};
  Rng rng(2);
  std::vector<float> numbers;
  for (int i = 0; i < 100; ++i) {
    const auto a = static_cast<float>(rng.normal());
    numbers.insert(numbers.end(), {a, a > 0 ? a : 0.0F, 2 * a, 3 * a});
  }
  const RecordSpan records{numbers.data(), 100, 4};
  std::array<float, 4> low;
  std::array<float, 4> high;
  std::array<float, 4> mean;
  detail::find_range(records, low.data(), high.data(), mean.data());
  const std::vector<int> chosen{0};
  const std::array<float, 4> thresholds{0, 0, 0, 0};
  const std::array<double, 1> scale{1};
  LinearScore score(shape);
  score.measure(records, chosen, thresholds.data(), low.data(), high.data(), mean.data());
  double squares = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double y = static_cast<double>(records[i][3]) - static_cast<double>(mean[3]);
    squares += y * y;
  }
  CHECK(score.explained_together(scale, 0) == doctest::Approx(squares).epsilon(1e-3));
  CHECK(score.explained_apart(0, scale, 0) == doctest::Approx(squares).epsilon(1e-3));
}

}  // namespace
}  // namespace surefoot
