// The state of RFPI between two iterations, and the checkpoint file that holds it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/problem.hpp"
#include "surefoot/forest/forest.hpp"
#include "surefoot/forest/leaf.hpp"
#include "surefoot/forest/serialize.hpp"
#include "surefoot/solve/action_leaf.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi_options.hpp"
#include "surefoot/solve/rfpi_work.hpp"
#include "surefoot/solve/value_forest.hpp"

namespace surefoot {

/// States with what was found out about them: column i of each belongs together.
template <Problem P>
struct StateSamples {
  std::vector<typename P::State> states;
  std::vector<double> values;
  std::vector<typename P::Action> actions;

  std::size_t size() const { return states.size(); }
};

template <Problem P>
struct RfpiState {
  static constexpr int inputs = feature_dim<P>();
  // Linear leaves learn values from fewer samples; the paper's constant ones are what ValueMethod::rollouts uses.
  using LinearValue = ValueForest<inputs>;
  using ConstantValue = Forest<inputs, 1, ConstantLeaf>;
  using ActionForest = typename ForestPolicy<P>::ActionForest;

  int iteration = 0;
  RfpiWork work;
  StateSamples<P> samples;   // of the last iteration
  StateSamples<P> previous;  // of the one before
  LinearValue value;
  ActionForest policy;  // empty: none yet
  double cost = 0;      // of that policy over the evaluation runs
  double length = 0;    // of its evaluation runs, mean [transitions]
  int transient = 0;    // of those, see transient_of() [transitions]
  int leaves = 0;       // per tree, the size of policy that did best; 0: none yet
  bool follows = false;  // whether lookaheads follow the policy
  OpinionsOf opinions = OpinionsOf::distances;  // of the policy's leaves, the kind that did best
  ActionForest best_policy;
  double best_cost = 0;
  int worse = 0;  // iterations in a row that gave a clearly worse policy than the best
  std::vector<RfpiProgress> history;
};

namespace detail {

constexpr FileFormat checkpoint_format{"SURERFPI", 6, "a checkpoint of RFPI"};
constexpr FileFormat first_checkpoint_format{"SURERFPI", 1, "a checkpoint of RFPI"};  // no trend, no sizes

template <class Vector>
void write_vectors(ByteWriter& out, const std::vector<Vector>& vectors) {
  out.u64(vectors.size());
  for (const Vector& v : vectors) out.words(std::span<const double>(v.data(), static_cast<std::size_t>(v.size())));
}

template <class Vector>
std::vector<Vector> read_vectors(ByteReader& in) {
  const std::uint64_t count = in.u64();
  std::vector<double> numbers;
  constexpr auto dims = static_cast<std::uint64_t>(Vector::RowsAtCompileTime);
  if (count > in.remaining() / 8 / dims) in.fail("ends too early");
  in.words(numbers, static_cast<std::size_t>(count * dims));
  std::vector<Vector> vectors(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < vectors.size(); ++i) std::copy_n(numbers.data() + i * dims, dims, vectors[i].data());
  return vectors;
}

template <Problem P>
void write_samples(ByteWriter& out, const StateSamples<P>& samples) {
  write_vectors(out, samples.states);
  out.list(samples.values);
  write_vectors(out, samples.actions);
}

template <Problem P>
StateSamples<P> read_samples(ByteReader& in) {
  StateSamples<P> samples;
  samples.states = read_vectors<typename P::State>(in);
  samples.values = in.list<double>();
  samples.actions = read_vectors<typename P::Action>(in);
  if (samples.values.size() != samples.size() || samples.actions.size() != samples.size()) {
    in.fail("is damaged: its samples have different numbers of states, values and actions");
  }
  return samples;
}

template <class F>
void write_optional(ByteWriter& out, const F& forest) {
  out.u8(forest.empty() ? 0 : 1);
  if (!forest.empty()) write(out, forest);
}

template <class F>
F read_optional(ByteReader& in) {
  return in.u8() == 0 ? F() : read<F>(in);
}

template <int Inputs>
void write_value(ByteWriter& out, const ValueForest<Inputs>& value) {
  out.list(std::vector<double>(value.trend.parameters().begin(), value.trend.parameters().end()));
  write_optional(out, value.forest);
}

template <int Inputs>
ValueForest<Inputs> read_value(ByteReader& in, bool has_trend) {
  ValueForest<Inputs> value;
  std::vector<double> numbers;
  if (has_trend) numbers = in.list<double>();
  if (!numbers.empty() && numbers.size() != QuadraticTrend::count_of_parameters(Inputs)) {
    in.fail("is damaged: its trend has " + std::to_string(numbers.size()) + " numbers");
  }
  value.trend = QuadraticTrend(std::move(numbers), Inputs);
  value.forest = read_optional<Forest<Inputs, 1, LinearLeaf>>(in);
  return value;
}

}  // namespace detail

/// `fingerprint` names everything the run depends on (options, seed, problem); a resume must have the same.
template <Problem P>
void save_checkpoint(const std::string& path, std::uint64_t fingerprint, const RfpiState<P>& state) {
  ByteWriter out;
  write_format(out, detail::checkpoint_format);
  out.u64(fingerprint);
  out.u32(static_cast<std::uint32_t>(state.iteration));
  out.u64(state.work.steps);
  out.u64(state.work.lookups);
  out.u64(state.work.fits);
  detail::write_samples(out, state.samples);
  detail::write_samples(out, state.previous);
  detail::write_value(out, state.value);
  detail::write_optional(out, state.policy);
  out.f64(state.cost);
  out.f64(state.length);
  out.u32(static_cast<std::uint32_t>(state.transient));
  out.u32(static_cast<std::uint32_t>(state.leaves));
  out.u8(state.follows ? 1 : 0);
  out.u8(state.opinions == OpinionsOf::actions ? 1 : 0);
  detail::write_optional(out, state.best_policy);
  out.f64(state.best_cost);
  out.u32(static_cast<std::uint32_t>(state.worse));
  out.u64(state.history.size());
  for (const RfpiProgress& p : state.history) {
    out.u32(static_cast<std::uint32_t>(p.iteration));
    for (const double number : {p.seconds, p.cpu_seconds, p.counted_seconds, p.cost, p.best_cost}) out.f64(number);
    out.u64(p.states);
    out.u64(p.leaves);
  }
  out.add_checksum();
  write_file_atomically(path, out.bytes());
}

/// From the bytes of the checkpoint file `path`. Throws SolveError if it belongs to another run, CoreError or
/// ForestError if it is damaged.
template <Problem P>
RfpiState<P> load_checkpoint(std::span<const std::byte> bytes, const std::string& path, std::uint64_t fingerprint) {
  ByteReader in(bytes, "checkpoint " + path);
  const bool first = has_format(in, detail::first_checkpoint_format);
  expect_format(in, first ? detail::first_checkpoint_format : detail::checkpoint_format);
  if (in.u64() != fingerprint) {
    throw SolveError(in.source() +
                     " belongs to a run with another problem, other options or another seed: "
                     "resume with the same ones, or remove it to start anew");
  }
  RfpiState<P> state;
  const std::uint32_t iteration = in.u32();
  if (iteration > 1'000'000'000U) in.fail("is damaged: no run has " + std::to_string(iteration) + " iterations");
  state.iteration = static_cast<int>(iteration);
  state.work.steps = in.u64();
  state.work.lookups = in.u64();
  state.work.fits = in.u64();
  state.samples = detail::read_samples<P>(in);
  state.previous = detail::read_samples<P>(in);
  state.value = detail::read_value<RfpiState<P>::inputs>(in, !first);
  state.policy = detail::read_optional<typename RfpiState<P>::ActionForest>(in);
  if (!first) {
    state.cost = in.f64();
    state.length = in.f64();
    state.transient = static_cast<int>(in.u32() & 0x7FFFFFFFU);
    state.leaves = static_cast<int>(in.u32() & 0x7FFFFFFFU);
    state.follows = in.u8() != 0;
    state.opinions = in.u8() != 0 ? OpinionsOf::actions : OpinionsOf::distances;
  }
  state.best_policy = detail::read_optional<typename RfpiState<P>::ActionForest>(in);
  state.best_cost = in.f64();
  if (!first) state.worse = static_cast<int>(in.u32() & 0x7FFFFFFFU);
  const std::uint64_t entries = in.u64();
  if (entries > in.remaining() / 60) in.fail("ends too early");
  for (std::uint64_t i = 0; i < entries; ++i) {
    RfpiProgress p;
    p.iteration = static_cast<int>(in.u32());
    for (double* number : {&p.seconds, &p.cpu_seconds, &p.counted_seconds, &p.cost, &p.best_cost}) *number = in.f64();
    p.states = static_cast<std::size_t>(in.u64());
    p.leaves = static_cast<std::size_t>(in.u64());
    state.history.push_back(p);
  }
  in.expect_checksum();
  in.expect_end();
  return state;
}

template <Problem P>
RfpiState<P> load_checkpoint(const std::string& path, std::uint64_t fingerprint) {
  return load_checkpoint<P>(read_file(path), path, fingerprint);
}

}  // namespace surefoot
