// Recordings of a drawn machine before it runs: when, and what is commanded.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "../plants/excitation.hpp"
#include "circle.hpp"
#include "grammar.hpp"

namespace machines {
namespace {

constexpr double least_rows = 4000, most_rows = 7000;  // of all recordings of a case together

enum class Waveform { steps, sine, sines, chirp, ramps, binary, pulses };

// From -1 to 1, or from 0 to 1 for pulses; `pace` [s]: time of a typical change.
Column shape(Random& random, const Column& times, Waveform form, double pace) {
  Column values;
  const double direction = random.sign(), phase = random.uniform(0, circle), other = random.uniform(0, circle);
  double level = 0, next = 0.3 * pace;
  for (double t : times) {
    if (t >= next) {
      const double before = level;
      level = form == Waveform::binary ? random.sign() : random.uniform(form == Waveform::pulses ? 0 : -1, 1);
      if (form == Waveform::pulses && before > 0) level = 0;
      next = t + pace * random.uniform(form == Waveform::binary ? 0.2 : 0.5, 1.5);
    }
    switch (form) {
      case Waveform::steps:
      case Waveform::binary:
      case Waveform::pulses:
        values.push_back(level);
        break;
      case Waveform::sine:
        values.push_back(direction * std::sin(circle * t / (1.5 * pace)));
        break;
      case Waveform::sines:
        values.push_back(0.5 * (std::sin(circle * t / pace + phase) - std::sin(phase)) +
                         0.5 * (std::sin(circle * t / (3.1 * pace) + other) - std::sin(other)));
        break;
      case Waveform::chirp:
        values.push_back(direction * std::sin(circle / pace * (0.2 * t + 0.04 * t * t / pace)));
        break;
      case Waveform::ramps:
        values.push_back(direction * std::asin(std::sin(circle * t / (3 * pace))) * 2 / std::numbers::pi);
        break;
    }
  }
  return values;
}

Column command(Random& random, const Column& times, const Input& input, double middle, double swing, double pace) {
  static const std::vector<Waveform> kinds{Waveform::steps, Waveform::sine,   Waveform::sines, Waveform::chirp,
                                           Waveform::ramps, Waveform::binary, Waveform::pulses};
  const double amplitude = swing * random.uniform(0.35, 1);
  Column values = shape(random, times, random.choice(kinds), pace * random.uniform(0.6, 2));
  const double step = std::pow(10, std::floor(std::log10(swing)) - 3);
  for (double& value : values) {
    value = plants::rounded(middle + amplitude * value, step);
    if (input.one_signed) value = std::max(value, 0.0);
  }
  return values;
}

}  // namespace

std::vector<Recording> draw_recordings(Random& random, const Draft& draft) {
  const Machine& machine = draft.machine;
  const std::size_t count = 4 + random.index(9);
  const bool jitter = random.chance(0.5);
  const double rows = random.uniform(least_rows, most_rows) / static_cast<double>(count);
  const double duration = std::min(draft.duration, rows * machine.period);
  std::vector<Recording> recordings;
  for (std::size_t i = 0; i < count; ++i) {
    Recording recording;
    char name[32];
    std::snprintf(name, sizeof name, "rec_%02zu.csv", i + 1);
    recording.name = name;
    for (const auto& [key, values] : draft.metas) recording.meta.emplace_back(key, random.choice(values));
    recording.time = plants::jittered_times(random, duration * random.uniform(0.8, 1.2), machine.period, jitter);
    for (std::size_t k = 0; k < machine.inputs.size(); ++k) {
      recording.inputs.push_back(
          command(random, recording.time, machine.inputs[k], draft.middle[k], draft.swing[k], machine.time_scale));
    }
    recording.initial = draft.initial;
    recording.initial.resize(machine.states.size(), 0.0);
    const double offset = random.uniform(-1, 1);  // one for all, so that no link is strained
    for (std::size_t k = 0; k < draft.initial_range.size(); ++k)
      recording.initial[k] += offset * draft.initial_range[k];
    if (draft.initial_meta >= 0)
      std::ranges::fill(recording.initial, recording.meta[static_cast<std::size_t>(draft.initial_meta)].second);
    recordings.push_back(recording);
  }
  return recordings;
}

}  // namespace machines
