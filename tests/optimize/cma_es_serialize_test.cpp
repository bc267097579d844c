#include "surefoot/optimize/cma_es_serialize.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cstddef>
#include <limits>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es.hpp"
#include "tests/optimize/test_functions.hpp"

namespace surefoot {
namespace {

using Eigen::VectorXd;

CmaEsSearch example_search() {
  const Box<Eigen::Dynamic> box{VectorXd{{-5, -5, 1}}, VectorXd{{5, 5, 1}}};
  return cma_es(toy::rastrigin, VectorXd{{2, 3, 1}}, box, {.restarts = Restarts::bipop, .max_evaluations = 3000},
                Serial{}, 3)
      .search;
}

TEST_CASE("a search that was saved and loaded is the same to the last bit") {
  const CmaEsSearch search = example_search();
  REQUIRE(search.finished.size() > 1);
  const Bytes bytes = save(search);
  const CmaEsSearch loaded = load_cma_es_search(bytes, "test");
  CHECK(save(loaded) == bytes);
  CHECK(loaded.state.covariance == search.state.covariance);
  CHECK(loaded.finished.back().best == search.finished.back().best);
}

TEST_CASE("a damaged or cut file is refused or equal, and never more than that") {
  const Bytes bytes = save(example_search());
  Rng rng(1);
  for (std::size_t length = 0; length < bytes.size(); length += 1 + rng.below(20)) {
    CHECK_THROWS_AS(load_cma_es_search(std::span(bytes).first(length), "cut"), CoreError);
  }
  for (int i = 0; i < 1000; ++i) {
    Bytes mutated = bytes;
    mutated[rng.below(static_cast<std::uint32_t>(bytes.size()))] ^= static_cast<std::byte>(1U << rng.below(8));
    CHECK_THROWS_AS(load_cma_es_search(mutated, "flipped"), CoreError);
  }
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  CHECK_THROWS_AS(load_cma_es_search(longer, "longer"), CoreError);
}

TEST_CASE("a search whose sizes do not fit together is refused although its checksum is right") {
  const auto refused = [](auto change) {
    CmaEsSearch search = example_search();
    change(search);
    CHECK_THROWS_WITH_AS(load_cma_es_search(save(search), "odd"), "odd holds a search whose sizes do not fit together",
                         CoreError);
  };
  refused([](CmaEsSearch& s) { s.state.mean.conservativeResize(3); });
  refused([](CmaEsSearch& s) { s.state.covariance.conservativeResize(2, 3); });
  refused([](CmaEsSearch& s) { s.state.path = VectorXd(0); });
  refused([](CmaEsSearch& s) { s.state.population = 0; });
  refused([](CmaEsSearch& s) { s.state.sigma = std::numeric_limits<double>::quiet_NaN(); });
  refused([](CmaEsSearch& s) { s.box.reset(); });
  refused([](CmaEsSearch& s) { s.state.best_values.clear(); });
  refused([](CmaEsSearch& s) { s.finished[0].best = VectorXd::Ones(7); });
}

TEST_CASE("other files are told apart by name") {
  ByteWriter out;
  out.text("something else entirely");
  CHECK_THROWS_WITH_AS(load_cma_es_search(out.bytes(), "file a.bin"), doctest::Contains("file a.bin is not a search"),
                       CoreError);
}

}  // namespace
}  // namespace surefoot
