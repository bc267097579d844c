// Forest files: versioned, little-endian, checked to the last bit before a forest comes out.
//
//    0  char[8]  "SUREFRST"              40  u64  nodes
//    8  u32      version (1)             48  u64  leaves
//   12  u32      tag of the leaf         56  u64  0
//   16  u32      header bytes (64)       64  u64[nodes]  the nodes as they lie in memory
//   20  u32      inputs                      u32[trees]  index of each root
//   24  u32      outputs                     f32[leaves * floats per leaf], unless that is 1
//   28  u32      floats per leaf             u64         checksum of all above
//   32  u64      trees
//
// Nodes start at a multiple of 64 bytes, so a file can be mapped and used in place (`view`). Loading is one pass,
// O(bytes).
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/evaluate/check_trees.hpp"
#include "surefoot/forest/evaluate/trees.hpp"
#include "surefoot/forest/forest.hpp"

namespace surefoot {

namespace detail {

constexpr std::string_view forest_magic = "SUREFRST";
constexpr std::uint32_t forest_version = 1;
constexpr std::size_t forest_header_bytes = 64;

struct ForestHeader {
  std::uint32_t leaf_tag = 0;
  std::uint32_t inputs = 0;
  std::uint32_t outputs = 0;
  std::uint32_t leaf_parameters = 0;
  std::uint64_t trees = 0;
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;

