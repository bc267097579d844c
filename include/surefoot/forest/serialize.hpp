// Forest files: versioned, little-endian, checked to the last bit before a forest comes out.
//
//   0  char[8]  "SUREFRST"          24  u32  outputs                 64  u64[nodes]   the nodes as they lie in memory
//   8  u32      version (1)         28  u32  floats per leaf             u32[trees]   index of each root
//   12 u32      tag of the leaf     32  u64  trees                       f32[leaves * floats per leaf], unless that is
//   1 16 u32      header bytes (64)   40  u64  nodes                       u64          checksum of all above 20 u32
//   inputs              48  u64  leaves   56  u64  0
//
// Nodes start at a multiple of 64 bytes, so a file can be mapped. Loading is one pass, O(bytes).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <limits>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/trees.hpp"

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

/// What is wrong with a node whose children, if it has any, are good or not.
inline const char* fault(const Node& node, const Trees& trees, bool good_children) {
  if (node.is_leaf()) {
    return node.input() != trees.inputs ? "a leaf must name the slot behind the last input"
                                        : "its leaf value is not a finite number or not in the table";
  }
  if (node.input() >= trees.inputs) return "it tests an input that does not exist";
  return good_children ? "its threshold is not finite" : "its children are not where they can be";
}

/// Throws unless every descent ends in a leaf with finite numbers and every node belongs to one tree only. One pass
/// whose only branch is never taken for a good forest: leaves and inner nodes come in no order that could be predicted.
inline void check_trees(const Trees& trees, const ByteReader& in) {
  const std::size_t count = trees.nodes.size();
  const std::size_t nowhere = count + count % 2;
  std::vector<std::uint8_t> reached(nowhere + 2, 0);  // has a parent, or is a root
  std::size_t next_root = 0;
  for (const std::uint32_t root : trees.roots) {
    if (root >= count || root % nodes_per_line != 0 || root < next_root) in.fail("has a bad list of roots");
    reached[root] = 1;
    next_root = root + nodes_per_line;
  }
  constexpr std::uint32_t lowest = sort_key(std::numeric_limits<float>::lowest());
  constexpr std::uint32_t highest = sort_key(std::numeric_limits<float>::max());
  constexpr std::uint32_t infinity = 0x7F800000U;
  const std::uint32_t number_mask = trees.inline_leaves() ? 0x7FFFFFFFU : ~0U;  // takes a float's sign off
  const auto number_end =
      trees.inline_leaves() ? infinity : static_cast<std::uint32_t>(std::max<std::size_t>(trees.leaves, 1));
  const auto slot = static_cast<std::uint32_t>(trees.inputs);
  std::size_t leaves = 0;
  for (std::size_t i = 0; i < count; ++i) {  // numbers for truth values: compilers make branches of those
    const Node node = trees.nodes[i];
    const auto input = static_cast<std::uint32_t>(node.input());
    const std::uint32_t inner = node.is_leaf() ? 0 : ~0U;  // a mask
    const std::size_t child = i + node.distance();
    const std::size_t target = std::min(child, nowhere);
    const std::uint32_t bad_children = (child + 1 >= count ? 1U : 0U) | (child & 1U) | reached[target];
    const std::uint32_t bad_inner =
        bad_children | (input >= slot ? 1U : 0U) | (node.key() - lowest > highest - lowest ? 1U : 0U);
    const std::uint32_t bad_leaf = (input ^ slot) | ((node.payload() & number_mask) >= number_end ? 1U : 0U);
    if (((bad_inner & inner) | (bad_leaf & ~inner)) != 0) [[unlikely]] {
      in.fail("has a bad node " + std::to_string(i) + ": " + fault(node, trees, bad_children == 0));
    }
    leaves += reached[i] & ~inner;
    // A leaf "goes on" to itself and must not change what is known of it.
    const std::uint32_t passed_on = reached[i] & inner;
    const std::size_t inner_address = std::size_t{0} - (inner & 1U);
    const std::size_t left = (target & inner_address) | (nowhere & ~inner_address);
    reached[left] = static_cast<std::uint8_t>(passed_on);
    reached[left + 1] = static_cast<std::uint8_t>(passed_on);
  }
  if (leaves != trees.leaves) {
    in.fail("has " + std::to_string(leaves) + " leaves, its header says " + std::to_string(trees.leaves));
  }
  for (std::size_t i = 0; i < trees.parameters.size(); ++i) {
    if (!std::isfinite(trees.parameters[i])) in.fail("has a leaf number that is not finite: " + std::to_string(i));
  }
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

/// Takes a forest out of a larger file. Throws ForestError if it is damaged or of another type.
template <AnyForest F>
F read(ByteReader& in) {
  using Traits = detail::ForestTraits<F>;
  try {
    const std::size_t start = in.position();
    const detail::ForestHeader header = detail::read_header(in);
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
    Trees trees;
    trees.inputs = static_cast<int>(header.inputs);
    trees.outputs = static_cast<int>(header.outputs);
    trees.leaf_parameters = Traits::Leaf::parameters(trees.inputs, trees.outputs);
    expect(header.leaf_parameters, trees.leaf_parameters, "numbers per leaf:");
    trees.leaves = header.leaves;
    in.words(trees.nodes, header.nodes);
    in.words(trees.roots, header.trees);
    in.words(trees.parameters, header.parameters());
    in.expect_checksum(start);
    detail::check_trees(trees, in);
    return F(std::move(trees));
  } catch (const CoreError& error) {
    throw ForestError(error.what());
  }
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
  try {
    write_file_atomically(path, out.bytes());
  } catch (const CoreError& error) {
    throw ForestError(error.what());
  }
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
  try {
    read_more(detail::forest_header_bytes);
    ByteReader header(bytes, source);
    read_more(detail::read_header(header).body_bytes());
  } catch (const CoreError& error) {
    throw ForestError(error.what());
  }
  ByteReader in(bytes, source);
  return read<F>(in);
}

/// Reads a file that holds one forest and nothing else.
template <AnyForest F>
F load(const std::filesystem::path& path) {
  try {
    const Bytes bytes = read_file(path);
    ByteReader in(bytes, "file " + path.string());
    F forest = read<F>(in);
    in.expect_end();
    return forest;
  } catch (const CoreError& error) {
    throw ForestError(error.what());
  }
}

}  // namespace surefoot
