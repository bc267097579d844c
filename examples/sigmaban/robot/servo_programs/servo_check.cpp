// servo_check: which servos are on a bus, and how they are.
#include <algorithm>
#include <array>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <string>

#include "../../../../apps/common/command.hpp"
#include "../bus/bus.hpp"
#include "../bus/serial_port.hpp"
#include "../dynamixel/servo_models.hpp"
#include "../servos/feedback.hpp"
#include "servo_ids.hpp"

namespace {

using namespace dynamixel;

struct Options {
  std::string port;
  std::string ids = "0-252";
  int protocol = 2;
  std::uint32_t bits_per_s = 1'000'000;
};

template <class Protocol>
void print_row(Bus<Protocol, SerialPort>& bus, std::uint8_t id) {
  std::array<std::uint8_t, 2> number{};
  std::cout << std::setw(4) << int{id} << "  ";
  if (!bus.read(id, 0, number)) {
    std::cout << "answers to a ping, but does not tell its model\n";
    return;
  }
  const unsigned model_number = number[0] + 256U * number[1];
  const ServoModel* model = find_model(model_number);
  if (model == nullptr) {
    std::cout << "model number " << model_number << ", not known here\n";
    return;
  }
  const Feedback feedback(*model);
  std::array<std::uint8_t, 64> bytes{};
  const Buffer all = Buffer(bytes).first(feedback.count());
  std::cout << std::left << std::setw(12) << model->name << std::right;
  if (!bus.read(id, feedback.address(), all)) {
    std::cout << "does not tell its state\n";
    return;
  }
  const ServoState state = feedback.parse(all);
  std::cout << std::fixed << std::setprecision(3) << std::setw(8) << state.angle_rad << std::setprecision(1)
            << std::setw(10) << state.voltage_v << std::setprecision(0) << std::setw(8) << state.temperature_celsius
            << "    " << (bus.statistics(id).last_error_bits == 0 ? "" : "alarm") << '\n';
}

template <class Protocol>
void check(const Options& options) {
  const auto ids = example::parse_ids(options.ids);
  constexpr double patience_s = 20e-3;  // adapters keep what they read for 16 ms, as they come
  Bus<Protocol, SerialPort> bus{SerialPort(options.port, options.bits_per_s),
                                {.latency_s = patience_s, .memory_s = 5e-3, .retries = 2}};
  std::size_t found = 0;
  for (const std::uint8_t id : ids) {
    if (!bus.ping(id)) continue;
    if (found++ == 0) std::cout << "  id  model       angle rad  voltage  temperature\n";
    print_row(bus, id);
  }
  if (found == 0) {
    throw example::UsageError(options.port +
                              ": no servo answers; are --baud and --protocol those of the servos, and "
                              "is their power on?");
  }
  std::cout << found << " of " << ids.size() << " ids answered\n";
}

}  // namespace

int main(int argc, char** argv) {
  example::Command program{"Which servos are on a bus, and how they are", "servo_check"};
  Options options;
  program.add_option("--port", options.port, "such as /dev/ttyUSB0")->required();
  program.add_option("--ids", options.ids, "to ask")->capture_default_str();
  program.add_option("--protocol", options.protocol)->check(example::one_of({1, 2}))->capture_default_str();
  program.add_option("--baud", options.bits_per_s, "[bit/s]")->capture_default_str();
  program.callback([&] { options.protocol == 1 ? check<Protocol1>(options) : check<Protocol2>(options); });
  return example::run_program(program, argc, argv);
}