  std::uint64_t parameters() const { return leaf_parameters == 1 ? 0 : leaves * leaf_parameters; }
  std::uint64_t body_bytes() const { return 8 * nodes + 4 * trees + 4 * parameters() + 8; }
};

inline void write_header(ByteWriter& out, const ForestHeader& header) {
  out.raw(std::as_bytes(std::span(forest_magic)));
  out.u32(forest_version);
  out.u32(header.leaf_tag);
  out.u32(forest_header_bytes);
  out.u32(header.inputs);
  out.u32(header.outputs);
  out.u32(header.leaf_parameters);
  out.u64(header.trees);
  out.u64(header.nodes);
  out.u64(header.leaves);
  out.u64(0);
}

inline ForestHeader read_header(ByteReader& in) {
  const auto magic = in.raw(forest_magic.size());
  if (!std::ranges::equal(magic, std::as_bytes(std::span(forest_magic)))) {
    in.fail("is not a forest: it must start with \"" + std::string(forest_magic) + "\"");
  }
  if (const std::uint32_t version = in.u32(); version != forest_version) {
    in.fail("has format version " + std::to_string(version) + ", this library reads version " +
            std::to_string(forest_version));
  }
  ForestHeader header;
  header.leaf_tag = in.u32();
  const std::uint32_t header_bytes = in.u32();
  header.inputs = in.u32();
  header.outputs = in.u32();
  header.leaf_parameters = in.u32();
  header.trees = in.u64();
  header.nodes = in.u64();
  header.leaves = in.u64();
  if (header_bytes != forest_header_bytes || in.u64() != 0) in.fail("has a damaged forest header");
  // These bounds keep all later products far below 2^64.
  if (header.nodes > 0x7FFFFFFFU || header.leaves > header.nodes || header.trees > header.nodes) {
    in.fail("has a damaged forest header: " + std::to_string(header.nodes) + " nodes, " +
            std::to_string(header.leaves) + " leaves, " + std::to_string(header.trees) + " trees cannot be");
  }
  return header;
}

template <class F>
struct ForestTraits : std::false_type {};
template <int I, int O, LeafModel L>
struct ForestTraits<Forest<I, O, L>> : std::true_type {
  static constexpr int inputs = I;
  static constexpr int outputs = O;
  using Leaf = L;
};

}  // namespace detail

/// Any Forest<Inputs, Outputs, Leaf>.
template <class F>
concept AnyForest = detail::ForestTraits<F>::value;

/// Appends the forest to a larger file in the making.
template <int Inputs, int Outputs, LeafModel Leaf>
void write(ByteWriter& out, const Forest<Inputs, Outputs, Leaf>& forest) {
  const Trees& trees = forest.raw();
  const std::size_t start = out.size();
  detail::write_header(
      out, {Leaf::tag, static_cast<std::uint32_t>(trees.inputs), static_cast<std::uint32_t>(trees.outputs),
            static_cast<std::uint32_t>(trees.leaf_parameters), trees.roots.size(), trees.nodes.size(), trees.leaves});
  out.words(std::span<const Node>(trees.nodes));
  out.words(std::span<const std::uint32_t>(trees.roots));
  out.words(std::span<const float>(trees.parameters));
  out.add_checksum(start);
}

namespace detail {

/// The sizes in the header. Throws unless a forest of type F can have them.
template <AnyForest F>
TreesShape shape_for(const ForestHeader& header, const ByteReader& in) {
  using Traits = ForestTraits<F>;
  auto expect = [&](std::uint64_t found, std::uint64_t wanted, const char* what) {
    if (found != wanted) {
      in.fail("holds a forest with " + std::string(what) + " " + std::to_string(found) + ", expected " +
              std::to_string(wanted));
    }
  };
  expect(header.leaf_tag, Traits::Leaf::tag, "leaves of kind");
  if (Traits::inputs != Eigen::Dynamic) expect(header.inputs, static_cast<std::uint32_t>(Traits::inputs), "inputs:");
  if (Traits::outputs != Eigen::Dynamic)
    expect(header.outputs, static_cast<std::uint32_t>(Traits::outputs), "outputs:");
  if (header.inputs > static_cast<std::uint32_t>(max_forest_inputs) || header.outputs > 0xFFFFFFU) {
    in.fail("has a damaged forest header: at most 255 inputs and 2^24 outputs can be");
  }
  TreesShape shape;
  shape.inputs = static_cast<int>(header.inputs);
  shape.outputs = static_cast<int>(header.outputs);
  shape.leaf_parameters = Traits::Leaf::parameters(shape.inputs, shape.outputs);
  expect(header.leaf_parameters, shape.leaf_parameters, "numbers per leaf:");
  shape.leaves = header.leaves;
  return shape;
}

inline void take(ByteReader& in, auto& items, std::uint64_t count) { in.words(items, count); }

/// Leaves the items where they lie.
template <Word T>
void take(ByteReader& in, std::span<const T>& items, std::uint64_t count) {
  const std::uint64_t one_too_many = in.remaining() / sizeof(T) + 1;  // of which the reader complains
  const auto bytes = in.raw(std::min(count, one_too_many) * sizeof(T));
  items = {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

/// Trees of F, or where they lie, checked to the last bit. Throws a CoreError.
template <AnyForest F, class Storage>
Storage read_trees(ByteReader& in) {
  const std::size_t start = in.position();
  const ForestHeader header = read_header(in);
  Storage trees;
  static_cast<TreesShape&>(trees) = shape_for<F>(header, in);
  take(in, trees.nodes, header.nodes);
  take(in, trees.roots, header.trees);
  take(in, trees.parameters, header.parameters());
  in.expect_checksum(start);
  check_trees(trees, in);
  return trees;
}

/// Calls job(); what the core complains of becomes a ForestError.
template <class Job>
auto as_forest_error(const Job& job) {
  try {
    return job();
  } catch (const CoreError& error) {
    throw ForestError(error.what());
  }
}

}  // namespace detail

/// Takes a forest out of a larger file. Throws ForestError if it is damaged or of another type.
template <AnyForest F>
F read(ByteReader& in) {
  return detail::as_forest_error([&] { return F(detail::read_trees<F, Trees>(in)); });
}

template <int Inputs, int Outputs, LeafModel Leaf>
void save(const Forest<Inputs, Outputs, Leaf>& forest, std::ostream& stream) {
  ByteWriter out;
  write(out, forest);
  stream.write(reinterpret_cast<const char*>(out.bytes().data()), static_cast<std::streamsize>(out.size()));
  if (!stream) throw ForestError("the forest cannot be written to the stream");
}

template <int Inputs, int Outputs, LeafModel Leaf>
void save(const Forest<Inputs, Outputs, Leaf>& forest, const std::filesystem::path& path) {
  ByteWriter out;
  write(out, forest);
  detail::as_forest_error([&] { write_file_atomically(path, out.bytes()); });
}

/// Reads one forest and leaves the stream right behind it. `source` names the stream in messages.
template <AnyForest F>
F load(std::istream& stream, const std::string& source = "the stream") {
  Bytes bytes;
  auto read_more = [&](std::uint64_t count) {  // in pieces: a size that lies costs no more memory than there are bytes
    while (count > 0 && stream) {
      const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(count, 1U << 20U));
      const std::size_t old = bytes.size();
      bytes.resize(old + piece);
      stream.read(reinterpret_cast<char*>(bytes.data() + old), static_cast<std::streamsize>(piece));
      bytes.resize(old + static_cast<std::size_t>(stream.gcount()));
      count -= piece;
    }
  };
  detail::as_forest_error([&] {
    read_more(detail::forest_header_bytes);
    ByteReader header(bytes, source);
    read_more(detail::read_header(header).body_bytes());
  });
  ByteReader in(bytes, source);
  return read<F>(in);
}

/// Copies a forest out of bytes that hold it and nothing else, those of a mapped file for instance. `source` names
/// them in messages.
template <AnyForest F>
F load(std::span<const std::byte> bytes, const std::string& source = "the bytes") {
  return detail::as_forest_error([&] {
    ByteReader in(bytes, source);
    F forest(detail::read_trees<F, Trees>(in));
    in.expect_end();
    return forest;
  });
}

/// Reads a file that holds one forest and nothing else.
template <AnyForest F>
F load(const std::filesystem::path& path) {
  const Bytes bytes = detail::as_forest_error([&] { return read_file(path); });
  return load<F>(std::span(bytes), "file " + path.string());
}

/// A forest of type F that stays in `bytes`, which hold it and nothing else and must outlive it unchanged: they are
/// checked once, here, as `load` does, but not copied. They must start at a multiple of 8 bytes in memory; at one of
/// 64, as mapped files do, predictions are as fast as a Forest's. Little-endian machines only.
///
///   auto* memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
///   auto forest = view<Forest<6, 1>>({static_cast<const std::byte*>(memory), size});
template <AnyForest F>
requires(std::endian::native == std::endian::little) auto view(std::span<const std::byte> bytes,
                                                               const std::string& source = "the bytes") {
  using Traits = detail::ForestTraits<F>;
  return detail::as_forest_error([&] {
    ByteReader in(bytes, source);
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(Node) != 0) {
      in.fail("cannot be used in place: they must start at a multiple of " + std::to_string(alignof(Node)) + " bytes");
    }
    ForestView<Traits::inputs, Traits::outputs, typename Traits::Leaf> forest(detail::read_trees<F, TreesView>(in));
    in.expect_end();
    return forest;
  });
}

}  // namespace surefoot
