#include "surefoot/forest/export_c.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/c/c_fixed_point.hpp"
#include "surefoot/forest/c/c_tables.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/forest/short_floats.hpp"
#include "surefoot/solve/agreement.hpp"
#include "tests/forest/samples.hpp"
#include "tests/support/scratch_folder.hpp"

namespace surefoot {
namespace {

bool have_c_compiler() {
  static const bool found = std::system("cc --version > /dev/null 2>&1") == 0;
  if (!found) MESSAGE("skipped: there is no C compiler named cc");
  return found;
}

// Compiles the C code and calls its `name` for every input; if that takes whole numbers (of type `whole`), through its
// own conversion.
std::vector<double> run_c(const std::string& code, const std::string& name, const std::vector<double>& inputs,
                          std::size_t width_in, std::size_t width_out, const std::string& whole = "",
                          const std::string& flags = "", const std::string& whole_out = "") {
  const toy::ScratchFolder folder("export_c_test");
  const std::string in = std::to_string(width_in);
  const std::string out = std::to_string(width_out);
  write_file_atomically(folder.path / "forest.c", code);
  const std::string type = whole.empty() ? "double" : whole;
  const std::string result = whole_out.empty() ? "double" : whole_out;
  std::string main =
      "#include <stdint.h>\n#include <stdio.h>\nvoid " + name + "(const " + type + " *, " + result + " *);\n";
  if (!whole_out.empty()) main += "double " + name + "_output(int, " + whole_out + ");\n";
  if (!whole.empty()) main += whole + " " + name + "_input(int, double);\n";
  main += "int main(void) {\n  double in[" + in + "], out[" + out + "];\n  " + result + " y[" + out + "];\n  " + type +
          " x[" + in + "];\n  while (fread(in, sizeof in, 1, stdin) == 1) {\n    for (int k = 0; k < " + in +
          "; ++k) x[k] = " + (whole.empty() ? "in[k]" : name + "_input(k, in[k])") + ";\n    " + name +
          "(x, y);\n    for (int o = 0; o < " + out +
          "; ++o) out[o] = " + (whole_out.empty() ? "y[o]" : name + "_output(o, y[o])") +
          ";\n    fwrite(out, sizeof out, 1, stdout);\n  }\n  return 0;\n}\n";
  write_file_atomically(folder.path / "main.c", main);
  write_file_atomically(folder.path / "in.bin", std::as_bytes(std::span(inputs)));
  const std::string at = "cd '" + folder.path.string() + "' && ";
  REQUIRE(std::system((at + "cc -O2 -std=c99 -Wall -Wextra -pedantic -Werror -c forest.c " + flags).c_str()) == 0);
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

TEST_CASE("a forest of short floats takes less text in C and gives the bits of the library") {
  const auto check_short = [](const auto& forest, const ExportCOptions& options) {
    const auto short_forest = with_short_floats(forest);
    check_same(short_forest, options);
    CHECK(export_c(short_forest, options).size() < export_c(forest, options).size());
  };
  for (const CDescent descent : {CDescent::tables, CDescent::branches}) {
    const ExportCOptions options{.table = CTable::text, .descent = descent};
    check_short(train_extra_trees(toy::sample(toy::ClippedLaws{}, 3000, 1), {.trees = 40}, Serial{}, 1), options);
    check_short(train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 3000, 1), {.trees = 40}, Serial{}, 1),
                options);
  }
}

TEST_CASE("trees of several opinions give the bits of the agreed action in C") {
  if (!have_c_compiler()) return;
  const auto forest = train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 600, 1), {.trees = 5}, Serial{}, 1);
  const auto in = static_cast<std::size_t>(forest.inputs());
  constexpr int outputs = toy::ClippedLaws::outputs;
  Vec<outputs> reach;
  for (int o = 0; o < outputs; ++o) reach[o] = 0.05 * (o + 1);
  ExportCOptions options{.function = "agreed"};
  options.agreement.assign(reach.begin(), reach.end());
  Rng rng(3);
  std::vector<double> inputs(500 * in);
  for (double& x : inputs) x = rng.uniform(-1.5, 1.5);
  // A controller's compiler may fuse products and sums.
  const std::vector<double> found =
      run_c(export_c(forest, options), "agreed", inputs, in, outputs, "", "-march=native -ffp-contract=fast");
  REQUIRE(found.size() == 500 * outputs);
  int apart = 0, differences = 0;
  std::vector<float> row(in);
  std::vector<double> proposals(forest.trees() * outputs);
  for (std::size_t i = 0; i < 500; ++i) {
    for (std::size_t k = 0; k < in; ++k) row[k] = static_cast<float>(inputs[i * in + k]);
    forest.predict_trees(row.data(), 1, proposals.data());
    const Vec<outputs> expected = agreed_action<outputs>(proposals, reach);
    const auto mean = forest.predict(Eigen::Map<const Eigen::VectorXd>(&inputs[i * in], forest.inputs()));
    apart += mean != expected ? 1 : 0;
    for (int o = 0; o < outputs; ++o) {
      differences += found[i * outputs + static_cast<std::size_t>(o)] != expected[o] ? 1 : 0;
    }
  }
  CHECK(apart > 50);
  CHECK(differences == 0);
}

