#include "surefoot/solve/forest_policy.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/policy.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot/solve/export_policy.hpp"
#include "tests/solve/temporary_file.hpp"
#include "tests/support/allocation_count.hpp"
#include "tests/support/cart_pole.hpp"
#include "tests/support/double_integrator.hpp"
#include "tests/support/pendulum.hpp"

namespace surefoot {
namespace {

using toy::DoubleIntegrator;
using toy::Pendulum;

static_assert(Policy<ForestPolicy<Pendulum>, Pendulum> && MemorylessPolicy<ForestPolicy<Pendulum>, Pendulum>);

template <Problem P>
std::vector<typename P::State> random_states(const P& problem, int count, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<typename P::State> states;
  for (int i = 0; i < count; ++i) states.push_back(problem.state_box().sample(rng));
  return states;
}

// A policy that would often leave the action box: five times the sum of the features.
template <Problem P>
ForestPolicy<P> wild_policy(const P& problem, int samples = 500) {
  const auto states = random_states(problem, samples, 7);
  Dataset<feature_dim<P>(), P::action_dim> data;
  data.inputs.resize(feature_dim<P>(), samples);
  data.outputs.resize(P::action_dim, samples);
  for (int i = 0; i < samples; ++i) {
    const auto inputs = features(problem, states[static_cast<std::size_t>(i)]);
    data.inputs.col(i) = inputs.template cast<float>();
    data.outputs.col(i).setConstant(5 * inputs.sum());
  }
  return {problem, train_extra_trees<LinearLeaf>(data, {.trees = 3, .min_leaf = 40}, Serial{}, 1)};
}

TEST_CASE_TEMPLATE("many actions at once have the bits of one after the other", P, DoubleIntegrator, Pendulum,
                   toy::CartPole) {
  const auto policy = wild_policy(P{});
  for (const int count : {0, 1, 5, 1000}) {
    const auto states = random_states(P{}, count, 2);
    const auto actions = policy.act(states);
    REQUIRE(actions.size() == states.size());
    for (std::size_t i = 0; i < states.size(); ++i) CHECK(actions[i] == policy(states[i]));
  }
}

TEST_CASE("actions are the forest's, clamped to the action box") {
  const Pendulum problem;
  const auto policy = wild_policy(problem);
  int inside = 0;
  for (const auto& state : random_states(problem, 1000, 2)) {
    const double raw = policy.forest().predict(problem.features(state))[0];
    CHECK(policy(state)[0] == std::clamp(raw, -2.0, 2.0));
    if (std::abs(raw) < 2) ++inside;
  }
  CHECK(inside > 50);
  CHECK(inside < 950);
}

TEST_CASE("a policy in C keeps its action inside the action box") {
  const auto policy = wild_policy(Pendulum{});
  const ExportCOptions named{.function = "torque"};
  ExportCOptions bounded = named;
  bounded.low = {-2};
  bounded.high = {2};
  CHECK(export_c(policy, named) == export_c(policy.forest(), bounded));
  CHECK(export_c(policy, named) != export_c(policy.forest(), named));
}

TEST_CASE("a policy of several opinions acts alike one by one, in a batch, from a file and in C") {
  const Pendulum problem;
  const auto states = random_states(problem, 300, 3);
  const ForestPolicy<Pendulum> policy(problem, wild_policy(problem).forest(), 0.1);
  const ForestPolicy<Pendulum> mean(problem, policy.forest());
  const toy::TemporaryFile file("agreeing");
  save_policy(file.path.string(), policy);
  const auto loaded = load_policy(problem, file.path.string());
  CHECK(loaded.agreement() == 0.1);
  const auto batch = policy.act(states);
  int others = 0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    CHECK(policy(states[i]) == batch[i]);
    CHECK(loaded(states[i]) == batch[i]);
    others += mean(states[i]) != batch[i] ? 1 : 0;
  }
  CHECK(others > 0);
  ExportCOptions agreeing{.function = "torque"};
  agreeing.low = {-2};
  agreeing.high = {2};
  agreeing.agreement = {0.1 * 2};
  CHECK(export_c(policy, {.function = "torque"}) == export_c(policy.forest(), agreeing));
}

TEST_CASE("an action costs no allocation") {
  long before = allocations;
  const auto policy = wild_policy(Pendulum{});
  CHECK(allocations > before);  // the counter works
  const Vec<2> state(0.3, -2);
  before = allocations;
  const Vec<1> action = policy(state);
  CHECK(allocations == before);
  CHECK(Pendulum{}.action_box().contains(action));
}

TEST_CASE_TEMPLATE("a policy that was saved and loaded is the same to the last bit", P, DoubleIntegrator, Pendulum) {
  const toy::TemporaryFile file("policy");
  const auto policy = wild_policy(P{});
  save_policy(file.path, policy);
  const auto loaded = load_policy(P{}, file.path);
  CHECK(loaded.forest() == policy.forest());
  const auto states = random_states(P{}, 100, 3);
  CHECK(loaded.act(states) == policy.act(states));
  save_policy(file.path, loaded);  // over the old file
  CHECK(load_policy(P{}, file.path).forest() == policy.forest());
  CHECK(!std::filesystem::exists(file.path.string() + ".part"));
}

// As the pendulum, but for one thing each.
struct TwoMotors : Pendulum {
  static constexpr int action_dim = 2;
  using Action = Vec<2>;
  Box<2> action_box() const { return Box<2>::symmetric(Action(2, 2)); }
  Step<State> step(const State& state, const Action& action, Rng& rng) const {
    return Pendulum::step(state, action.head<1>(), rng);
  }
};
struct StrongMotor : Pendulum {
  Box<1> action_box() const { return Box<1>::symmetric(Action(3)); }
};
struct TwoFeatures : Pendulum {
  static constexpr int feature_dim = 2;
  Vec<2> features(const State& state) const { return state; }
};
struct OtherFeatures : Pendulum {
  Vec<3> features(const State& state) const { return {std::sin(state[0]), std::cos(state[0]), state[1]}; }
};

template <Problem P>
std::string complaint(const P& problem, const std::filesystem::path& path) {
  try {
    load_policy(problem, path);
  } catch (const SolveError& error) {
    return error.what();
  }
  return "nothing wrong";
}

TEST_CASE("a policy of another problem is refused in words that name the difference") {
  const toy::TemporaryFile file("policy");
  save_policy(file.path, wild_policy(Pendulum{}));
  const std::string source = "policy file " + file.path.string();
  CHECK(complaint(Pendulum{}, file.path) == "nothing wrong");
  CHECK(complaint(toy::CartPole{}, file.path) == source + " has 2 state dimensions, this problem has 4");
  CHECK(complaint(TwoMotors{}, file.path) == source + " has 1 action dimensions, this problem has 2");
  CHECK(complaint(TwoFeatures{}, file.path) == source + " has 3 features, this problem has 2");
  const auto says = [&](const auto& problem, const char* what) {
    return complaint(problem, file.path).find(what) != std::string::npos;
  };
  CHECK(says(StrongMotor{}, "another action box"));
  CHECK(says(OtherFeatures{}, "other features"));
}

TEST_CASE("other files are told apart by name") {
  const toy::TemporaryFile file("policy");
  CHECK_THROWS_WITH_AS(load_policy(Pendulum{}, file.path), doctest::Contains(file.path.string().c_str()), CoreError);
  write_file_atomically(file.path, std::string_view("something else entirely"));
  CHECK_THROWS_WITH_AS(load_policy(Pendulum{}, file.path), doctest::Contains("is not a policy file"), CoreError);
  const std::filesystem::path nowhere = file.path / "policy.bin";
  CHECK_THROWS_AS(save_policy(nowhere, wild_policy(Pendulum{})), CoreError);
}

std::optional<ForestPolicy<Pendulum>> load_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  write_file_atomically(path, bytes);
  try {
    return load_policy(Pendulum{}, path);
  } catch (const Error&) {
    return std::nullopt;
  }
}

