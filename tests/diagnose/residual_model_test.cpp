// The file of a residual model: comes back as it was, and is refused if anything in it has changed.
#include "surefoot/diagnose/residual_model.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"

namespace surefoot {
namespace {

ResidualModel some_model() {
  Dataset<Eigen::Dynamic, Eigen::Dynamic> samples;
  samples.inputs = Eigen::MatrixXf::Random(3, 200);
  samples.outputs = samples.inputs.topRows(1).cast<double>().array().square().matrix();
  return {{"theta", "omega", "abs(omega)"},
          {"theta_rad"},
          Eigen::VectorXd::Constant(1, 0.02),
          train_extra_trees(samples, {.trees = 5}, Serial{}, 1)};
}

struct File {
  std::filesystem::path path = std::filesystem::temp_directory_path() / "surefoot_residual_model_test.forest";
  ~File() { std::filesystem::remove(path); }
};

TEST_CASE("a residual model comes back from its file as it was") {
  const File file;
  const ResidualModel model = some_model();
  save_residual_model(model, file.path);
  const ResidualModel same = load_residual_model(file.path);
  CHECK(same.features == model.features);
  CHECK(same.outputs == model.outputs);
  CHECK(same.scale == model.scale);
  CHECK(same.forest == model.forest);
}

TEST_CASE("a residual model whose forest has other inputs than it names is refused") {
  const File file;
  ResidualModel model = some_model();
  model.features.pop_back();
  save_residual_model(model, file.path);
  CHECK_THROWS_WITH_AS(load_residual_model(file.path), doctest::Contains("a forest that does not go with its names"),
                       Error);
}

TEST_CASE("a residual model with any byte changed or cut off is refused") {
  const File file;
  save_residual_model(some_model(), file.path);
  const Bytes good = read_file(file.path);
  for (std::size_t i = 0; i < good.size(); i += i < 100 ? 1 : 37) {
    Bytes bad = good;
    bad[i] ^= std::byte{0x41};
    write_file_atomically(file.path, bad);
    CHECK_THROWS_AS(load_residual_model(file.path), Error);
    bad = good;
    bad.resize(i);
    write_file_atomically(file.path, bad);
    CHECK_THROWS_AS(load_residual_model(file.path), Error);
  }
}

}  // namespace
}  // namespace surefoot
