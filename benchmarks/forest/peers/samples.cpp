#include "samples.hpp"

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "benchmarks/forest/data.hpp"
#include "surefoot/core/rng.hpp"

namespace peers {
namespace {

// The policy-like outputs, as many as wanted by repetition. They are clipped and so constant in large regions, which
// dlib would split sample by sample: a little noise on each keeps it from that.
std::vector<double> policy(std::size_t outputs, std::size_t count, std::uint64_t seed) {
  const auto data = surefoot::bench::make_samples<3>(static_cast<Eigen::Index>(count), seed);
  surefoot::Rng rng(seed, 1);
  std::vector<double> y;
  for (Eigen::Index i = 0; i < data.outputs.cols(); ++i) {
    for (std::size_t o = 0; o < outputs; ++o) {
      y.push_back(data.outputs(static_cast<Eigen::Index>(o % 3), i) + rng.uniform(-0.001, 0.001));
    }
  }
  return y;
}

}  // namespace

Samples make_samples(std::size_t outputs, std::size_t count, std::uint64_t seed) {
  const auto data = surefoot::bench::make_samples<1>(static_cast<Eigen::Index>(count), seed);
  const auto& y = data.outputs;
  return {outputs,
          {data.inputs.data(), data.inputs.data() + data.inputs.size()},
          outputs == 1 ? std::vector<double>(y.data(), y.data() + y.size()) : policy(outputs, count, seed)};
}

double explained(Model& model, const Samples& test) {
  const auto rows = static_cast<Eigen::Index>(test.outputs);
  const auto count = static_cast<Eigen::Index>(test.count());
  Eigen::MatrixXd predicted(rows, count);
  model.keep(test.x);
  model.predict_all(predicted.data());
  const Eigen::Map<const Eigen::MatrixXd> truth(test.y.data(), rows, count);
  const Eigen::VectorXd mean = truth.rowwise().mean();
  return 1 - (predicted - truth).squaredNorm() / (truth.colwise() - mean).squaredNorm();
}

}  // namespace peers
