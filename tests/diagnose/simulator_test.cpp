// The concept of a simulator: what conforms, and the sentence for what does not.
#include "surefoot/diagnose/simulator.hpp"

#include <doctest/doctest.h>

#include <string>

#include "surefoot/core/vec.hpp"
#include "tests/diagnose/small_simulators.hpp"

namespace surefoot {
namespace {

struct NoState {};
struct NoInput {
  using State = Vec<1>;
};
struct NoOutput : NoInput {
  using Input = Vec<1>;
};
struct RowVectors : NoOutput {
  using State = Eigen::Matrix<double, 1, 2>;
  using Output = Vec<1>;
};
struct NoInfo : NoOutput {
  using Output = Vec<1>;
};
struct NoObserve : NoInfo {
  SimulatorInfo info() const { return {}; }
};
struct NoEquations : NoObserve {
  Output observe(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
struct Map : NoEquations {
  State next(const State& x, const Input& /*u*/, const Eigen::VectorXd& /*p*/) const { return x; }
};
struct NoCopy : Map {
  NoCopy(const NoCopy&) = delete;
};

template <class S>
bool says(const char* what) {
  return std::string(explain_simulator<S>()).find(what) != std::string::npos;
}

TEST_CASE("the first missing member of a simulator is named") {
  CHECK(says<NoCopy>("copied"));
  CHECK(says<NoState>("using State"));
  CHECK(says<NoInput>("using Input"));
  CHECK(says<NoOutput>("using Output"));
  CHECK(says<RowVectors>("column vectors"));
  CHECK(says<NoInfo>("info()"));
  CHECK(says<NoObserve>("observe("));
  CHECK(says<NoEquations>("derivative("));
}

TEST_CASE("nothing is said about a simulator, and only about no other type") {
  CHECK(explain_simulator<Map>().empty());
  CHECK(explain_simulator<toys::LeakyTank>().empty());
  static_assert(Simulator<Map> && Simulator<toys::SlidingBlock>);
  static_assert(!Simulator<NoEquations> && !Simulator<NoCopy> && !Simulator<int>);
  CHECK_FALSE(explain_simulator<int>().empty());
}

}  // namespace
}  // namespace surefoot
