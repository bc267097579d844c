#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "machines/draw_case.hpp"
#include "machines/equivalents.hpp"
#include "machines/free_start.hpp"
#include "machines/laws.hpp"
#include "plants/calibrate.hpp"
#include "plants/systems.hpp"

namespace {

using machines::Law;
using machines::Where;
using plants::Kind;

const std::vector<std::string> families{"chain", "drive", "tanks", "heater", "lift", "rover"};

std::string content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

machines::Drawn drawn(std::uint64_t seed, const std::string& family, Kind kind) {
  plants::Random random(seed);
  return machines::draw_case(random, {}, family, kind);
}

/// A mass on a spring and a damper, pushed, its position measured.
machines::Draft oscillator() {
  machines::Draft draft;
  machines::Machine& machine = draft.machine;
  machine.family = "chain";
  machine.inputs = {{"push", "push_N", "N", 1}};
  machine.states = {{"x", "v", "m"}, {"v", "(push - c*v - k*x)/m", "m/s", "0", "m", "N", 0, true, "push"}};
  machine.outputs = {{"x_m", "x", "m", 0}};
  machine.parameters = {{"m", "kg", 2, 2.2, 0.1, 50}, {"k", "N/m", 80, 70, 1, 1e4}, {"c", "N s/m", 5, 6, 0.1, 500}};
  machine.period = 0.02, machine.time_scale = 1;
  draft.middle = {0}, draft.swing = {10}, draft.duration = 8;
  return draft;
}

machines::Drawn with_effect(const machines::Hidden& hidden) {
  const machines::Draft draft = oscillator();
  plants::Random random(3);
  machines::Drawn result;
  result.machine = std::make_shared<const machines::CompiledMachine>(draft.machine);
  result.one.system = machines::system_of(random, draft, result.machine);
  result.one.system.noise = {1e-3};
  result.hidden = {hidden};
  for (plants::Recording& recording : result.one.system.recordings)
    recording.outliers = {std::vector<bool>(recording.time.size(), false)};
  return result;
}

machines::Hidden effect(const std::string& name, const std::string& place, Where where, Law law, int target, double a) {
  machines::Hidden hidden;
  hidden.name = name, hidden.attached_to = place, hidden.where = where, hidden.law = law;
  hidden.target = target, hidden.a = a;
  return hidden;
}

}  // namespace

TEST_CASE("the same seed gives the same files") {
  const auto folder = std::filesystem::temp_directory_path() / "surefoot_blind_machines";
  std::filesystem::remove_all(folder);
  for (const char* run : {"first", "second"}) {
    machines::Drawn one = drawn(11, "tanks", Kind::one);
    one.one.name = "case";
    plants::write_case(one.one, folder / run);
    plants::write_truth(one.one, folder / run / "truth.json");
  }
  for (const char* file : {"case/model.toml", "case/rec_01.csv", "truth.json"}) {
    CHECK(content(folder / "first" / file).size() > 100);
    CHECK(content(folder / "first" / file) == content(folder / "second" / file));
  }
  std::filesystem::remove_all(folder);
}

TEST_CASE("machines of every family run from their own formulas, most of them to finite readings") {
  for (const bool examination : {false, true})
    for (const std::string& family : families) {
      int sound = 0;
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        plants::Random random(seed);
        const machines::Draft draft = machines::draw_machine(random, {.examination = examination}, family);
        const machines::CompiledMachine machine(draft.machine);
        std::vector<plants::Recording> recordings = machines::draw_recordings(random, draft);
        CHECK(recordings.size() >= 4);
        CHECK(recordings.size() <= 12);
        recordings.resize(2);
        const machines::Sizes sizes = machines::measure(machine, recordings);
        sound += std::ranges::all_of(sizes.outputs, [](const auto& size) { return std::isfinite(size.rms); }) ? 1 : 0;
      }
      CAPTURE(family);
      CHECK(sound >= 7);
    }
}

