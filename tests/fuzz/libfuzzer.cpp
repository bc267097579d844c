// Every feed as a target of libFuzzer: surefoot_fuzz READER [options of libFuzzer] [folders or files].
// Built only where SUREFOOT_FUZZ is on; tests/fuzz.sh builds and runs it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/fuzz/feeds.hpp"

namespace {

void (*chosen)(fuzz::Input) = nullptr;

}  // namespace

// Both names are libFuzzer's. NOLINTBEGIN(readability-identifier-naming)

// Takes the name of the reader out of the arguments.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  if (*argc > 1) {
    const auto feed = std::ranges::find(fuzz::feeds, std::string_view((*argv)[1]), &fuzz::Feed::name);
    if (feed != fuzz::feeds.end()) chosen = feed->run;
  }
  if (chosen == nullptr) {
    std::fprintf(stderr, "usage: surefoot_fuzz READER [options of libFuzzer] [folders or files]; the readers are:");
    for (const fuzz::Feed& feed : fuzz::feeds) std::fprintf(stderr, " %s", feed.name.data());
    std::fprintf(stderr, "\n");
    std::exit(2);
  }
  std::rotate(*argv + 1, *argv + 2, *argv + *argc);
  (*argv)[--*argc] = nullptr;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen({data, size});
  return 0;
}

// NOLINTEND(readability-identifier-naming)