TEST_CASE("nested ifs give the library's bits as well") {
  for (const CTable table : {CTable::integers, CTable::text}) {
    const ExportCOptions options{.table = table, .descent = CDescent::branches};
    check_same(train_extra_trees(toy::sample(toy::Cliff{}, 1000, 1), {.min_leaf = 2}, Serial{}, 1), options);
    check_same(train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 600, 1), {.trees = 3}, Serial{}, 1),
               options);
  }
}

TEST_CASE("a forest of single leaves has a C file too") {
  Dataset<2, 1> samples{Eigen::Matrix<float, 2, 3>::Ones(), Eigen::RowVector3d(1, 2, 6), {}};
  const auto forest = train_extra_trees(samples, {.trees = 2}, Serial{}, 1);
  for (const CTable table : {CTable::integers, CTable::text}) check_same(forest, {.table = table});
  check_same(forest, {.descent = CDescent::branches});
  if (!have_c_compiler()) return;
  for (const CDescent descent : {CDescent::tables, CDescent::branches}) {
    const ExportCOptions options{.descent = descent, .thresholds = CThreshold::int16};
    CHECK(run_c(export_c(forest, options), options.function, {0.5, 7}, 2, 1, "int16_t") == std::vector<double>{3.0});
  }
}

// Inputs farther than 1 / scale from every threshold must reach the same leaves; linear leaves see the rounded input.
template <class F>
void check_fixed(const F& forest, const ExportCOptions& options) {
  if (!have_c_compiler()) return;
  const detail::CTables tables(forest.raw());
  const std::vector<double> scales =
      detail::c_scales(tables, forest.inputs(), options.thresholds, options.largest_inputs);
  const auto in = static_cast<std::size_t>(forest.inputs());
  const auto out = static_cast<std::size_t>(forest.outputs());
  Rng rng(5);
  std::vector<double> inputs;
  std::vector<double> rounded;
  while (inputs.size() < 400 * in) {
    std::vector<double> x(in);
    for (double& value : x) value = static_cast<double>(static_cast<float>(rng.uniform(-0.99, 0.99)));
    bool far = true;
    for (std::size_t i = 0; i < tables.thresholds.size(); ++i) {
      const auto k = static_cast<std::size_t>(tables.inputs[i]);
      far = far && std::abs(x[k] - static_cast<double>(tables.thresholds[i])) > 1 / scales[k];
    }
    if (!far) continue;
    inputs.insert(inputs.end(), x.begin(), x.end());
    for (std::size_t k = 0; k < in; ++k) rounded.push_back(std::round(x[k] * scales[k]) / scales[k]);
  }
  const std::string whole = options.thresholds == CThreshold::int16 ? "int16_t" : "int32_t";
  const std::vector<double> outputs = run_c(export_c(forest, options), options.function, inputs, in, out, whole);
  REQUIRE(outputs.size() == 400 * out);
  int differences = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    const auto expected = forest.predict(Eigen::Map<const Eigen::VectorXd>(&rounded[i * in], forest.inputs()));
    const auto leaf = forest.predict(Eigen::Map<const Eigen::VectorXd>(&inputs[i * in], forest.inputs()));
    for (std::size_t o = 0; o < out; ++o) {
      const auto at = static_cast<Eigen::Index>(o);
      if (outputs[i * out + o] != expected[at]) ++differences;
      if (std::abs(outputs[i * out + o] - leaf[at]) > 1e-3) ++differences;
    }
  }
  CHECK(differences == 0);
}

