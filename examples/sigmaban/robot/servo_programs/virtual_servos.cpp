// virtual_servos: servos behind a pseudo-terminal, for programs that want some. Runs until Ctrl-C.
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "../../../../apps/common/command.hpp"
#include "../bus/realtime.hpp"
#include "../virtual_bus/virtual_bus.hpp"
#include "../walk/stop_signals.hpp"
#include "servo_ids.hpp"

namespace {

using namespace dynamixel;

struct Options {
  std::string link;
  std::string ids = "1-20";
  int protocol = 2;
  std::vector<std::string> models;
  bool new_ones = false;
  std::string silent;
  double silent_from_s = 0, silent_to_s = 1e9;
  std::string hot;
  double voltage_v = 0;
  double return_delay_us = 0;
  int status_return_level = 2;
  std::string reboot, overload, cut;
  double then_s = 5, voltage_then_v = 0;
  bool hang_up = false;
  AnswererOptions answerer;
};

/// A symbolic link that goes away with this. An old link is replaced, anything else is left alone.
class PortLink {
 public:
  PortLink(std::string link, const std::string& target) : link_(std::move(link)) {
    if (link_.empty()) return;
    std::error_code error;
    if (std::filesystem::is_symlink(link_, error)) std::filesystem::remove(link_, error);
    std::filesystem::create_symlink(target, link_, error);
    if (!error) return;
    const std::string name = std::exchange(link_, "");
    throw example::UsageError(name + ": the link cannot be made (" + error.message() + "); give another --port-link");
  }
  ~PortLink() {
    std::error_code ignored;
    if (!link_.empty()) std::filesystem::remove(link_, ignored);
  }
  PortLink(const PortLink&) = delete;
  PortLink& operator=(const PortLink&) = delete;

