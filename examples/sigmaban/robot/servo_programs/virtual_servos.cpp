// virtual_servos: MX-64 servos behind a pseudo-terminal, for programs that want some. Runs until Ctrl-C.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "../../../../apps/common/interrupt.hpp"
#include "../../../../apps/common/run_program.hpp"
#include "../bus/realtime.hpp"
#include "../virtual_bus/virtual_bus.hpp"
#include "servo_ids.hpp"

namespace {

using namespace dynamixel;

struct Options {
  std::string link;
  std::string ids = "1-20";
  int protocol = 2;
  std::string silent;
  double silent_from_s = 0, silent_to_s = 1e9;
  std::string hot;
  double voltage_v = 12;
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

template <class Protocol>
void serve(const Options& options, const ServoModel& model) {
  const example::Interrupt interrupt;
  std::vector<VirtualServo> servos;
  for (const std::uint8_t id : example::parse_ids(options.ids)) servos.emplace_back(model, id);
  ask_for_realtime();
  VirtualBus<Protocol> bus{Answerer<Protocol>(servos, options.answerer)};
  const PortLink link(options.link, bus.path());
  std::cout << bus.path() << '\n' << std::flush;

  const auto each = [](const std::string& ids, auto action) {
    if (!ids.empty()) std::ranges::for_each(example::parse_ids(ids), action);
  };
  bus.with([&](auto& answerer) {
    answerer.set_voltage(options.voltage_v);
    each(options.hot, [&](std::uint8_t id) { answerer.servo(id).temperature_celsius = 90; });
  });
  const Time begin = PseudoTerminal::now();
  while (!interrupt.requested()) {
    const double now_s = to_seconds(PseudoTerminal::now() - begin);
    const bool silent = now_s >= options.silent_from_s && now_s < options.silent_to_s;
    bus.with([&](auto& answerer) { each(options.silent, [&](std::uint8_t id) { answerer.set_silent(id, silent); }); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  bus.with([](const auto& answerer) {
    const FaultCounts& counts = answerer.counts();
    std::cout << answerer.instructions() << " instructions; faults made: " << counts.lost << " lost, "
              << counts.corrupted << " corrupted, " << counts.late << " late, " << counts.duplicated << " duplicated, "
              << counts.wrong_id << " wrong id, " << counts.silent << " silent\n";
  });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program{"MX-64 servos behind a pseudo-terminal, until Ctrl-C; prints its name", "virtual_servos"};
  Options options;
  Faults& faults = options.answerer.faults;
  program.add_option("--port-link", options.link, "also make this symbolic link to it");
  program.add_option("--servos", options.ids, "their ids")->capture_default_str();
  program.add_option("--protocol", options.protocol)->check(CLI::IsMember({1, 2}))->capture_default_str();
  program.add_option("--baud", options.answerer.bits_per_s, "[bit/s]")
      ->check(CLI::Range(1'200, 4'500'000))
      ->capture_default_str();
  program.add_flag_callback(
      "--chain-goes-on", [&] { options.answerer.chain = Chain::goes_on; },
      "in a sync or bulk read, servos behind a silent one answer a little later; else not at all");
  program.add_option("--seed", options.answerer.seed, "of the faults")->capture_default_str();
  program.add_option("--lost", faults.lost, "share of answers")->check(CLI::Range(0.0, 1.0));
  program.add_option("--corrupted", faults.corrupted, "share of answers")->check(CLI::Range(0.0, 1.0));
  program.add_option("--corrupted-bytes", faults.corrupted_bytes, "in a row, at most")
      ->check(CLI::Range(1, 6))
      ->capture_default_str();
  program.add_option("--late", faults.late, "share of answers")->check(CLI::Range(0.0, 1.0));
  program.add_option("--late-by", faults.late_s, "[s]")->check(CLI::Range(0.0, 1.0))->capture_default_str();
  program.add_option("--duplicated", faults.duplicated, "share of answers")->check(CLI::Range(0.0, 1.0));
  program.add_option("--wrong-id", faults.wrong_id, "share of answers")->check(CLI::Range(0.0, 1.0));
  program.add_option("--silent", options.silent, "ids that do not answer");
  program.add_option("--silent-from", options.silent_from_s, "[s] after the start");
  program.add_option("--silent-to", options.silent_to_s, "[s] after the start");
  program.add_option("--hot", options.hot, "ids that are 90 degrees hot");
  program.add_option("--voltage", options.voltage_v, "[V]")->check(CLI::Range(0.0, 25.0))->capture_default_str();
  program.callback([&] {
    if (faults.lost + faults.corrupted + faults.late + faults.duplicated + faults.wrong_id > 1) {
      throw example::UsageError("the shares of faults add up to more than 1; an answer has at most one");
    }
    if (options.protocol == 1) serve<Protocol1>(options, mx_64_protocol_1);
    if (options.protocol == 2) serve<Protocol2>(options, mx_64_protocol_2);
  });
  return example::run_program(program, argc, argv);
}
