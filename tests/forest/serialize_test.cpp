#include "surefoot/forest/serialize.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>
#include <sstream>
#include <string>

#include "surefoot/core/executor.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/forest/export_c.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "tests/forest/samples.hpp"
#include "tests/support/scratch_folder.hpp"

namespace surefoot {
namespace {

template <LeafModel Leaf>
using Laws = Forest<4, 2, Leaf>;

template <LeafModel Leaf>
Laws<Leaf> small_forest(std::uint64_t seed = 1) {
  return train_extra_trees<Leaf>(toy::sample(toy::ClippedLaws{}, 60, seed), {.trees = 3, .min_leaf = 6}, Serial{},
                                 seed);
}

template <class F>
Bytes bytes_of(const F& forest) {
  ByteWriter out;
  write(out, forest);
  return std::move(out).bytes();
}

template <class F>
F from_bytes(const Bytes& bytes) {
  ByteReader in(bytes, "test");
  F forest = read<F>(in);
  try {
    in.expect_end();
  } catch (const CoreError& error) {
    throw ForestError(error.what());
  }
  return forest;
}

// Writes the checksum that the bytes before it ask for, as one would who wants to do harm.
void sign(Bytes& bytes) {
  const std::uint64_t sum = checksum(std::span(bytes).first(bytes.size() - 8));
  for (std::size_t i = 0; i < 8; ++i) bytes[bytes.size() - 8 + i] = static_cast<std::byte>(sum >> (8 * i));
}

void put_u32(Bytes& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes.at(at + i) = static_cast<std::byte>(value >> (8 * i));
}
void put_u64(Bytes& bytes, std::size_t at, std::uint64_t value) {
  put_u32(bytes, at, static_cast<std::uint32_t>(value));
  put_u32(bytes, at + 4, static_cast<std::uint32_t>(value >> 32));
}

TEST_CASE_TEMPLATE("a saved forest is loaded as it was", F, Forest<5, 1>, Forest<5, 1, LinearLeaf>, Forest<4, 2>,
                   Forest<4, 2, LinearLeaf>) {
  using Traits = detail::ForestTraits<F>;
  const auto train = [] {
    if constexpr (Traits::inputs == 5) {
      return train_extra_trees<typename Traits::Leaf>(toy::sample(toy::Cliff{}, 500, 1), {}, Serial{}, 1);
    } else {
      return train_extra_trees<typename Traits::Leaf>(toy::sample(toy::ClippedLaws{}, 500, 1), {}, Serial{}, 1);
    }
  };
  const F forest = train();
  const toy::ScratchFolder folder("serialize_test");
  save(forest, folder.path / "forest.bin");
  CHECK(load<F>(folder.path / "forest.bin") == forest);

  using Dynamic = Forest<Eigen::Dynamic, Eigen::Dynamic, typename Traits::Leaf>;
  CHECK(load<Dynamic>(folder.path / "forest.bin").raw() == forest.raw());

  std::stringstream stream;
  stream << "before ";
  save(forest, stream);
  save(forest, stream);
  stream << " after";
  stream.seekg(7);
  CHECK(load<F>(stream) == forest);
  CHECK(load<F>(stream) == forest);
  std::string rest;
  stream >> rest;
  CHECK(rest == "after");
}

TEST_CASE("a forest may be part of a larger file") {
  const auto constant = small_forest<ConstantLeaf>();
  const auto linear = small_forest<LinearLeaf>();
  ByteWriter out;
  out.text("policy");
  write(out, constant);
  write(out, linear);
  out.u32(42);
  ByteReader in(out.bytes(), "policy.bin");
  CHECK(in.text() == "policy");
  CHECK(read<Laws<ConstantLeaf>>(in) == constant);
  CHECK(read<Laws<LinearLeaf>>(in) == linear);
  CHECK(in.u32() == 42);
  in.expect_end();
}

TEST_CASE_TEMPLATE("a forest is used where its bytes lie, without a copy", Leaf, ConstantLeaf, LinearLeaf) {
  const auto forest = small_forest<Leaf>();
  const Bytes bytes = bytes_of(forest);
  const auto in_place = view<Laws<Leaf>>(bytes);
  const auto* first = reinterpret_cast<const std::byte*>(in_place.raw().nodes.data());
  CHECK(first == bytes.data() + 64);
  CHECK(in_place.bytes() == forest.bytes());
  CHECK(in_place.leaves() == forest.leaves());
  const auto samples = toy::sample(toy::ClippedLaws{}, 100, 7);
  typename Laws<Leaf>::BatchOutput expected;
  typename Laws<Leaf>::BatchOutput found;
  forest.predict(samples.inputs, expected);
  in_place.predict(samples.inputs, found);
  CHECK(found == expected);
  const Vec<4> x = samples.inputs.col(0).template cast<double>();
  CHECK(in_place.predict(x) == forest.predict(x));
  CHECK(in_place.predict_with_deviation(x).deviation == forest.predict_with_deviation(x).deviation);
  CHECK(load<Laws<Leaf>>(std::span(bytes)) == forest);
}

TEST_CASE("bytes that cannot be used in place are refused") {
  const Bytes good = bytes_of(small_forest<LinearLeaf>());
  using F = Laws<LinearLeaf>;
  Bytes shifted(4);
  shifted.insert(shifted.end(), good.begin(), good.end());
  CHECK_THROWS_WITH_AS(view<F>(std::span(shifted).subspan(4)), doctest::Contains("multiple of 8"), ForestError);
  CHECK_THROWS_WITH_AS(view<F>(std::span(good).first(good.size() - 1)), doctest::Contains("ends too early"),
                       ForestError);
  CHECK_THROWS_WITH_AS(view<Laws<ConstantLeaf>>(good, "file a.bin"), doctest::Contains("a.bin"), ForestError);
  Bytes longer = good;
  longer.resize(good.size() + 1);
  CHECK_THROWS_WITH_AS(view<F>(longer), doctest::Contains("1 bytes more"), ForestError);
  CHECK_THROWS_WITH_AS(load<F>(std::span(longer)), doctest::Contains("1 bytes more"), ForestError);
}

TEST_CASE("an empty forest is loaded as one") {
  const Forest<4, 2> empty;
  CHECK(from_bytes<Forest<4, 2>>(bytes_of(empty)).empty());
}

TEST_CASE_TEMPLATE("10,000 random mutations of a file give an error or an equal forest", Leaf, ConstantLeaf,
                   LinearLeaf) {
  const auto forest = small_forest<Leaf>();
  const Bytes good = bytes_of(forest);
  Rng rng(1);
  int refused = 0;
  int refused_streams = 0;
  int used_in_place = 0;
  for (int round = 0; round < 5000; ++round) {  // for each kind of leaf
    Bytes bytes = good;
    const auto size = static_cast<std::uint32_t>(bytes.size());
    switch (rng.below(4)) {
      case 0:  // bit flips
        for (std::uint32_t flips = 1 + rng.below(8); flips > 0; --flips) {
          bytes[rng.below(size)] ^= std::byte{1} << rng.below(8);
        }
        break;
      case 1:  // truncation
        bytes.resize(rng.below(size));
        break;
      case 2:  // appended bytes
        for (std::uint32_t more = 1 + rng.below(100); more > 0; --more)
          bytes.push_back(static_cast<std::byte>(rng.bits()));
        break;
      default:  // a stretch of random bytes
        for (std::uint32_t at = rng.below(size), end = std::min(size, at + 1 + rng.below(64)); at < end; ++at) {
          bytes[at] = static_cast<std::byte>(rng.bits());
        }
    }
    try {
      const bool equal = from_bytes<Laws<Leaf>>(bytes) == forest;
      if (!equal) FAIL("mutation ", round, " gave another forest");
    } catch (const ForestError&) {
      ++refused;
    }
    try {
      const auto in_place = view<Laws<Leaf>>(bytes).raw();
      const Trees& raw = forest.raw();
      if (!std::ranges::equal(in_place.nodes, raw.nodes) || !std::ranges::equal(in_place.roots, raw.roots) ||
          !std::ranges::equal(in_place.parameters, raw.parameters)) {
        FAIL("mutation ", round, " gave another forest in place");
      }
      ++used_in_place;
    } catch (const ForestError&) {
    }
    try {
      std::stringstream stream(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
      const bool equal = load<Laws<Leaf>>(stream) == forest;
      if (!equal) FAIL("mutation ", round, " gave another forest from a stream");
    } catch (const ForestError&) {
      ++refused_streams;
    }
  }
  CHECK(refused > 4900);
  CHECK(used_in_place == 5000 - refused);
  CHECK(refused_streams > 3000);  // all but appended bytes, which are left in the stream
}

TEST_CASE_TEMPLATE("a mutated file with a valid checksum is refused or works", Leaf, ConstantLeaf, LinearLeaf) {
  const Bytes good = bytes_of(small_forest<Leaf>());
  Rng rng(2);
  int accepted = 0;
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    Bytes bytes = good;
    for (std::uint32_t flips = 1 + rng.below(3); flips > 0; --flips) {
      bytes[rng.below(static_cast<std::uint32_t>(bytes.size()))] ^= std::byte{1} << rng.below(8);
    }
    sign(bytes);
    try {
      const auto forest = from_bytes<Laws<Leaf>>(bytes);
      ++accepted;
      const Vec<4> x(rng.normal(), rng.normal(), rng.normal(), rng.normal());
      if (!forest.predict(x).allFinite()) FAIL("mutation ", round, " predicts numbers that are not finite");
      CHECK_FALSE(export_c(forest).empty());
    } catch (const ForestError&) {
      ++refused;
    }
  }
  CHECK(accepted > 100);  // thresholds and leaf values may be anything finite
  CHECK(refused > 100);
}

TEST_CASE("a header that lies about sizes is refused before memory is asked for") {
  const Bytes good = bytes_of(small_forest<LinearLeaf>());
  for (const std::size_t field : {std::size_t{32}, std::size_t{40}, std::size_t{48}}) {  // trees, nodes, leaves
    for (const std::uint64_t count :
         {std::uint64_t{1'000'000}, std::uint64_t{0x7FFFFFFF}, std::uint64_t{1} << 40, ~std::uint64_t{0}}) {
      Bytes bytes = good;
      put_u64(bytes, field, count);
      sign(bytes);
      CHECK_THROWS_AS(from_bytes<Laws<LinearLeaf>>(bytes), ForestError);
      std::stringstream stream(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
      CHECK_THROWS_AS(load<Laws<LinearLeaf>>(stream), ForestError);
    }
  }
  for (const std::size_t field : {std::size_t{20}, std::size_t{24}, std::size_t{28}}) {  // inputs, outputs, per leaf
    Bytes bytes = good;
    put_u32(bytes, field, ~std::uint32_t{0});
    sign(bytes);
    using Dynamic = Forest<Eigen::Dynamic, Eigen::Dynamic, LinearLeaf>;
    CHECK_THROWS_AS(from_bytes<Dynamic>(bytes), ForestError);
  }
}

TEST_CASE_TEMPLATE("a header that counts more leaves than there are is refused", Leaf, ConstantLeaf, LinearLeaf) {
  const auto forest = small_forest<Leaf>();
  Bytes bytes = bytes_of(forest);
  put_u64(bytes, 48, forest.raw().leaves + 1);
  bytes.insert(bytes.end(), sizeof(float) * forest.raw().leaf_parameters, std::byte{0});  // its numbers, too
  sign(bytes);
  CHECK_THROWS_WITH_AS(from_bytes<Laws<Leaf>>(bytes), doctest::Contains("leaves, its header says"), ForestError);
}

TEST_CASE("nodes that lead astray are refused") {
  const auto forest = small_forest<ConstantLeaf>();
  const Bytes good = bytes_of(forest);
  const auto node_at = [](std::size_t node) { return 64 + 8 * node; };
  REQUIRE_FALSE(forest.raw().nodes[0].is_leaf());
  std::size_t leaf = 2;
  while (!forest.raw().nodes[leaf].is_leaf()) ++leaf;

  const auto refuse = [&](std::size_t at, std::uint32_t value, const char* why) {
    Bytes bytes = good;
    put_u32(bytes, at, value);
    sign(bytes);
    CHECK_THROWS_WITH_AS(from_bytes<Laws<ConstantLeaf>>(bytes), doctest::Contains(why), ForestError);
  };
  const std::uint32_t link = forest.raw().nodes[0].link();
  refuse(node_at(0), (link & ~255U) | 4, "input that does not exist");
  refuse(node_at(0), link + (1U << 8), "children");                             // not a pair
  refuse(node_at(0), (0xFFFFFEU << 8) | (link & 255U), "children");             // behind the end
  refuse(node_at(0), link + (std::uint32_t{nodes_per_line} << 8), "children");  // another node's pair
  refuse(node_at(0) + 4, sort_key(std::numeric_limits<float>::infinity()), "threshold");
  refuse(node_at(leaf), 3, "slot");
  refuse(node_at(leaf) + 4, 0xFFFFFF, "leaf value");
  const std::size_t roots = 64 + 8 * forest.raw().nodes.size();
  refuse(roots, 1, "roots");
  refuse(roots + 4, 0, "roots");
}

TEST_CASE("a file of another kind is refused with its name and what was expected") {
  const toy::ScratchFolder folder("serialize_test");
  const auto path = folder.path / "forest.bin";
  save(small_forest<ConstantLeaf>(), path);
  CHECK_THROWS_WITH_AS((load<Forest<5, 2>>(path)), doctest::Contains("inputs: 4, expected 5"), ForestError);
  CHECK_THROWS_WITH_AS((load<Forest<4, 1>>(path)), doctest::Contains("outputs: 2, expected 1"), ForestError);
  CHECK_THROWS_WITH_AS((load<Forest<4, 2, LinearLeaf>>(path)), doctest::Contains("kind 1, expected 2"), ForestError);
  CHECK_THROWS_WITH_AS((load<Forest<4, 2>>(folder.path / "none.bin")), doctest::Contains("none.bin"), ForestError);
  write_file_atomically(path, "something else altogether");
  CHECK_THROWS_WITH_AS((load<Forest<4, 2>>(path)), doctest::Contains("forest.bin is not a forest"), ForestError);
  Bytes newer = bytes_of(small_forest<ConstantLeaf>());
  put_u32(newer, 8, 2);
  write_file_atomically(path, newer);
  CHECK_THROWS_WITH_AS((load<Forest<4, 2>>(path)), doctest::Contains("version 2"), ForestError);
  CHECK_THROWS_WITH_AS(save(small_forest<ConstantLeaf>(), folder.path / "no" / "folder.bin"),
                       doctest::Contains("folder.bin"), ForestError);
}

}  // namespace
}  // namespace surefoot
