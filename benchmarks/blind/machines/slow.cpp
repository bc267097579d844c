// Networks of tanks, and heated blocks with their sensors: seconds to hours.
#include <algorithm>
#include <cmath>

#include "grammar.hpp"

namespace machines {
namespace {

std::string number(std::size_t i) { return std::to_string(i + 1); }

double round_period(double period) { return period < 2 ? three_digits(period) : std::round(period); }

// How tanks are joined.
enum class Network { series, parallel, interacting };

class Tanks {
 public:
  Tanks(Random& random, const Grammar& grammar) : random_(random) {
    const bool own = grammar.draw_own(random);
    count_ = own ? 2 + random.index(2) : 1 + random.index(2);
    if (own)
      network_ = count_ == 3 && random.chance(0.4) ? Network::series
                 : random.chance(0.5)              ? Network::parallel
                                                   : Network::interacting;
    pumps_ = count_ > 1 && network_ != Network::parallel && random.chance(0.35) ? 2 : 1;
    centimetres_ = random.chance(0.5);
    level_ = random.log_uniform(0.08, 3) * (centimetres_ ? 100 : 1);
    time_ = random.log_uniform(8, 2500);
  }

  Draft draw() {
    Machine& machine = draft_.machine;
    machine.family = "tanks";
    machine.title = number(count_ - 1) + " tanks";
    machine.title += network_ == Network::series     ? ""
                     : network_ == Network::parallel ? " in parallel"
                                                     : " that interact";
    inflow_.assign(count_, ""), outflow_ = inflow_;
    draw_pumps();
    for (std::size_t i = 0; i < count_; ++i) draw_outlet(i);
    for (std::size_t i = 0; i < count_; ++i) draw_state(i);
    machine.time_scale = 0.6 * time_;
    machine.period = round_period(time_ / random_.uniform(25, 60));
    machine.at_rest = false;
    draft_.duration = time_ * random_.uniform(4, 10);
    return draft_;
  }

 private:
  std::string level(std::size_t i) const { return "h" + number(i); }
  std::string unit() const { return centimetres_ ? "cm" : "m"; }

  // Pumps fill the first tank, or the first two; one pump of a parallel network is split between all.
  void draw_pumps() {
    Machine& machine = draft_.machine;
    const double top = random_.choice(Values{1, 5, 10, 100});
    for (std::size_t k = 0; k < pumps_; ++k) {
      const std::string name = "pump" + (pumps_ > 1 ? number(k) : std::string());
      const bool volts = top == 5 || top == 10;
      machine.inputs.push_back({name,
                                name + (volts      ? "_V"
                                        : top == 1 ? "_1"
                                                   : "_pct"),
                                volts      ? "V"
                                : top == 1 ? "1"
                                           : "%",
                                0, true});
      draft_.middle.push_back(0.5 * top), draft_.swing.push_back(0.5 * top);
      const std::string gain = "gain" + (pumps_ > 1 ? number(k) : std::string());
      const double amount = level_ / time_ / top * random_.uniform(1.2, 2) / static_cast<double>(pumps_);
      machine.parameters.push_back(guess(random_, gain, unit() + "/s/" + machine.inputs[k].unit, amount));
      if (network_ == Network::parallel) {
        machine.constants.push_back({"split", three_digits(random_.uniform(0.35, 0.65))});
        inflow_[0] = " + split*" + gain + "*" + name;
        inflow_[1] = " + (1 - split)*" + gain + "*" + name;
      } else {
        inflow_[k] += " + " + gain + "*" + name;
      }
    }
  }

  void draw_outlet(std::size_t i) {
    Machine& machine = draft_.machine;
    const double coefficient = std::sqrt(level_) / time_ * random_.uniform(0.7, 1.3);
    const std::string outlet = "out" + number(i), flow = "flow" + number(i);
    const bool last = i + 1 == count_;
    machine.parameters.push_back(guess(random_, outlet, unit() + "^0.5/s", coefficient, random_.chance(0.1)));
    if (network_ == Network::interacting && !last) {
      machine.constants.push_back({"thin" + number(i), three_digits(1e-3 * level_)});
      const std::string difference = "(" + level(i) + " - " + level(i + 1) + ")";
      machine.signals.push_back(
          {flow, outlet + "*" + difference + "/sqrt(abs" + difference + " + thin" + number(i) + ")", unit() + "/s"});
    } else {
      machine.signals.push_back({flow, outlet + "*sqrt(max(" + level(i) + ", 0))", unit() + "/s"});
    }
    outflow_[i] = " - " + flow;
    if (network_ == Network::parallel && i < 2 && count_ == 3) {
      inflow_[2] += " + " + flow;  // both drain into the third
    } else if (network_ != Network::parallel && !last) {
      inflow_[i + 1] += " + " + flow;
    }
  }

