#include "surefoot/forest/export_c.hpp"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"

namespace surefoot {
namespace {

struct Folder {  // a scratch folder of this test, removed at its end
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("surefoot_export_c_test_" + std::to_string(::getpid()));
  Folder() { std::filesystem::create_directories(path); }
  ~Folder() { std::filesystem::remove_all(path); }
};

bool have_c_compiler() {
  static const bool found = std::system("cc --version > /dev/null 2>&1") == 0;
  if (!found) MESSAGE("skipped: there is no C compiler named cc");
  return found;
}

// Compiles the C code and calls its `name` for every input.
std::vector<double> run_c(const std::string& code, const std::string& name, const std::vector<double>& inputs,
                          std::size_t width_in, std::size_t width_out) {
  const Folder folder;
  const std::string in = std::to_string(width_in);
  const std::string out = std::to_string(width_out);
  write_file_atomically(folder.path / "forest.c", code);
  write_file_atomically(folder.path / "main.c",
                        "#include <stdio.h>\n"
                        "void " +
                            name +
                            "(const double *in, double *out);\n"
                            "int main(void) {\n"
                            "  double in[" +
                            in + "], out[" + out +
                            "];\n"
                            "  while (fread(in, sizeof in, 1, stdin) == 1) {\n"
                            "    " +
                            name +
                            "(in, out);\n"
                            "    fwrite(out, sizeof out, 1, stdout);\n"
                            "  }\n"
                            "  return 0;\n"
                            "}\n");
  write_file_atomically(folder.path / "in.bin", std::as_bytes(std::span(inputs)));
  const std::string at = "cd '" + folder.path.string() + "' && ";
  REQUIRE(std::system((at + "cc -O2 -std=c99 -Wall -Wextra -pedantic -Werror -c forest.c").c_str()) == 0);
  REQUIRE(std::system((at + "cc -O2 -std=c99 main.c forest.o -o run -lm && ./run < in.bin > out.bin").c_str()) == 0);
  const Bytes bytes = read_file(folder.path / "out.bin");
  std::vector<double> outputs(bytes.size() / sizeof(double));
  std::memcpy(outputs.data(), bytes.data(), outputs.size() * sizeof(double));
  return outputs;
}

template <class F>
void check_same(const F& forest, const ExportCOptions& options) {
  if (!have_c_compiler()) return;
  const auto in = static_cast<std::size_t>(forest.inputs());
  const auto out = static_cast<std::size_t>(forest.outputs());
  Rng rng(3);
  std::vector<double> inputs(500 * in);
  for (double& x : inputs) x = rng.uniform(-1.5, 1.5);
  inputs[0] = std::numeric_limits<double>::infinity();
  inputs[in] = -std::numeric_limits<double>::infinity();
  inputs[2 * in + 1] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> outputs = run_c(export_c(forest, options), options.function, inputs, in, out);
  REQUIRE(outputs.size() == 500 * out);
  int differences = 0;
  for (std::size_t i = 0; i < 500; ++i) {
    const auto expected = forest.predict(Eigen::Map<const Eigen::VectorXd>(&inputs[i * in], forest.inputs()));
    for (std::size_t o = 0; o < out; ++o) {
      const double e = expected[static_cast<Eigen::Index>(o)];
      if (outputs[i * out + o] != e && !(std::isnan(e) && std::isnan(outputs[i * out + o]))) ++differences;
    }
  }
  CHECK(differences == 0);
}

TEST_CASE("the C file of a forest gives the library's bits") {
  for (const CTable table : {CTable::integers, CTable::text}) {
    const ExportCOptions options{.function = "forest_7", .table = table};
    check_same(train_extra_trees(toy::sample(toy::Cliff{}, 1000, 1), {.min_leaf = 2}, Serial{}, 1), options);
    check_same(train_extra_trees<LinearLeaf>(toy::sample(toy::Cliff{}, 1000, 1), {.trees = 7}, Serial{}, 1), options);
    check_same(train_extra_trees(toy::sample(toy::ClippedLaws{}, 600, 1), {.trees = 3}, Serial{}, 1), options);
    check_same(train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 600, 1), {.trees = 1}, Serial{}, 1),
               options);
  }
}

TEST_CASE("a forest of single leaves has a C file too") {
  Dataset<2, 1> samples{Eigen::Matrix<float, 2, 3>::Ones(), Eigen::RowVector3d(1, 2, 6), {}};
  for (const CTable table : {CTable::integers, CTable::text}) {
    check_same(train_extra_trees(samples, {.trees = 2}, Serial{}, 1), {.table = table});
  }
}

TEST_CASE("a wrapper can prepare the inputs and finish the outputs") {
  if (!have_c_compiler()) return;
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 500, 1), {}, Serial{}, 1);
  const ExportCOptions options{.function = "inner",
                               .wrapper =
                                   "#include <math.h>\n"
                                   "void outer(const double in[1], double out[2]);\n"
                                   "void outer(const double in[1], double out[2]) {\n"
                                   "  const double x[5] = {sqrt(in[0]), in[0], -in[0], 0.5, 0};\n"
                                   "  inner(x, out);\n"
                                   "  out[1] = out[0] > 1 ? 1 : out[0];\n"
                                   "}"};
  const std::vector<double> out = run_c(export_c(forest, options), "outer", {0.25}, 1, 2);
  Vec<5> x;
  x << 0.5, 0.25, -0.25, 0.5, 0;
  REQUIRE(out.size() == 2);
  CHECK(out[0] == forest.predict(x)[0]);
  CHECK(out[1] == std::min(1.0, forest.predict(x)[0]));
}

TEST_CASE("the C file is compact, as text even more") {
  const auto forest =
      train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 4000, 1), {.min_leaf = 10}, Serial{}, 1);
  const auto numbers = static_cast<double>(forest.leaves() * 15);  // 14 of a leaf and a threshold
  CHECK(static_cast<double>(export_c(forest).size()) < 10.5 * numbers);
  CHECK(static_cast<double>(export_c(forest, {.table = CTable::text}).size()) < 6 * numbers);
}

TEST_CASE("what cannot be exported is named") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 50, 1), {}, Serial{}, 1);
  for (const char* name : {"", "7up", "two words", "dash-ed"}) {
    CHECK_THROWS_WITH_AS(export_c(forest, {.function = name}), doctest::Contains("function"), ForestError);
  }
  CHECK_THROWS_WITH_AS(export_c(Forest<2, 1>()), doctest::Contains("empty"), ForestError);
}

}  // namespace
}  // namespace surefoot