TEST_CASE("every effect can be drawn at every place, and development draws nothing that is kept for examinations") {
  plants::Random random(5);
  for (int i = 0; i < 60; ++i) {
    const machines::Draft draft = machines::draw_machine(random, {}, families[static_cast<std::size_t>(i) % 6]);
    CHECK(draft.machine.title.rfind("3 ", 0) != 0);
    CHECK(draft.machine.title.find("integral") == std::string::npos);
    CHECK(draft.machine.title.find("on/off") == std::string::npos);
    machines::Sizes sizes;
    sizes.states.assign(draft.machine.states.size(), {1, 1, 2, 1, -2, 2});
    sizes.inputs.assign(draft.machine.inputs.size(), {1, 1, 2, 1, -2, 2});
    sizes.signals.assign(draft.machine.signals.size(), {1, 1, 2, 1, -2, 2});
    sizes.outputs.assign(draft.machine.outputs.size(), {1, 1, 2, 1, -2, 2});
    sizes.forces.assign(draft.machine.states.size(), 1), sizes.duration = 10;
    const std::vector<double> noise(draft.machine.outputs.size(), 0.01);
    auto all = machines::named_candidates(draft.machine);
    const auto outside = machines::outside_candidates(draft.machine);
    all.insert(all.end(), outside.begin(), outside.end());
    for (const machines::Candidate& candidate : all) {
      if (!machines::is_open({}, candidate)) continue;
      const machines::Hidden one = machines::draw_hidden(random, {}, draft.machine, sizes, candidate, noise);
      CHECK(one.a != 0);
      CHECK(!one.attached_to.empty());
      for (const Law own :
           {Law::rational_dry, Law::stribeck_lorentz, Law::tangent_spring, Law::two_wave_cogging, Law::raised_hole,
            Law::tanh_clip, Law::fourth_lag, Law::passing_drift, Law::heat_fade, Law::radiation, Law::ageing})
        CHECK(one.law != own);
    }
  }
}

TEST_CASE("the true model, fitted from the truth, is left with the noise alone") {
  for (const auto& [family, kind] : {std::pair{"drive", Kind::one}, {"heater", Kind::two}, {"lift", Kind::outside}}) {
    const machines::Drawn one = drawn(21, family, kind);
    const plants::System& system = one.one.system;
    const plants::Values fitted = plants::calibrate_from(system, plants::actual_values(system), one.one.faults,
                                                         system.recordings, {5, false, false, nullptr});
    const double error = plants::root_mean_square(
        plants::residuals(system, fitted, one.one.faults, system.recordings, {10, false, false, nullptr}));
    CAPTURE(family);
    CHECK(error > 0.8);
    CHECK(error < 1.15);
    CHECK(one.one.strength() >= machines::Visible{}.held_out);
  }
}

TEST_CASE("a delay of the only input is that of the only sensor, and friction is no dead zone") {
  const auto delay =
      machines::equivalents(with_effect(effect("input_delay", "push", Where::input, Law::delay, 0, 0.06)), 0);
  CHECK(std::ranges::find(delay, std::pair<std::string, std::string>("sensor_delay", "x_m")) != delay.end());
  const auto friction =
      machines::equivalents(with_effect(effect("coulomb_friction", "v", Where::speed, Law::bristles, 1, 1.5)), 0);
  CHECK(friction.empty());
}

TEST_CASE("an asymmetry is a gain while the input goes one way alone") {
  machines::Drawn one = with_effect(effect("input_asymmetry", "push", Where::input, Law::asymmetry, 0, 0.2));
  const std::pair<std::string, std::string> gain("input_gain", "push");
  const auto both_ways = machines::equivalents(one, 0);
  CHECK(std::ranges::find(both_ways, gain) == both_ways.end());
  for (plants::Recording& recording : one.one.system.recordings)
    for (double& push : recording.inputs[0]) push = std::abs(push);
  const auto one_way = machines::equivalents(one, 0);
  CHECK(std::ranges::find(one_way, gain) != one_way.end());
}

TEST_CASE("friction that hardly rises near rest is that of Coulomb") {
  machines::Hidden stribeck = effect("stribeck_friction", "v", Where::speed, Law::stribeck_gauss, 1, 1.5);
  const std::pair<std::string, std::string> coulomb("coulomb_friction", "v");
  for (const bool rises : {false, true}) {
    stribeck.b = rises ? 2 : 1e-4, stribeck.c = 0.1;
    const auto found = machines::equivalents(with_effect(stribeck), 0);
    CHECK((std::ranges::find(found, coulomb) == found.end()) == rises);
  }
}