  void draw_state(std::size_t i) {
    Machine& machine = draft_.machine;
    State state{level(i), inflow_[i].substr(3) + outflow_[i], unit()};
    state.is_amount = true;
    const bool measured = i + 1 == count_ || random_.chance(0.6);
    state.initial = measured ? "column:" + level(i) + "_" + unit() : "free";
    machine.states.push_back(state);
    if (measured) machine.outputs.push_back({level(i) + "_" + unit(), level(i), unit(), static_cast<int>(i)});
    const double start = random_.uniform(0.15, 0.5) * level_;
    draft_.initial.push_back(start), draft_.initial_range.push_back(0.5 * start);
  }

  Random& random_;
  std::size_t count_ = 1, pumps_ = 1;
  Network network_ = Network::series;
  bool centimetres_ = false;
  double level_ = 1, time_ = 100;
  std::vector<std::string> inflow_, outflow_;
  Draft draft_;
};

}  // namespace

Draft draw_tanks(Random& random, const Grammar& grammar) { return Tanks(random, grammar).draw(); }

// Block, sometimes a second one, sometimes a sensor that follows it.
Draft draw_heater(Random& random, const Grammar& grammar) {
  Draft draft;
  Machine& machine = draft.machine;
  machine.family = "heater";
  const std::size_t blocks = grammar.draw_own(random) ? 2 : 1;
  const bool sensor = blocks == 2 || random.chance(0.5);
  machine.title = std::to_string(blocks) + " heated blocks" + (sensor ? " with a sensor" : "");
  const double time = random.log_uniform(40, 6000), rise = random.uniform(20, 120), power = random.log_uniform(1, 3000);
  const double loss = power / rise, capacity = loss * time;
  machine.inputs = {{"heat", "heat_W", "W", 0, true}};
  draft.middle = {0.5 * power}, draft.swing = {0.5 * power};
  machine.constants = {{"ambient", 0, "ambient_degC"}};
  draft.metas = {{"ambient_degC", {three_digits(random.uniform(5, 18)), three_digits(random.uniform(19, 35))}}};
  machine.parameters = {guess(random, "capacity", "J/K", capacity, random.chance(0.3)),
                        guess(random, "loss", "W/K", loss)};
  std::string rate = "(heat - loss*(T1 - ambient)";
  if (blocks == 2) {
    machine.parameters.push_back(guess(random, "bridge", "W/K", loss * random.uniform(0.8, 3)));
    machine.parameters.push_back(guess(random, "capacity2", "J/K", capacity * random.uniform(0.3, 0.8)));
    rate += " - bridge*(T1 - T2)";
  }
  const bool first_seen = !sensor || random.chance(0.4);
  machine.states.push_back({"T1", rate + ")/capacity", "C", first_seen ? "column:T1_degC" : "ambient"});
  if (blocks == 2) machine.states.push_back({"T2", "bridge*(T1 - T2)/capacity2", "C", "ambient"});
  if (sensor) {
    machine.parameters.push_back(guess(random, "sensor_time", "s", time * random.uniform(0.05, 0.3)));
    const std::string source = blocks == 2 ? "T2" : "T1";
    machine.states.push_back({"Ts", "(" + source + " - Ts)/sensor_time", "C", "column:Ts_degC"});
    machine.outputs.push_back({"Ts_degC", "Ts", "C", static_cast<int>(machine.states.size()) - 1});
  }
  if (first_seen) machine.outputs.push_back({"T1_degC", "T1", "C", 0});
  for (std::size_t i = 0; i < blocks; ++i) machine.states[i].is_amount = true;
  machine.time_scale = 0.6 * time;
  machine.period = round_period(time / random.uniform(25, 60));
  draft.initial_meta = 0;
  draft.duration = time * random.uniform(3, 8);
  return draft;
}

}  // namespace machines
