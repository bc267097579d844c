// A forest that was loaded can be asked anything, is the same in place and from a stream, and is saved as it was.
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <vector>

#include "surefoot/forest/serialize.hpp"
#include "tests/fixtures/answers.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/mend_checksums.hpp"

namespace {

using surefoot::ForestError;

using AnyInputs = surefoot::Forest<Eigen::Dynamic, Eigen::Dynamic, surefoot::LinearLeaf>;

/// Inputs of every size and kind, not finite ones too.
template <class F>
std::vector<double> answers(const F& forest) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto width = static_cast<std::size_t>(forest.inputs());
  std::vector<float> inputs;
  for (const float x : {0.F, -0.4F, 1e-40F, 3e38F, infinity, -infinity, std::nanf("")})
    inputs.insert(inputs.end(), width, x);
  std::vector<double> outputs(7 * static_cast<std::size_t>(forest.outputs()));
  if (!forest.empty()) forest.predict(inputs.data(), 7, outputs.data());
  return outputs;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

template <class F>
void load_as(const surefoot::Bytes& bytes) {
  F forest;
  const bool good = fuzz::accepted<ForestError>([&] { forest = surefoot::load<F>(bytes, "bytes"); });

  std::istringstream stream(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  F streamed;
  const bool from_stream = fuzz::accepted<ForestError>([&] { streamed = surefoot::load<F>(stream, "stream"); });
  fuzz::require(from_stream || !good, "a forest that a stream refuses");

  std::vector<double> in_place;
  constexpr int too_many = 1000;  // outputs, to ask for them
  const bool viewed = fuzz::accepted<ForestError>([&] {
    const auto view = surefoot::view<F>(bytes, "bytes");
    if (view.outputs() < too_many) in_place = answers(view);
  });
  fuzz::require(viewed == good, "a forest that is good in one place only");
  if (!good) return;
  fuzz::require(forest == streamed, "a forest that is another one in a stream");
  if (forest.outputs() < too_many)
    fuzz::require(same_bits(answers(forest), in_place), "answers that depend on the place");
  surefoot::ByteWriter again;
  write(again, forest);
  fuzz::require(again.bytes() == bytes, "a forest that is saved as another one");
}

}  // namespace

void fuzz::forest(Input input) {
  for (const surefoot::Bytes& bytes : both_ways(input)) {
    load_as<fixtures::ConstantForest>(bytes);
    load_as<fixtures::LinearForest>(bytes);
    load_as<fixtures::OwnForest>(bytes);
    load_as<AnyInputs>(bytes);
  }
}
