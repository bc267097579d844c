// One-step lookahead, the best action of a state: simulate candidate actions, add the value of where they lead.
// Q(s, a) = mean over noise of r + discount V(s'). The paper tries random actions (Algorithm 4); this one has two
// stages, roughly everywhere, then finely around the best, and lets all candidates meet the same noise, so that their
// differences have little variance. Cost: candidates * samples + refined * refined_samples transitions and values.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "surefoot/core/problem.hpp"
#include "surefoot/core/rng.hpp"
#include "surefoot/solve/forest_policy.hpp"
#include "surefoot/solve/rfpi_options.hpp"

namespace surefoot {

/// The values of states that something gives, a forest for instance, by their features; refers to it.
class ValueFunction {
 public:
  /// `source` has empty() and predict(rows of features, their number, where the values go), and outlives this.
  template <class Source>
  explicit ValueFunction(const Source& source)
      : source_(&source), empty_(source.empty()), predict_(&predict_by<Source>) {}

  bool empty() const { return empty_; }  // counts as 0 everywhere
  void predict(const float* rows, std::size_t count, double* out) const { predict_(source_, rows, count, out); }

 private:
  template <class Source>
  static void predict_by(const void* source, const float* rows, std::size_t count, double* out) {
    static_cast<const Source*>(source)->predict(rows, count, out);
  }

  const void* source_;
  bool empty_;
  void (*predict_)(const void* source, const float* rows, std::size_t count, double* out);
};

/// Looks ahead from one state after the other; holds its working memory, so use one per thread.
template <Problem P>
class Lookahead {
 public:
  using State = typename P::State;
  using Action = typename P::Action;

  struct Result {
    Action action;     // mean of the actions about as good as the best
    double value = 0;  // mean of their Q
  };

  /// `value`: see ValueFunction. `policy`: what is followed for options.follow transitions; null: nothing. Both outlive
  /// this.
  template <class Value>
  Lookahead(const P& problem, const Value& value, double discount, const LookaheadOptions& options,
            const ForestPolicy<P>* policy = nullptr)
      : problem_(problem),
        value_(value),
        policy_(policy),
        discount_(discount),
        options_(options),
        follow_(policy == nullptr ? 0 : options.follow),
        box_(problem.action_box()) {}

  /// `incumbent`: an action that is probably good, always tried; may be null.
  Result operator()(const State& state, const Action* incumbent, const Rng& rng) {
    Rng choice = rng.stream(0);
    first_candidates(incumbent, choice);
    evaluate(state, options_.samples, rng.stream(1));
    if (options_.refined > 0) {
      refine(choice);
      evaluate(state, options_.refined_samples, rng.stream(2));
    }
    return average_of_best();
  }

  /// Simulated transitions of one call.
  std::size_t transitions() const { return static_cast<std::size_t>(options_.hold + follow_) * values(); }

  /// Actions of the policy in one call.
  std::size_t policy_actions() const { return static_cast<std::size_t>(follow_) * values(); }

  /// Values looked up in one call.
  std::size_t values() const {
    return static_cast<std::size_t>(options_.candidates) * static_cast<std::size_t>(options_.samples) +
           static_cast<std::size_t>(options_.refined) * static_cast<std::size_t>(options_.refined_samples);
  }

 private:
  static constexpr int dims = P::action_dim;
  static constexpr std::uint32_t noise_dims = 8;  // draws per transition that are spread evenly; further ones are plain
  using Unit = Vec<dims>;                         // an action in half widths of the action box, from its centre

  Action to_action(const Unit& unit) const { return box_.center() + 0.5 * box_.width().cwiseProduct(unit); }

  void add(const Unit& unit) { candidates_.push_back(unit.cwiseMax(-1.0).cwiseMin(1.0)); }

  void first_candidates(const Action* incumbent, Rng& rng) {
    candidates_.clear();
    const auto wanted = static_cast<std::size_t>(options_.candidates);
    if (incumbent != nullptr) {
      Unit unit = 2 * (*incumbent - box_.center());
      for (int i = 0; i < dims; ++i) unit[i] = box_.width()[i] > 0 ? unit[i] / box_.width()[i] : 0;
      add(unit);
    }
    if (options_.corners && candidates_.size() < wanted) {
      add(Unit::Zero());
      constexpr std::uint32_t corners = 1U << std::min(dims, 16);
      for (std::uint32_t i = 0; i < corners && candidates_.size() < wanted; ++i) {
        const std::uint32_t corner = corners <= 8 ? i : rng.below(corners);
        Unit unit;
        for (int d = 0; d < dims; ++d) unit[d] = (corner >> (d % 16)) & 1U ? 1 : -1;
        add(unit);
        if (candidates_.size() + 2 > wanted && corners > 8) break;  // many dimensions: leave room for others
      }
    }
    const double reach = options_.corners ? 1.2 : 1.0;  // beyond the box, so that its faces are met
    while (candidates_.size() < wanted) {
      Unit unit;
      for (int d = 0; d < dims; ++d) unit[d] = rng.uniform(-reach, reach);
      add(unit);
    }
  }

