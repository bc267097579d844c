// Units of an effect's parameters on one of the machines of the catalogue.
#pragma once

#include <cstdlib>
#include <string>

#include "surefoot/diagnose/effects/effect.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace catalogue {

/// Units of the sizes that measures are powers of, at one place of a machine.
struct PlaceUnits {
  std::string effort, value, position, time;
};

/// Of a velocity, state 0 is taken for its position.
inline PlaceUnits place_units(const surefoot::SimulatorInfo& info, surefoot::Place place, int at) {
  PlaceUnits units;
  units.time = info.kind == surefoot::SimulatorKind::map ? "step" : "s";
  const auto index = static_cast<std::size_t>(at);
  if (place == surefoot::Place::velocity) {
    units.value = info.states[index].unit;
    units.effort = info.states[index].effort_unit;
    units.position = info.states[0].unit;
  } else if (place == surefoot::Place::state) {
    units.value = info.states[index].unit;
    units.effort = units.value + "/s";
  } else if (place == surefoot::Place::input) {
    units.value = info.inputs[index].unit;
  } else if (place == surefoot::Place::output) {
    units.value = info.outputs[index].unit;
  } else if (place == surefoot::Place::planar) {
    units.value = "m";
    units.position = "rad";
  }
  return units;
}

/// "N m/(rad/s)" of effort / value: what a parameter of this measure is given in.
inline std::string unit_of(const surefoot::Measure& measure, const PlaceUnits& units) {
  std::string above, below;
  const auto append = [&](const std::string& unit, int power) {
    if (unit.empty() || unit == "1") return;
    for (int i = 0; i < std::abs(power); ++i) {
      std::string& side = power > 0 ? above : below;
      const bool compound = unit.find('/') != std::string::npos && power < 0;
      side += (side.empty() ? "" : " ") + (compound ? "(" + unit + ")" : unit);
    }
  };
  append(units.effort, measure.effort);
  append(units.value, measure.value + measure.rate);
  append(units.position, measure.position);
  append(units.time, measure.time - measure.rate);
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + "/" + (below.find(' ') != std::string::npos ? "(" + below + ")" : below);
}

}  // namespace catalogue