void overwrite_checksum(Bytes& bytes, std::size_t start, std::size_t end) {
  ByteWriter sum;
  sum.u64(checksum(std::span(bytes).subspan(start, end - start)));
  std::ranges::copy(sum.bytes(), bytes.begin() + static_cast<std::ptrdiff_t>(end));
}

TEST_CASE("a damaged policy file is refused") {
  const toy::TemporaryFile file("policy");
  save_policy(file.path, wild_policy(Pendulum{}, 150));
  const Bytes bytes = read_file(file.path);
  Rng rng(1);
  int loaded = 0;
  for (int i = 0; i < 2000; ++i) {
    Bytes mutated = bytes;
    for (std::uint32_t change = rng.below(4) + 1; change > 0; --change) {
      mutated[rng.below(static_cast<std::uint32_t>(bytes.size()))] = static_cast<std::byte>(rng.below(256));
    }
    if (mutated != bytes && load_bytes(file.path, mutated)) ++loaded;
  }
  for (std::size_t length = 0; length < bytes.size(); length += 1 + rng.below(20)) {
    if (load_bytes(file.path, Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)))) ++loaded;
  }
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  if (load_bytes(file.path, longer)) ++loaded;
  CHECK(loaded == 0);
  CHECK(load_bytes(file.path, bytes));
}

TEST_CASE("a changed policy file with the right checksums is refused or acts inside the action box") {
  const toy::TemporaryFile file("policy");
  save_policy(file.path, wild_policy(Pendulum{}, 150));
  const Bytes bytes = read_file(file.path);
  const std::string_view magic = "SUREFRST";
  const auto forest = std::ranges::search(bytes, std::as_bytes(std::span(magic)));
  REQUIRE(!forest.empty());
  const auto start = static_cast<std::size_t>(forest.begin() - bytes.begin());
  const auto states = random_states(Pendulum{}, 5, 3);
  Rng rng(2);
  int loaded = 0;
  for (int i = 0; i < 1000; ++i) {
    Bytes mutated = bytes;
    mutated[rng.below(static_cast<std::uint32_t>(bytes.size()))] ^= static_cast<std::byte>(1U << rng.below(8));
    overwrite_checksum(mutated, start, bytes.size() - 16);
    overwrite_checksum(mutated, 0, bytes.size() - 8);
    const auto policy = load_bytes(file.path, mutated);
    if (!policy) continue;
    ++loaded;
    for (const Vec<2>& state : states) CHECK(Pendulum{}.action_box().contains((*policy)(state)));
  }
  CHECK(loaded > 100);  // thresholds and leaf numbers can be anything
  CHECK(loaded < 1000);
}

}  // namespace
}  // namespace surefoot