  /// Keeps the best candidates and adds new ones near and between them.
  void refine(Rng& rng) {
    order_.resize(candidates_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::ranges::sort(order_, [this](std::size_t a, std::size_t b) { return q_[a] != q_[b] ? q_[a] > q_[b] : a < b; });
    const std::size_t kept =
        std::min({static_cast<std::size_t>(options_.kept), static_cast<std::size_t>(options_.refined), order_.size()});
    std::vector<Unit>& best = scratch_;
    best.clear();
    for (std::size_t i = 0; i < kept; ++i) best.push_back(candidates_[order_[i]]);
    candidates_ = best;
    const auto few = static_cast<std::uint32_t>(std::min<std::size_t>(kept, 3));
    for (std::uint32_t parent = 0; candidates_.size() < static_cast<std::size_t>(options_.refined); ++parent) {
      const Unit& from = best[parent % few];
      if (rng.uniform() < 0.4) {  // on the way to another of the best
        const Unit& to = best[rng.below(static_cast<std::uint32_t>(kept))];
        add(from + rng.uniform() * (to - from));
      } else {  // a bell-shaped step (sum of three uniform draws)
        Unit unit = from;
        for (int d = 0; d < dims; ++d) {
          unit[d] += options_.step * (rng.uniform() + rng.uniform() + rng.uniform() - 1.5);
        }
        add(unit);
      }
    }
  }

  void evaluate(const State& state, int samples, const Rng& rng) {
    const auto count = static_cast<std::size_t>(samples);
    constexpr int width = feature_dim<P>();
    noise_.clear();
    if (options_.common_noise) {
      Rng slices = rng.stream(count);
      draws_ = latin_hypercube(static_cast<std::uint32_t>(samples), noise_dims, slices);
      for (std::size_t m = 0; m < count; ++m) {
        noise_.push_back(rng.stream(m).with_draws(std::span(draws_).subspan(m * noise_dims, noise_dims)));
      }
    }
    const double last_discount = std::pow(discount_, options_.hold + follow_);
    values_.resize(candidates_.size() * count);
    rewards_.resize(values_.size());
    living_.clear();
    at_.clear();
    streams_.clear();
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Action action = to_action(candidates_[c]);
      for (std::size_t m = 0; m < count; ++m) {
        Rng noise = options_.common_noise ? noise_[m] : rng.stream(c * count + m);
        Step<State> step = problem_.step(state, action, noise);
        double sum = step.reward;
        double weight = discount_;
        for (int held = 1; held < options_.hold && !step.terminal; ++held) {
          step = problem_.step(State(step.next), action, noise);
          sum += weight * step.reward;
          weight *= discount_;
        }
        rewards_[c * count + m] = sum;
        if (step.terminal) continue;
        living_.push_back(c * count + m);
        at_.push_back(step.next);
        streams_.push_back(noise);
      }
    }
    follow_policy();
    const std::size_t living = living_.size();
    rows_.resize(living * width);
    for (std::size_t i = 0; i < living; ++i) {
      Eigen::Map<Eigen::Matrix<float, width, 1>>(rows_.data() + i * width) =
          features(problem_, at_[i]).template cast<float>();
    }
    if (value_.empty()) {
      std::fill_n(values_.begin(), living, 0.0);
    } else {
      value_.predict(rows_.data(), living, values_.data());
    }
    for (std::size_t i = 0; i < living; ++i) rewards_[living_[i]] += last_discount * values_[i];
    q_.resize(candidates_.size());
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      q_[c] = std::accumulate(rewards_.begin() + static_cast<std::ptrdiff_t>(c * count),
                              rewards_.begin() + static_cast<std::ptrdiff_t>((c + 1) * count), 0.0) /
              samples;
      if (!std::isfinite(q_[c])) {
        throw SolveError("lookahead: a transition gave a reward or a state that is not finite: validate() tells where");
      }
    }
  }

  /// Continues every candidate's run by the policy's actions.
  void follow_policy() {
    double weight = std::pow(discount_, options_.hold);
    for (int t = 0; t < follow_ && !at_.empty(); ++t, weight *= discount_) {
      const std::vector<Action> actions = policy_->act(std::span<const State>(at_));
      std::size_t kept = 0;
      for (std::size_t i = 0; i < at_.size(); ++i) {
        const Step<State> step = problem_.step(at_[i], actions[i], streams_[i]);
        rewards_[living_[i]] += weight * step.reward;
        if (step.terminal) continue;
        living_[kept] = living_[i];
        streams_[kept] = streams_[i];
        at_[kept++] = step.next;
      }
      living_.resize(kept);
      streams_.resize(kept, Rng(0));
      at_.resize(kept);
    }
  }

  Result average_of_best() {
    const auto best = static_cast<std::size_t>(std::ranges::max_element(q_) - q_.begin());
    std::vector<double>& sorted = values_;
    sorted = q_;
    std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
    const double scale = options_.softness * (q_[best] - sorted[sorted.size() / 2]);
    if (!(scale > 0)) return {to_action(candidates_[best]), q_[best]};
    Unit mean = Unit::Zero();
    double value = 0;
    double total = 0;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Unit offset = candidates_[c] - candidates_[best];
      if (offset.squaredNorm() > dims * options_.radius * options_.radius) continue;
      const double weight = std::exp((q_[c] - q_[best]) / scale);
      mean += weight * candidates_[c];
      value += weight * q_[c];
      total += weight;
    }
    return {to_action(mean / total), value / total};
  }

  const P& problem_;
  ValueFunction value_;
  const ForestPolicy<P>* policy_;
  double discount_;
  const LookaheadOptions& options_;
  int follow_;
  Box<P::action_dim> box_;
  std::vector<Unit> candidates_, scratch_;
  std::vector<double> q_, rewards_, values_, draws_;
  std::vector<float> rows_;
  std::vector<std::size_t> order_, living_;
  std::vector<Rng> noise_, streams_;
  std::vector<State> at_;  // where living runs are
};

}  // namespace surefoot
