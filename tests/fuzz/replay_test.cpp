// The feeds without libFuzzer: their seeds, those cut and damaged, and what fuzzing found in the past.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/optimize/cma_es_serialize.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"

namespace {

using Text = std::vector<std::uint8_t>;

struct Seed {
  std::filesystem::path path;
  Text bytes;
};

Seed read_seed(const std::filesystem::path& path) {
  const surefoot::Bytes bytes = surefoot::read_file(path);
  Seed seed{path, Text(bytes.size())};
  std::ranges::transform(bytes, seed.bytes.begin(), [](std::byte b) { return static_cast<std::uint8_t>(b); });
  return seed;
}

std::vector<Seed> seeds_of(const fuzz::Feed& feed) {
  namespace fs = std::filesystem;
  const fs::path tests = SUREFOOT_SOURCE_DIR "/tests";
  std::vector<Seed> seeds;
  const fs::path own = tests / "fuzz" / "seeds" / feed.name;
  if (fs::is_directory(own)) {
    for (const auto& file : fs::directory_iterator(own)) seeds.push_back(read_seed(file.path()));
  }
  if (!feed.fixture.empty()) {
    for (const auto& file : fs::recursive_directory_iterator(tests / "fixtures")) {
      if (file.path().string().ends_with(feed.fixture)) seeds.push_back(read_seed(file.path()));
    }
  }
  std::ranges::sort(seeds, {}, &Seed::path);
  return seeds;
}

/// One to three bytes changed, taken away or put in.
Text damaged(Text bytes, surefoot::Rng& rng) {
  for (std::uint32_t left = 1 + rng.below(3); left > 0 && !bytes.empty(); --left) {
    const auto at = bytes.begin() + rng.below(static_cast<std::uint32_t>(bytes.size()));
    switch (rng.below(4)) {
      case 0:
        *at ^= static_cast<std::uint8_t>(1U << rng.below(8));
        break;
      case 1:
        *at = static_cast<std::uint8_t>(rng.below(256));
        break;
      case 2:
        bytes.erase(at);
        break;
      default:
        bytes.insert(at, static_cast<std::uint8_t>(rng.below(256)));
    }
  }
  return bytes;
}

}  // namespace

TEST_CASE("every reader takes its seeds, cut anywhere and damaged, or refuses them in one sentence") {
  for (const fuzz::Feed& feed : fuzz::feeds) {
    CAPTURE(feed.name);
    const std::vector<Seed> seeds = seeds_of(feed);
    CHECK_FALSE(seeds.empty());
    surefoot::Rng rng(1);
    for (const Seed& seed : seeds) {
      CAPTURE(seed.path.string());
      CHECK_NOTHROW(feed.run(seed.bytes));
      for (int i = 0; i < 40; ++i) {
        const std::size_t length = rng.below(static_cast<std::uint32_t>(seed.bytes.size() + 1));
        CAPTURE(length);
        CHECK_NOTHROW(feed.run(fuzz::Input(seed.bytes).first(length)));
      }
      for (int i = 0; i < 100; ++i) {
        const Text bytes = damaged(seed.bytes, rng);
        CAPTURE(i);
        CHECK_NOTHROW(feed.run(bytes));
      }
    }
  }
}

// What fuzzing or reading the code found, made again by few words.