TEST_CASE("whole-number inputs reach the same leaves beyond the stated rounding") {
  const auto constant = train_extra_trees(toy::sample(toy::Cliff{}, 400, 1), {.trees = 4, .min_leaf = 4}, Serial{}, 1);
  const auto linear =
      train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 600, 1), {.trees = 3, .min_leaf = 20}, Serial{}, 1);
  for (const CThreshold thresholds : {CThreshold::int16, CThreshold::int32}) {
    for (const CDescent descent : {CDescent::tables, CDescent::branches}) {
      const ExportCOptions options{.descent = descent, .thresholds = thresholds};
      check_fixed(constant, options);
      ExportCOptions wide = options;
      wide.largest_inputs.assign(4, 1.0);
      check_fixed(linear, wide);
    }
  }
}

// The mean of whole outputs is at most so many units off: each tree rounds once, linear leaves every product, too.
template <class F>
void check_whole(const F& forest, const ExportCOptions& options, double tolerance) {
  if (!have_c_compiler()) return;
  const auto in = static_cast<std::size_t>(forest.inputs()), out = static_cast<std::size_t>(forest.outputs());
  ExportCOptions floats = options;
  floats.whole_outputs = false;
  const std::string whole = options.thresholds == CThreshold::int16 ? "int16_t" : "int32_t";
  Rng rng(6);
  std::vector<double> inputs(300 * in);
  for (double& x : inputs) x = rng.uniform(-0.99, 0.99);
  const std::string code = export_c(forest, options);
  const std::string body = code.substr(code.rfind("void " + options.function + "("));
  CHECK(body.find("double") == std::string::npos);
  CHECK(body.find("float") == std::string::npos);
  const auto expected = run_c(export_c(forest, floats), options.function, inputs, in, out, whole);
  const auto found = run_c(code, options.function, inputs, in, out, whole, "", "int32_t");
  REQUIRE(found.size() == expected.size());
  double farthest = 0, largest = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    farthest = std::max(farthest, std::abs(found[i] - expected[i]));
    largest = std::max(largest, std::abs(expected[i]));
  }
  CHECK(farthest < tolerance * largest);
}

TEST_CASE("whole outputs are those of the floats, without a floating-point number in the function") {
  const auto constant = train_extra_trees(toy::sample(toy::Cliff{}, 400, 1), {.trees = 4, .min_leaf = 4}, Serial{}, 1);
  const auto linear =
      train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 600, 1), {.trees = 6, .min_leaf = 20}, Serial{}, 1);
  for (const CThreshold thresholds : {CThreshold::int16, CThreshold::int32}) {
    for (const CTable table : {CTable::integers, CTable::text}) {
      ExportCOptions options{.table = table, .thresholds = thresholds, .whole_outputs = true};
      check_whole(constant, options, 1e-6);
      options.largest_inputs.assign(4, 1.0);
      check_whole(linear, options, 1e-5);
      options.agreement.assign(2, 0.3);
      options.low.assign(2, -0.5);
      options.high.assign(2, 0.4);
      check_whole(linear, options, 1e-5);
    }
  }
}

TEST_CASE("whole outputs ask for leaves they can hold") {
  const auto samples = toy::sample(toy::ClippedLaws{}, 300, 1);
  const auto complaint = [&](const ExtraTreesOptions& training, ExportCOptions options) -> std::string {
    options.whole_outputs = true;
    try {
      export_c(train_extra_trees<LinearLeaf>(samples, training, Serial{}, 1), options);
    } catch (const ForestError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(complaint({.trees = 2}, {}).find("int16 or int32") != std::string::npos);
  CHECK(complaint({.trees = 2}, {.descent = CDescent::branches, .thresholds = CThreshold::int16}).find("tables") !=
        std::string::npos);
  CHECK(complaint({.trees = 2, .clamp = false}, {.thresholds = CThreshold::int16}).find("clamp") != std::string::npos);
}

TEST_CASE("inputs beyond the range of whole numbers end up at its ends, NaN at the lower") {
  if (!have_c_compiler()) return;
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 400, 1), {.trees = 4}, Serial{}, 1);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double far : {1e3, -1e3, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()}) {
    for (const bool large : {false, true}) {
      const ExportCOptions options{.thresholds = large ? CThreshold::int32 : CThreshold::int16};
      const std::vector<double> out = run_c(export_c(forest, options), options.function, std::vector<double>(5, far), 5,
                                            1, large ? "int32_t" : "int16_t");
      REQUIRE(out.size() == 1);
      CHECK(out[0] == forest.predict(Vec<5>::Constant(far))[0]);
    }
  }
}

