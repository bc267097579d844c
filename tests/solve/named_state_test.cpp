// States and actions with names of their own: nothing that the library does depends on it.
#include <doctest/doctest.h>

#include <vector>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/portable.hpp"
#include "surefoot/core/rollout.hpp"
#include "surefoot/core/validate.hpp"
#include "surefoot/solve/export_policy.hpp"
#include "surefoot/solve/policy_search.hpp"
#include "surefoot/solve/rfpi.hpp"
#include "tests/solve/temporary_file.hpp"
#include "tests/support/double_integrator.hpp"

namespace surefoot {
namespace {

struct Cart : Vec<2> {
  using Vec<2>::Vec;
  double position() const { return (*this)[0]; }  // [m]
  double speed() const { return (*this)[1]; }     // [m/s]
};

struct Push : Vec<1> {
  using Vec<1>::Vec;
  double acceleration() const { return (*this)[0]; }  // [m/s^2]
};

struct Named {
  static constexpr int state_dim = 2, action_dim = 1;
  using State = Cart;
  using Action = Push;
  toy::DoubleIntegrator plain = {.push = 0.02};

  Box<2> state_box() const { return plain.state_box(); }
  Box<1> action_box() const { return plain.action_box(); }
  Cart initial_state(Rng& rng) const { return plain.initial_state(rng); }
  Step<Cart> step(const Cart& cart, const Push& push, Rng& rng) const {
    const auto done = plain.step(cart, push, rng);
    return {done.next, done.reward, done.terminal};
  }
};
static_assert(Problem<Named> && Portable<Cart>);

const RfpiOptions brief{.budget = {.counted_seconds = 1e9}, .max_iterations = 5, .first_states = 300};

TEST_CASE("a problem with states of its own type gives the bits of the same with plain vectors") {
  const auto plain = rfpi(Named{}.plain, brief, Threads(1), 1);
  const std::vector<Cart> seeds{Cart(0.5, 0)};
  const auto named = rfpi(Named{}, brief, Threads(2), 1);
  CHECK(named.cost.mean == plain.cost.mean);
  CHECK(export_c(named.policy) == export_c(plain.policy));
  CHECK(rfpi(Named{}, brief, Threads(1), 1, seeds).cost.mean != plain.cost.mean);
}

TEST_CASE("checkpoints, policy files, comparisons, searches and checks take states of their own type") {
  const toy::TemporaryFile checkpoint("named_checkpoint"), file("named_policy");
  RfpiOptions options = brief;
  options.checkpoint = checkpoint.path.string();
  options.max_iterations = 3;
  rfpi(Named{}, options, Threads(1), 1);
  options.max_iterations = brief.max_iterations;
  options.resume = true;
  const auto resumed = rfpi(Named{}, options, Threads(1), 1);
  CHECK(resumed.cost.mean == rfpi(Named{}, brief, Threads(1), 1).cost.mean);

  save_policy(file.path, resumed.policy);
  const auto loaded = load_policy(Named{}, file.path);
  const std::vector<Cart> carts{Cart(0.3, -0.2), Cart(-1, 0.1)};
  CHECK(loaded.act(carts)[1].acceleration() == resumed.policy(carts[1]).acceleration());

  const auto spring = [](const Vec<2>& gains) {
    return [gains](const Cart& cart) { return Push(-gains[0] * cart.position() - gains[1] * cart.speed()); };
  };
  const auto still = [](const Cart&) { return Push(0.0); };
  CHECK(compare(Named{}, loaded, still, {.runs = 200}, Serial{}, 1).mean > 0);
  PolicySearchOptions search;
  search.total_runs = 20'000;
  search.final_runs = 500;
  const auto tuned =
      policy_search(Named{}, spring, Vec<2>(0.1, 0.1), Box<2>(Vec<2>(0, 0), Vec<2>(3, 3)), search, Serial{}, 1);
  CHECK(compare(Named{}, spring(tuned.parameters), still, {.runs = 200}, Serial{}, 1).mean > 0);
  CHECK(validate(Named{}).empty() == validate(Named{}.plain).empty());
}

}  // namespace
}  // namespace surefoot