namespace {

fuzz::Input input_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string fixture(const std::string& name) {
  const surefoot::Bytes bytes = surefoot::read_file(SUREFOOT_SOURCE_DIR "/tests/fixtures/0.1.0/" + name);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

TEST_CASE("a checkpoint of more iterations than an int can count is refused") {
  std::string file = fixture("slide.rfpi");
  constexpr std::size_t iteration_at = 20;
  for (std::size_t i = 0; i < 4; ++i) file[iteration_at + i] = i == 3 ? '\x80' : '\0';
  CHECK_NOTHROW(fuzz::checkpoint(input_of(file)));  // makes the checksum right
}

TEST_CASE("a search whose restarts could not be held in memory is refused") {
  const surefoot::CmaEsSearch good = surefoot::load_cma_es_search(
      surefoot::read_file(SUREFOOT_SOURCE_DIR "/tests/fixtures/0.1.0/bowl.cma"), "bowl.cma");
  const auto refused = [&](auto change) {
    surefoot::CmaEsSearch search = good;
    change(search.schedule);
    CHECK_THROWS_AS(surefoot::load_cma_es_search(save(search), "odd"), surefoot::CoreError);
  };
  refused([](surefoot::RestartSchedule& schedule) { schedule.first_population = Eigen::Index{1} << 60; });
  refused([](surefoot::RestartSchedule& schedule) { schedule.large_population = Eigen::Index{1} << 60; });
}

TEST_CASE("a search with a matrix of many rows and no number is refused") {
  surefoot::CmaEsSearch search;
  search.start = search.state.mean = Eigen::VectorXd::Ones(2);
  search.state.covariance.resize(Eigen::Index{1} << 62, 0);
  CHECK_THROWS_WITH_AS(surefoot::load_cma_es_search(save(search), "odd"), "odd holds a matrix that is not rectangular",
                       surefoot::CoreError);
}

#ifdef SUREFOOT_FUZZ_PROGRAMS
TEST_CASE("values nested as deeply as a file can hold are refused before the stack ends") {
  constexpr std::size_t deep = 300'000;
  const std::string nested = std::string(deep, '[') + std::string(deep, ']');
  std::string motion = fixture("motion.json");
  for (const char* field : {"\"name\": ", "\"chosen\": ", "\"value\": "}) {
    std::string text = motion;
    const std::size_t at = text.find(field) + std::string_view(field).size();
    REQUIRE(at < text.size());
    text.replace(at, text.find_first_of(",\n}", at) - at, nested);
    CHECK_NOTHROW(fuzz::motion(input_of(text)));
  }
  CHECK_NOTHROW(fuzz::motion(input_of(nested)));
  CHECK_NOTHROW(fuzz::parameters(input_of("{\"policy\": " + nested + ", \"parameters\": {}}")));
  CHECK_NOTHROW(fuzz::joints(input_of("{\"left_hip_yaw\": " + nested + "}")));
  std::string keys = "a";
  for (std::size_t i = 0; i < deep; ++i) keys += ".a";
  for (const std::string& text : {"a = " + nested, "[" + keys + "]\n", keys + " = 1\n", std::string(deep, '{')}) {
    CHECK_NOTHROW(fuzz::model(input_of(text)));
  }
  CHECK_NOTHROW(fuzz::model(input_of("a = " + std::string(1000, '[') + std::string(1000, ']'))));
  CHECK_NOTHROW(fuzz::model(input_of(keys.substr(0, 10'001) + " = 1\n")));
}

TEST_CASE("strings of a model file that are no UTF-8") {
  CHECK_NOTHROW(fuzz::model(input_of("sx ='\373,?\377x ='\373,?\377\0\354")));
  CHECK_NOTHROW(fuzz::model(input_of("a = '20 \260C'\n")));
  CHECK_NOTHROW(fuzz::model(input_of("a = '''\n\260'''\nb = \"\260\"\nc = \"\"\"\260\"\"\"\n")));
}

TEST_CASE("pieces of a file stand in a message cut short and on one line") {
  CHECK_NOTHROW(fuzz::joints(input_of("{\"no\\njoint " + std::string(2000, 'x') + "\": {}}")));
  CHECK_NOTHROW(fuzz::reference(input_of("phase," + std::string(2000, 'x') + "\n")));
}
#endif

TEST_CASE("a feed notices what a reader must not do") {
  struct Foreign : surefoot::Error {
    using Error::Error;
  };
  const auto throws = [](const auto& error) { return [error] { throw error; }; };
  CHECK(fuzz::accepted<surefoot::CoreError>([] {}));
  CHECK_FALSE(fuzz::accepted<surefoot::CoreError>(throws(surefoot::CoreError("file x is damaged: write it again"))));
  CHECK_THROWS_AS(fuzz::accepted<surefoot::CoreError>(throws(Foreign("the error of another area"))),
                  fuzz::Misbehaviour);
  CHECK_THROWS_AS(fuzz::accepted<surefoot::CoreError>(throws(surefoot::CoreError("two\nlines of a message"))),
                  fuzz::Misbehaviour);
  CHECK_THROWS_AS(fuzz::accepted<surefoot::CoreError>(throws(surefoot::CoreError("short"))), fuzz::Misbehaviour);
  CHECK_THROWS_AS(fuzz::accepted<surefoot::CoreError>(throws(std::out_of_range("of no area at all"))),
                  std::out_of_range);
}