TEST_CASE("a gain of one wheel is the inverse gain of the other, where radius and base are not known") {
  plants::Random random(8);
  machines::Draft draft = machines::draw_rover(random, {});
  for (plants::Parameter& parameter : draft.machine.parameters) parameter.fixed = false;
  machines::Drawn one;
  one.machine = std::make_shared<const machines::CompiledMachine>(draft.machine);
  one.one.system = machines::system_of(random, draft, one.machine);
  one.one.system.noise = {0.01, 0.01, 0.01};
  for (plants::Recording& recording : one.one.system.recordings)
    recording.outliers.assign(3, std::vector<bool>(recording.time.size(), false));
  one.hidden = {effect("input_gain", "right", Where::input, Law::gain, 1, 0.3)};
  const auto found = machines::equivalents(one, 0);
  CHECK(std::ranges::find(found, std::pair<std::string, std::string>("input_gain", "left")) != found.end());
}

TEST_CASE("initial values that the model file leaves free are those of the readings") {
  machines::Draft draft = oscillator();
  draft.machine.states[0].initial = "free";
  const machines::CompiledMachine machine(draft.machine);
  plants::Random random(4);
  plants::Recording recording = machines::draw_recordings(random, draft)[0];
  recording.initial = {0.07, 0};
  const plants::Values actual{2, 80, 5};
  recording.readings = machines::simulate(machine, actual, {}, recording, {4, false, false, nullptr}).outputs;
  recording.outliers = {std::vector<bool>(recording.time.size(), false)};
  recording.initial = {0.01, 0};
  const auto found =
      machines::simulate_as_user(machine, actual, {}, recording, {4, false, false, nullptr, true}, {1e-3});
  CHECK(found.states[0][0] == doctest::Approx(0.07).epsilon(1e-6));
  CHECK(found.outputs[0].back() == doctest::Approx(recording.readings[0].back()).epsilon(1e-6));
}

TEST_CASE("a lagged or limited input is as late as its law says, and no step later") {
  constexpr double step = 0.1, slope = 2;
  plants::Column times, ramp;
  for (int i = 0; i < 400; ++i) times.push_back(step * i), ramp.push_back(slope * step * (i + 0.5));
  struct Expected {
    Law law;
    double a, value;
  };
  const double middle = times[300] + 0.5 * step;
  for (const auto& [law, a, value] :
       {Expected{Law::lag, 1.5, slope * (middle - 1.5)}, Expected{Law::second_lag, 1.5, slope * (middle - 1.5)},
        Expected{Law::rate_limit, 1.2, 1.2 * (middle - times[1])}}) {
    plants::Column values = ramp;
    values[0] = 0;  // it rests until the second step
    machines::change_input(effect("", "push", Where::input, law, 0, a), times, values);
    CHECK(std::abs(values[300] - value) < 0.1 * slope * step);
  }
}

TEST_CASE("hidden physics does not depend on the steps that it is integrated with") {
  for (const Law law : {Law::load_bristles, Law::bristles, Law::rate_limit, Law::lag}) {
    const bool force = law == Law::load_bristles || law == Law::bristles;
    machines::Hidden hidden = effect("", force ? "v" : "push", force ? Where::speed : Where::input, law, force ? 1 : 0,
                                     law == Law::load_bristles ? 0.2
                                     : law == Law::lag         ? 0.05
                                                               : 2);
    hidden.b = 0, hidden.c = 1e-3;
    const machines::Drawn one = with_effect(hidden);
    const plants::Recording& recording = one.one.system.recordings[0];
    plants::Recording seen = recording;
    const auto run = [&](int steps) {
      return machines::simulate(*one.machine, {2, 80, 5}, one.hidden, seen, {steps, false, false, nullptr}).outputs[0];
    };
    const plants::Column coarse = run(10), fine = run(160);
    double apart = 0, size = 0;
    for (std::size_t i = 0; i < fine.size(); ++i) {
      apart += std::pow(coarse[i] - fine[i], 2), size += std::pow(fine[i], 2);
    }
    CAPTURE(static_cast<int>(law));
    CHECK(std::sqrt(apart / size) < 1e-3);
  }
}
