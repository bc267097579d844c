// Definitions of surefoot/forest/serialize.hpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <istream>
#include <ostream>
#include <span>
#include <string>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/forest/evaluate/check_trees.hpp"
#include "surefoot/forest/serialize.hpp"

namespace surefoot::detail {

constexpr FileFormat forest_format{"SUREFRST", 1, "a forest"};
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
  write_format(out, forest_format);
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
  expect_format(in, forest_format);
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

/// The sizes in the header. Throws unless a forest of that type can have them.
inline TreesShape shape_for(const ForestType& type, const ForestHeader& header, const ByteReader& in) {
  auto expect = [&](std::uint64_t found, std::uint64_t wanted, const char* what) {
    if (found != wanted) {
      in.fail("holds a forest with " + std::string(what) + " " + std::to_string(found) + ", expected " +
              std::to_string(wanted));
    }
  };
  expect(header.leaf_tag, type.leaf_tag, "leaves of kind");
  if (type.inputs != Eigen::Dynamic) expect(header.inputs, static_cast<std::uint32_t>(type.inputs), "inputs:");
  if (type.outputs != Eigen::Dynamic) expect(header.outputs, static_cast<std::uint32_t>(type.outputs), "outputs:");
  if (header.inputs > static_cast<std::uint32_t>(max_forest_inputs) || header.outputs > 0xFFFFFFU) {
    in.fail("has a damaged forest header: at most 255 inputs and 2^24 outputs can be");
  }
  TreesShape shape;
  shape.inputs = static_cast<int>(header.inputs);
  shape.outputs = static_cast<int>(header.outputs);
  shape.leaf_parameters = type.leaf_parameters(shape.inputs, shape.outputs);
  expect(header.leaf_parameters, shape.leaf_parameters, "numbers per leaf:");
  shape.leaves = header.leaves;
  return shape;
}

template <class Vector>
void take_words(ByteReader& in, Vector& items, std::uint64_t count) {
  in.words(items, count);
}

/// Leaves the items where they lie.
template <Word T>
void take_words(ByteReader& in, std::span<const T>& items, std::uint64_t count) {
  const std::uint64_t one_too_many = in.remaining() / sizeof(T) + 1;  // of which the reader complains
  const auto bytes = in.raw(std::min(count, one_too_many) * sizeof(T));
  items = {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

/// `Storage`: Trees, or TreesView for where they lie. Throws a CoreError.
template <class Storage>
Storage checked_trees(ByteReader& in, const ForestType& type) {
  const std::size_t start = in.position();
  const ForestHeader header = read_header(in);
  Storage trees;
  static_cast<TreesShape&>(trees) = shape_for(type, header, in);
  take_words(in, trees.nodes, header.nodes);
  take_words(in, trees.roots, header.trees);
  take_words(in, trees.parameters, header.parameters());
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

SUREFOOT_INLINE void write_trees(ByteWriter& out, const Trees& trees, std::uint32_t leaf_tag) {
  const std::size_t start = out.size();
  write_header(
      out, {leaf_tag, static_cast<std::uint32_t>(trees.inputs), static_cast<std::uint32_t>(trees.outputs),
            static_cast<std::uint32_t>(trees.leaf_parameters), trees.roots.size(), trees.nodes.size(), trees.leaves});
  out.words(std::span<const Node>(trees.nodes));
  out.words(std::span<const std::uint32_t>(trees.roots));
  out.words(std::span<const float>(trees.parameters));
  out.add_checksum(start);
}

SUREFOOT_ONCE void save_trees(std::ostream& stream, const Trees& trees, std::uint32_t leaf_tag) {
  ByteWriter out;
  write_trees(out, trees, leaf_tag);
  stream.write(reinterpret_cast<const char*>(out.bytes().data()), static_cast<std::streamsize>(out.size()));
  if (!stream) throw ForestError("the forest cannot be written to the stream");
}

SUREFOOT_ONCE void save_trees(const std::string& path, const Trees& trees, std::uint32_t leaf_tag) {
  ByteWriter out;
  write_trees(out, trees, leaf_tag);
  as_forest_error([&] { write_file_atomically(path, out.bytes()); });
}

SUREFOOT_INLINE Trees read_trees(ByteReader& in, const ForestType& type) {
  return as_forest_error([&] { return checked_trees<Trees>(in, type); });
}

SUREFOOT_ONCE Trees load_trees(std::istream& stream, const std::string& source, const ForestType& type) {
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
  as_forest_error([&] {
    read_more(forest_header_bytes);
    ByteReader header(bytes, source);
    read_more(read_header(header).body_bytes());
  });
  ByteReader in(bytes, source);
  return read_trees(in, type);
}

SUREFOOT_ONCE Trees load_trees(std::span<const std::byte> bytes, const std::string& source, const ForestType& type) {
  return as_forest_error([&] {
    ByteReader in(bytes, source);
    Trees trees = checked_trees<Trees>(in, type);
    in.expect_end();
    return trees;
  });
}

SUREFOOT_ONCE Trees load_trees(const std::string& path, const ForestType& type) {
  const Bytes bytes = as_forest_error([&] { return read_file(path); });
  return load_trees(bytes, "file " + path, type);
}

SUREFOOT_ONCE TreesView view_trees(std::span<const std::byte> bytes, const std::string& source,
                                   const ForestType& type) {
  return as_forest_error([&] {
    ByteReader in(bytes, source);
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(Node) != 0) {
      in.fail("cannot be used in place: they must start at a multiple of " + std::to_string(alignof(Node)) + " bytes");
    }
    TreesView trees = checked_trees<TreesView>(in, type);
    in.expect_end();
    return trees;
  });
}

SUREFOOT_ONCE std::uint64_t stored_bytes(ByteReader& in) { return forest_header_bytes + read_header(in).body_bytes(); }

}  // namespace surefoot::detail
