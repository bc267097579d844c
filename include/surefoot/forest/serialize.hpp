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

#include <bit>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/forest/trees.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"

namespace surefoot {

namespace detail {

template <class F>
struct ForestTraits : std::false_type {};
template <int I, int O, LeafModel L>
struct ForestTraits<Forest<I, O, L>> : std::true_type {
  static constexpr int inputs = I;
  static constexpr int outputs = O;
  using Leaf = L;
};

/// The type of a forest, as files know it.
struct ForestType {
  std::uint32_t leaf_tag = 0;
  int inputs = 0;   // Eigen::Dynamic: any number
  int outputs = 0;  // likewise
  std::size_t (*leaf_parameters)(int inputs, int outputs) = {};
};

template <class F>
constexpr ForestType forest_type() {
  using Traits = ForestTraits<F>;
  return {Traits::Leaf::tag, Traits::inputs, Traits::outputs, leaf_kind<typename Traits::Leaf>().parameters};
}

void write_trees(ByteWriter& out, const Trees& trees, std::uint32_t leaf_tag);
void save_trees(std::ostream& stream, const Trees& trees, std::uint32_t leaf_tag);
void save_trees(const std::string& path, const Trees& trees, std::uint32_t leaf_tag);

/// Trees of a forest of that type, checked to the last bit. Throws a ForestError.
Trees read_trees(ByteReader& in, const ForestType& type);
Trees load_trees(std::istream& stream, const std::string& source, const ForestType& type);
Trees load_trees(std::span<const std::byte> bytes, const std::string& source, const ForestType& type);
Trees load_trees(const std::string& path, const ForestType& type);
TreesView view_trees(std::span<const std::byte> bytes, const std::string& source, const ForestType& type);

/// Bytes of the forest of any type that begins here, as its header has it, with the checksum at their end. Throws a
/// CoreError if no forest begins here.
std::uint64_t stored_bytes(ByteReader& in);

}  // namespace detail

/// Any Forest<Inputs, Outputs, Leaf>.
template <class F>
concept AnyForest = detail::ForestTraits<F>::value;

/// Appends the forest to a larger file in the making.
template <int Inputs, int Outputs, LeafModel Leaf>
void write(ByteWriter& out, const Forest<Inputs, Outputs, Leaf>& forest) {
  detail::write_trees(out, forest.raw(), Leaf::tag);
}

/// Takes a forest out of a larger file. Throws ForestError if it is damaged or of another type.
template <AnyForest F>
F read(ByteReader& in) {
  return F(detail::read_trees(in, detail::forest_type<F>()));
}

template <int Inputs, int Outputs, LeafModel Leaf>
void save(const Forest<Inputs, Outputs, Leaf>& forest, std::ostream& stream) {
  detail::save_trees(stream, forest.raw(), Leaf::tag);
}

template <int Inputs, int Outputs, LeafModel Leaf>
void save(const Forest<Inputs, Outputs, Leaf>& forest, const std::string& path) {
  detail::save_trees(path, forest.raw(), Leaf::tag);
}

/// Reads one forest and leaves the stream right behind it. `source` names the stream in messages.
template <AnyForest F>
F load(std::istream& stream, const std::string& source = "the stream") {
  return F(detail::load_trees(stream, source, detail::forest_type<F>()));
}

/// Copies a forest out of bytes that hold it and nothing else, those of a mapped file for instance. `source` names
/// them in messages.
template <AnyForest F>
F load(std::span<const std::byte> bytes, const std::string& source = "the bytes") {
  return F(detail::load_trees(bytes, source, detail::forest_type<F>()));
}

/// Reads a file that holds one forest and nothing else.
template <AnyForest F>
F load(const std::string& path) {
  return F(detail::load_trees(path, detail::forest_type<F>()));
}

/// A forest of type F that stays in `bytes`, which hold it and nothing else and must outlive it unchanged: they are
/// checked once, here, as `load` does, but not copied. They must start at a multiple of 8 bytes in memory; at one of
/// 64, as mapped files do, predictions are as fast as a Forest's, but for single ones of large forests, which Forests
/// keep a second layout for. Little-endian machines only.
///
///   auto* memory = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0);
///   auto forest = view<Forest<6, 1>>({static_cast<const std::byte*>(memory), size});
template <AnyForest F>
  requires(std::endian::native == std::endian::little)
auto view(std::span<const std::byte> bytes, const std::string& source = "the bytes") {
  using Traits = detail::ForestTraits<F>;
  return ForestView<Traits::inputs, Traits::outputs, typename Traits::Leaf>(
      detail::view_trees(bytes, source, detail::forest_type<F>()));
}

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/forest/serialize.ipp"
#endif
