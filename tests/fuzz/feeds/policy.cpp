// A policy that was loaded acts within its box, or says NaN where its file holds no tree.
#include "surefoot/solve/forest_policy.hpp"
#include "tests/fixtures/answers.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/mend_checksums.hpp"

void fuzz::policy(Input input) {
  using namespace surefoot;
  for (const Bytes& bytes : both_ways(input)) {
    const MemoryFile file(bytes);
    accepted<SolveError, CoreError, ForestError>([&] {
      const auto policy = load_policy(fixtures::Slide{}, file.path());
      for (const double action : fixtures::ask(policy)) {
        require(std::abs(action) <= 1 || policy.forest().empty(), "an action out of the box");
      }
    });
  }
}