 private:
  std::string link_;
};

template <class Action>
void each(const std::string& ids, Action action) {
  if (!ids.empty()) std::ranges::for_each(example::parse_ids(ids), action);
}

/// What is so from the start.
template <class Protocol>
void set_up(Answerer<Protocol>& answerer, const Options& options) {
  if (options.voltage_v > 0) answerer.set_voltage(options.voltage_v);
  each(options.hot, [&](std::uint8_t id) { answerer.servo(id).temperature_celsius = 90; });
  each(options.ids, [&](std::uint8_t id) {
    const double counts = options.return_delay_us * 1e-6 / return_delay_s;
    answerer.servo(id).set("return_delay_time", options.new_ones ? 250 : static_cast<std::int64_t>(counts));
    answerer.servo(id).set("status_return_level", options.status_return_level);
  });
}

/// What happens later, once.
template <class Protocol>
void happen(VirtualBus<Protocol>& bus, const Options& options) {
  bus.with([&](auto& answerer) {
    each(options.reboot, [&](std::uint8_t id) { answerer.reboot(id, PseudoTerminal::now()); });
    each(options.overload, [&](std::uint8_t id) { answerer.servo(id).shut_down(protocol2::overload_error); });
    each(options.cut, [&](std::uint8_t id) { answerer.servo(id).deaf = true; });
    if (options.voltage_then_v > 0) answerer.set_voltage(options.voltage_then_v);
  });
  if (options.hang_up) bus.hang_up();
}

template <class Protocol>
void print_counts(const Answerer<Protocol>& answerer) {
  const FaultCounts& counts = answerer.counts();
  std::cout << answerer.instructions() << " instructions; faults made: " << counts.lost << " lost, " << counts.corrupted
            << " corrupted, " << counts.late << " late, " << counts.duplicated << " duplicated, " << counts.wrong_id
            << " wrong id, " << counts.silent << " silent\n";
  std::size_t on = 0, held = 0;
  for (const VirtualServo& servo : answerer.servos()) {
    on += servo.torque_on() ? 1U : 0U;
    held += servo.torque_on() && servo.watchdog_tripped() ? 1U : 0U;
  }
  std::cout << on << " of " << answerer.servos().size() << " servos have their torque on, " << held
            << " of them stopped by their bus watchdog\n";
}

/// Of the servo with that number among all.
const ServoModel& model_of(const Options& options, std::size_t number) {
  if (options.models.empty()) return options.protocol == 1 ? mx_64_protocol_1 : mx_64_protocol_2;
  const std::string& name = options.models[number % options.models.size()];
  const ServoModel* model = find_model(name);
  if (model == nullptr || model->protocol != options.protocol) {
    throw example::UsageError("--model " + name + ": there is none of that name with this --protocol");
  }
  return *model;
}

template <class Protocol>
void serve(const Options& options) {
  sigmaban::StopSignals signals;
  signals.no_more_deadlines();
  std::vector<VirtualServo> servos;
  for (const std::uint8_t id : example::parse_ids(options.ids))
    servos.emplace_back(model_of(options, servos.size()), id);
  ask_for_realtime();
  VirtualBus<Protocol> bus{Answerer<Protocol>(servos, options.answerer)};
  const PortLink link(options.link, bus.path());
  std::cout << bus.path() << '\n' << std::flush;

  bus.with([&](auto& answerer) { set_up(answerer, options); });
  const Time begin = PseudoTerminal::now();
  for (bool happened = false; !signals.requested();) {
    const double now_s = to_seconds(PseudoTerminal::now() - begin);
    const bool silent = now_s >= options.silent_from_s && now_s < options.silent_to_s;
    bus.with([&](auto& answerer) { each(options.silent, [&](std::uint8_t id) { answerer.set_silent(id, silent); }); });
    if (!happened && now_s >= options.then_s) {
      happen(bus, options);
      happened = true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  bus.with([](const auto& answerer) { print_counts(answerer); });
}

}  // namespace

int main(int argc, char** argv) {
  example::Command program{"Servos behind a pseudo-terminal, until Ctrl-C; prints its name", "virtual_servos"};
  Options options;
  Faults& faults = options.answerer.faults;
  program.add_option("--port-link", options.link, "also make this symbolic link to it");
  program.add_option("--servos", options.ids, "their ids")->capture_default_str();
  program.add_option("--protocol", options.protocol)->check(example::one_of({1, 2}))->capture_default_str();
  program.add_option("--model", options.models, "such as XM430-W350, by turns where there are several; else MX-64")
      ->delimiter(',');
  program.add_flag("--new", options.new_ones, "as from the factory: their own speed, answers after 500 us");
  program.add_option("--baud", options.answerer.bits_per_s, "[bit/s]")
      ->check(example::between(1'200, 4'500'000))
      ->capture_default_str();
  program.add_flag_callback(
      "--chain-goes-on", [&] { options.answerer.chain = Chain::goes_on; },
      "in a sync or bulk read, servos behind a silent one answer a little later; else not at all");
  program.add_option("--seed", options.answerer.seed, "of the faults")->capture_default_str();
  program.add_option("--lost", faults.lost, "share of answers")->check(example::between(0.0, 1.0));
  program.add_option("--corrupted", faults.corrupted, "share of answers")->check(example::between(0.0, 1.0));
  program.add_option("--corrupted-bytes", faults.corrupted_bytes, "in a row, at most")
      ->check(example::between(1, 6))
      ->capture_default_str();
  program.add_option("--late", faults.late, "share of answers")->check(example::between(0.0, 1.0));
  program.add_option("--late-by", faults.late_s, "[s]")->check(example::between(0.0, 1.0))->capture_default_str();
  program.add_option("--duplicated", faults.duplicated, "share of answers")->check(example::between(0.0, 1.0));
  program.add_option("--wrong-id", faults.wrong_id, "share of answers")->check(example::between(0.0, 1.0));
  program.add_option("--silent", options.silent, "ids that do not answer");
  program.add_option("--silent-from", options.silent_from_s, "[s] after the start");
  program.add_option("--silent-to", options.silent_to_s, "[s] after the start");
  program.add_option("--hot", options.hot, "ids that are 90 degrees hot");
  program.add_option("--voltage", options.voltage_v, "[V]; else what each model is made for")
      ->check(example::between(0.1, 25.0));
  program.add_option("--unheard", faults.unheard, "share of instructions that no servo hears")
      ->check(example::between(0.0, 1.0));
  program.add_option("--return-delay", options.return_delay_us, "of the servos; new ones have 500 [us]")
      ->check(example::between(0.0, 508.0))
      ->capture_default_str();
  program.add_option("--status-return-level", options.status_return_level)
      ->check(example::between(0, 2))
      ->capture_default_str();
  program.add_option("--latency-timer", options.answerer.latency_timer_s, "of the adapter [s]")
      ->check(example::between(0.0, 0.1))
      ->capture_default_str();
  program.add_option("--then", options.then_s, "when the next ones happen [s]")->capture_default_str();
  program.add_option("--reboot", options.reboot, "ids that start anew");
  program.add_option("--overload", options.overload, "ids that shut themselves down");
  program.add_option("--cut", options.cut, "ids whose cable is cut");
  program.add_option("--voltage-then", options.voltage_then_v, "[V]")->check(example::between(0.0, 25.0));
  program.add_flag("--hang-up", options.hang_up, "the port goes away");
  program.callback([&] {
    if (faults.lost + faults.corrupted + faults.late + faults.duplicated + faults.wrong_id > 1) {
      throw example::UsageError("the shares of faults add up to more than 1; an answer has at most one");
    }
    options.answerer.own_speeds = options.new_ones;
    if (options.protocol == 1) serve<Protocol1>(options);
    if (options.protocol == 2) serve<Protocol2>(options);
  });
  return example::run_program(program, argc, argv);
}
