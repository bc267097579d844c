// A search that was loaded is saved as it was, and CMA-ES goes on with it.
#include <algorithm>
#include <limits>

#include "surefoot/optimize/cma_es.hpp"
#include "surefoot/optimize/cma_es_serialize.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/mend_checksums.hpp"

namespace {

using namespace surefoot;

/// Three generations more, through a restart if one is due.
void go_on(const CmaEsSearch& search) {
  CmaEsOptions options{.restarts = Restarts::bipop};
  const auto few = 3 * static_cast<std::uint64_t>(search.state.population);
  options.max_evaluations = std::min(search.evaluations, std::numeric_limits<std::uint64_t>::max() - few) + few;
  const auto bowl = [](const Eigen::VectorXd& x) { return x.squaredNorm(); };
  cma_es(bowl, search, options, Serial{});
}

}  // namespace

void fuzz::search(Input input) {
  constexpr Eigen::Index too_many = 1000;  // candidates of a generation, or numbers of them, to go on with
  for (const Bytes& bytes : both_ways(input)) {
    CmaEsSearch search;
    if (!accepted<CoreError>([&] { search = load_cma_es_search(bytes, "bytes"); })) continue;
    const Bytes again = save(search);
    require(save(load_cma_es_search(again, "again")) == again, "a search that is saved as another one");
    const Eigen::Index population = std::max(search.state.population, search.schedule.large_population);
    if (population > too_many || population * search.state.dimension() > too_many) continue;
    accepted<OptimizeError>([&] { go_on(search); });
  }
}
