// Definitions of surefoot/optimize/cma_es_serialize.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/box.hpp"
#include "surefoot/core/compiled.hpp"
#include "surefoot/core/vec.hpp"
#include "surefoot/optimize/cma_es_search.hpp"
#include "surefoot/optimize/cma_es_serialize.hpp"

namespace surefoot::detail {

constexpr std::string_view cma_es_magic = "SUREFCMA";
constexpr std::uint32_t cma_es_version = 1;

// The order of the fields, for both directions.
template <class Archive, class Descent>
requires std::same_as<std::remove_const_t<Descent>, CmaEsDescent>
void transfer(Archive& archive, Descent& descent) {
  const auto fields = [&](auto&... field) { (archive(field), ...); };
  fields(descent.population, descent.generations, descent.evaluations, descent.reason);
  fields(descent.best_value, descent.best, descent.mean);
}

template <class Archive, class Search>
requires std::same_as<std::remove_const_t<Search>, CmaEsSearch>
void transfer(Archive& archive, Search& search) {
  const auto fields = [&](auto&... field) { (archive(field), ...); };
  fields(search.start, search.sigma, search.box, search.seed);
  auto& state = search.state;
  fields(state.seed, state.descent, state.generation, state.population, state.mean, state.sigma, state.start_sigma);
  fields(state.covariance, state.factor, state.degenerate, state.path_sigma, state.path);
  fields(state.value_range, state.best_values, state.median_values);
  auto& plan = search.plan;
  fields(plan.population, plan.sigma_factor, plan.max_evaluations, plan.small);
  auto& schedule = search.schedule;
  fields(schedule.first_population, schedule.large_population, schedule.large_restarts);
  fields(schedule.large_evaluations, schedule.small_evaluations, schedule.last_large_evaluations);
  transfer(archive, search.descent);
  fields(search.finished, search.noise_evaluations, search.evaluations);
}

class FieldWriter {
 public:
  explicit FieldWriter(ByteWriter& out) : out_(out) {}
  void operator()(double value) { out_.f64(value); }
  void operator()(bool value) { out_.u8(value); }
  void operator()(StopReason value) { out_.u8(static_cast<std::uint8_t>(value)); }
  template <std::integral T>
  void operator()(T value) {
    out_.u64(static_cast<std::uint64_t>(value));
  }
  void operator()(const Eigen::VectorXd& values) {
    out_.list(std::span(values.data(), static_cast<std::size_t>(values.size())));
  }
  void operator()(const Eigen::MatrixXd& values) {
    (*this)(values.rows());
    out_.list(std::span(values.data(), static_cast<std::size_t>(values.size())));
  }
  void operator()(const std::deque<double>& values) { out_.list(std::vector<double>(values.begin(), values.end())); }
  void operator()(const std::optional<Box<Eigen::Dynamic>>& box) {
    (*this)(box.has_value());
    if (!box) return;
    (*this)(box->low());
    (*this)(box->high());
  }
  void operator()(const std::vector<CmaEsDescent>& descents) {
    (*this)(descents.size());
    for (const CmaEsDescent& descent : descents) transfer(*this, descent);
  }