TEST_CASE("the scale of whole numbers is the largest power of two with room for thresholds and inputs") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 400, 1), {}, Serial{}, 1);
  const detail::CTables tables(forest.raw());
  const std::vector<double> none;
  const std::vector<double> large(5, 1000.0);
  for (const double scale : detail::c_scales(tables, 5, CThreshold::int16, none)) CHECK(scale == 32768);
  for (const double scale : detail::c_scales(tables, 5, CThreshold::int16, large)) CHECK(scale == 32);
  for (const double scale : detail::c_scales(tables, 5, CThreshold::int32, none)) CHECK(scale == 2147483648.0);
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

TEST_CASE("outputs are kept in bounds") {
  if (!have_c_compiler()) return;
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 500, 1), {}, Serial{}, 1);
  Vec<5> x;
  x << 0.5, 0.25, -0.25, 0.5, 0;
  const double value = forest.predict(x)[0];
  const std::vector<double> in(x.begin(), x.end());
  const auto bounded = [&](double low, double high, ExportCOptions options) {
    options.low = {low};
    options.high = {high};
    return run_c(export_c(forest, options), "surefoot_forest", in, 5, 1)[0];
  };
  for (const CDescent descent : {CDescent::tables, CDescent::branches}) {
    CHECK(bounded(value - 1, value + 1, {.descent = descent}) == value);
    CHECK(bounded(value + 0.1, value + 1, {.descent = descent}) == value + 0.1);
    CHECK(bounded(value - 1, value - 0.1, {.descent = descent}) == value - 0.1);
  }
  for (const auto& [low, high] : std::vector<std::pair<std::vector<double>, std::vector<double>>>{
           {{0}, {}}, {{}, {0}}, {{0, 0}, {1, 1}}, {{1}, {0}}, {{0}, {INFINITY}}, {{NAN}, {0}}}) {
    CHECK_THROWS_WITH_AS(export_c(forest, {.low = low, .high = high}), doctest::Contains("low and high"), ForestError);
  }
}

TEST_CASE("the C file is compact, as text even more") {
  const auto forest =
      train_extra_trees<LinearLeaf>(toy::sample(toy::ClippedLaws{}, 4000, 1), {.min_leaf = 10}, Serial{}, 1);
  const auto numbers = static_cast<double>(forest.leaves() * 15);  // 14 of a leaf and a threshold
  CHECK(static_cast<double>(export_c(forest).size()) < 11 * numbers);
  CHECK(static_cast<double>(export_c(forest, {.table = CTable::text}).size()) < 6 * numbers);
}

TEST_CASE("what cannot be exported is named") {
  const auto forest = train_extra_trees(toy::sample(toy::Cliff{}, 50, 1), {}, Serial{}, 1);
  for (const char* name : {"", "7up", "two words", "dash-ed"}) {
    CHECK_THROWS_WITH_AS(export_c(forest, {.function = name}), doctest::Contains("function"), ForestError);
  }
  CHECK_THROWS_WITH_AS(export_c(Forest<2, 1>()), doctest::Contains("empty"), ForestError);
  const ExportCOptions few{.thresholds = CThreshold::int16, .largest_inputs = {1, 2}};
  CHECK_THROWS_WITH_AS(export_c(forest, few), doctest::Contains("largest_inputs"), ForestError);
  const ExportCOptions zero{.thresholds = CThreshold::int16, .largest_inputs = {1, 2, 0, 1, 1}};
  CHECK_THROWS_WITH_AS(export_c(forest, zero), doctest::Contains("positive"), ForestError);
}

TEST_CASE("a tree too deep for nested ifs is refused, tables take it") {
  constexpr Eigen::Index count = 254;  // each sample twice as far out as the one before: a level takes off few
  Dataset<1, 1> samples;
  samples.inputs.resize(1, count);
  samples.outputs.resize(1, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    samples.inputs(0, i) = std::ldexp(1.0F, static_cast<int>(i) - 126);
    samples.outputs(0, i) = static_cast<double>(i);
  }
  const auto forest = train_extra_trees(samples, {.trees = 1, .min_leaf = 1}, Serial{}, 1);
  CHECK_THROWS_WITH_AS(export_c(forest, {.descent = CDescent::branches}), doctest::Contains("too deep"), ForestError);
  check_same(forest, {});
}

}  // namespace
}  // namespace surefoot
