// Values that travel between processes as bytes: numbers, Eigen matrices, vectors of them, and structs that list their
// members. Every process runs the same program on the same kind of machine, so the bytes are those in memory.
//
//   struct Fit {
//     double error = 0;
//     Eigen::VectorXd parameters;
//     static constexpr auto fields = std::tuple(&Fit::error, &Fit::parameters);
//   };
//   static_assert(surefoot::Portable<Fit>);
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include "surefoot/core/binary.hpp"

namespace surefoot {

namespace detail {

// Copied byte by byte. A class counts if it is a Word: one number with a name, like a node of a tree.
template <class T>
concept PlainValue = std::is_arithmetic_v<T> || std::is_enum_v<T> || (std::is_class_v<T> && Word<T>);

// An Eigen matrix or array that owns its numbers.
template <class T>
concept DenseMatrix = std::derived_from<T, typename T::PlainObject> && sizeof(T) == sizeof(typename T::PlainObject) &&
                      std::is_arithmetic_v<typename T::Scalar>;

// std::vector, std::string. Not std::vector<bool>, which has no data().
template <class T>
concept Sequence = !DenseMatrix<T> && requires(T& items, std::size_t count) {
  { items.data() } -> std::same_as<typename T::value_type*>;
  { items.size() } -> std::same_as<std::size_t>;
  items.resize(count);
};

template <class T>
concept WithFields = requires { std::tuple_size<std::remove_cv_t<decltype(T::fields)>>::value; };

template <class T>
inline constexpr bool is_pair = false;
template <class A, class B>
inline constexpr bool is_pair<std::pair<A, B>> = true;

template <class T>
constexpr bool is_portable() {
  if constexpr (WithFields<T>) {
    return std::apply(
        []<class... Member>(Member... member) {
          return (is_portable<std::remove_reference_t<decltype(std::declval<T&>().*member)>>() && ...);
        },
        T::fields);
  } else if constexpr (DenseMatrix<T>) {
    return true;
  } else if constexpr (Sequence<T>) {
    return is_portable<typename T::value_type>();
  } else if constexpr (is_pair<T>) {
    return is_portable<typename T::first_type>() && is_portable<typename T::second_type>();
  } else {
    return PlainValue<T>;
  }
}

}  // namespace detail

/// A value that put() and take() know. It must not point to memory outside itself.
template <class T>
concept Portable = detail::is_portable<T>();

template <Portable T>
void put(ByteWriter& out, const T& value) {
  if constexpr (detail::WithFields<T>) {
    std::apply([&](auto... member) { (put(out, value.*member), ...); }, T::fields);
  } else if constexpr (detail::DenseMatrix<T>) {
    if constexpr (T::SizeAtCompileTime < 0) {
      out.u64(static_cast<std::uint64_t>(value.rows()));
      out.u64(static_cast<std::uint64_t>(value.cols()));
    }
    out.raw(std::as_bytes(std::span(value.data(), static_cast<std::size_t>(value.size()))));
  } else if constexpr (detail::Sequence<T>) {
    out.u64(value.size());
    if constexpr (detail::PlainValue<typename T::value_type>) {
      out.raw(std::as_bytes(std::span(value.data(), value.size())));
    } else {
      for (const auto& item : value) put(out, item);
    }
  } else if constexpr (detail::is_pair<T>) {
    put(out, value.first);
    put(out, value.second);
  } else {
    out.raw(std::as_bytes(std::span(&value, 1)));
  }
}

/// Throws CoreError if the bytes end too early.
template <Portable T>
void take(ByteReader& in, T& value) {
  const auto copy = [&in](auto* items, std::size_t count) {
    if (count > in.remaining() / sizeof(*items)) in.fail("ends too early");
    const auto bytes = in.raw(count * sizeof(*items));
    if (count != 0) std::memcpy(static_cast<void*>(items), bytes.data(), bytes.size());
  };
  if constexpr (detail::WithFields<T>) {
    std::apply([&](auto... member) { (take(in, value.*member), ...); }, T::fields);
  } else if constexpr (detail::DenseMatrix<T>) {
    if constexpr (T::SizeAtCompileTime < 0) {
      const std::uint64_t rows = in.u64(), cols = in.u64();
      if (cols != 0 && rows > in.remaining() / sizeof(typename T::Scalar) / cols) in.fail("ends too early");
      using Index = decltype(value.rows());
      value.resize(static_cast<Index>(rows), static_cast<Index>(cols));
    }
    copy(value.data(), static_cast<std::size_t>(value.size()));
  } else if constexpr (detail::Sequence<T>) {
    const std::uint64_t count = in.u64();
    if (count > in.remaining()) in.fail("ends too early");
    value.resize(static_cast<std::size_t>(count));
    if constexpr (detail::PlainValue<typename T::value_type>) {
      copy(value.data(), value.size());
    } else {
      for (auto& item : value) take(in, item);
    }
  } else if constexpr (detail::is_pair<T>) {
    take(in, value.first);
    take(in, value.second);
  } else {
    copy(&value, 1);
  }
}

}  // namespace surefoot
