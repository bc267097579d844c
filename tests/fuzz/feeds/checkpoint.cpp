// A run that was loaded is saved as it was, and RFPI goes on with it.
#include <algorithm>

#include "surefoot/solve/rfpi.hpp"
#include "tests/fixtures/answers.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/memory_file.hpp"
#include "tests/fuzz/mend_checksums.hpp"

namespace {

using namespace surefoot;
using fixtures::Slide;

constexpr std::size_t fingerprint_at = 12;

std::uint64_t fingerprint(const RfpiOptions& options) {
  return surefoot::detail::rfpi_fingerprint(Slide{}, options, fixtures::slide_seed, std::span<const Slide::State>{});
}

}  // namespace

void fuzz::checkpoint(Input input) {
  Bytes ours = as_bytes(input);  // of this run, whatever it was of
  if (ours.size() >= fingerprint_at + 8) {
    fuzz::detail::put(ours, fingerprint_at, fingerprint(fixtures::slide_options("any")));
  }
  for (const Bytes& bytes : {as_bytes(input), with_checksums(std::move(ours))}) {
    const MemoryFile file(bytes);
    const RfpiOptions options = fixtures::slide_options(file.path());
    const bool good = accepted<SolveError, CoreError, ForestError>(
        [&] { load_checkpoint<Slide>(file.path(), fingerprint(options)); });
    if (!good) continue;
    // CoreError: there can be no new checkpoint in a folder of open files.
    accepted<SolveError, CoreError, ForestError>([&] { rfpi(Slide{}, options, Serial{}, fixtures::slide_seed); });
  }
}