 private:
  ByteWriter& out_;
};

class FieldReader {
 public:
  explicit FieldReader(ByteReader& in) : in_(in) {}
  void operator()(double& value) { value = in_.f64(); }
  void operator()(bool& value) { value = in_.u8() != 0; }
  void operator()(StopReason& value) {
    const std::uint8_t number = in_.u8();
    if (number > static_cast<std::uint8_t>(StopReason::no_effect_coordinate)) in_.fail("names an unknown stop reason");
    value = static_cast<StopReason>(number);
  }
  template <std::integral T>
  void operator()(T& value) {
    const std::uint64_t number = in_.u64();
    if (number > static_cast<std::uint64_t>(std::numeric_limits<T>::max())) in_.fail("holds a count that is too large");
    value = static_cast<T>(number);
  }
  void operator()(Eigen::VectorXd& values) {
    const std::vector<double> list = in_.list<double>();
    values = Eigen::Map<const Eigen::VectorXd>(list.data(), static_cast<Eigen::Index>(list.size()));
  }
  void operator()(Eigen::MatrixXd& values) {
    const std::uint64_t rows = in_.u64();
    const std::vector<double> list = in_.list<double>();
    if (rows == 0 || rows > list.size() || list.size() % rows != 0) in_.fail("holds a matrix that is not rectangular");
    values = Eigen::Map<const Eigen::MatrixXd>(list.data(), static_cast<Eigen::Index>(rows),
                                               static_cast<Eigen::Index>(list.size() / rows));
  }
  void operator()(std::deque<double>& values) {
    const std::vector<double> list = in_.list<double>();
    values.assign(list.begin(), list.end());
  }
  void operator()(std::optional<Box<Eigen::Dynamic>>& box) {
    bool present = false;
    (*this)(present);
    Eigen::VectorXd low, high;
    if (!present) return;
    (*this)(low);
    (*this)(high);
    box.emplace(low, high);
  }
  void operator()(std::vector<CmaEsDescent>& descents) {
    for (std::uint64_t left = in_.u64(); left > 0; --left) transfer(*this, descents.emplace_back());
  }

 private:
  ByteReader& in_;
};

// Whether all sizes and numbers fit together, so that the search can go on without a look back.
SUREFOOT_ONCE bool is_sound(const CmaEsSearch& search) {
  const CmaEsState& state = search.state;
  const Eigen::Index n = state.dimension(), users = search.start.size();
  const auto square = [n](const Eigen::MatrixXd& m) { return m.rows() == n && m.cols() == n; };
  const auto column = [n](const Eigen::VectorXd& v) { return v.size() == n && all_finite(v); };
  const auto population = [](Eigen::Index count) { return count >= 4 && count <= max_population; };
  const auto point = [users](const CmaEsDescent& d) {
    return (d.best.size() == users || d.best.size() == 0) && (d.mean.size() == users || d.mean.size() == 0);
  };
  Eigen::Index free = users;
  if (search.box) {
    if (search.box->size() != users) return false;
    free = 0;
    for (const double width : search.box->width()) free += width > 0 ? 1 : 0;
  }
  return n > 0 && n == free && all_finite(search.start) && search.sigma > 0 && population(state.population) &&
         state.descent == search.finished.size() && search.plan.population == state.population &&
         search.descent.population == state.population && population(search.schedule.first_population) &&
         population(search.schedule.large_population) && column(state.mean) && state.sigma > 0 &&
         state.start_sigma > 0 && square(state.covariance) && square(state.factor) && column(state.path_sigma) &&
         column(state.path) && state.best_values.size() == state.median_values.size() &&
         search.noise_evaluations >= 1 && search.noise_evaluations <= 1e9 && point(search.descent) &&
         std::ranges::all_of(search.finished, point);
}

}  // namespace surefoot::detail

namespace surefoot {

SUREFOOT_ONCE Bytes save(const CmaEsSearch& search) {
  ByteWriter out;
  out.raw(std::as_bytes(std::span(detail::cma_es_magic)));
  out.u32(detail::cma_es_version);
  detail::FieldWriter writer(out);
  detail::transfer(writer, search);
  out.add_checksum();
  return std::move(out).bytes();
}

SUREFOOT_ONCE CmaEsSearch load_cma_es_search(std::span<const std::byte> bytes, const std::string& source) {
  ByteReader in(bytes, source);
  if (!std::ranges::equal(in.raw(detail::cma_es_magic.size()), std::as_bytes(std::span(detail::cma_es_magic)))) {
    in.fail("is not a search by CMA-ES: it must start with \"" + std::string(detail::cma_es_magic) + "\"");
  }
  if (const std::uint32_t version = in.u32(); version != detail::cma_es_version) {
    in.fail("has format version " + std::to_string(version) + ", this library reads version " +
            std::to_string(detail::cma_es_version));
  }
  CmaEsSearch search;
  detail::FieldReader reader(in);
  detail::transfer(reader, search);
  in.expect_checksum();
  in.expect_end();
  if (!detail::is_sound(search)) in.fail("holds a search whose sizes do not fit together");
  return search;
}

}  // namespace surefoot
