// surefoot-servos: from servos in a box to servos that walk: who is there, how they are, their settings, their line.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "../../../../apps/common/command.hpp"
#include "../bus/realtime.hpp"
#include "../setup/change.hpp"
#include "../setup/measure.hpp"
#include "../setup/scan.hpp"
#include "../setup/show.hpp"
#include "servo_ids.hpp"

namespace {

using namespace dynamixel;
using example::UsageError;

struct LineOptions {
  ServoLine line;
  std::string ids;

  std::vector<std::uint8_t> wanted() const {
    return ids_on(line, ids.empty() ? std::vector<std::uint8_t>() : example::parse_ids(ids));
  }
};

void add_line(example::Command& command, LineOptions& options) {
  command.add_option("--port", options.line.port, "such as /dev/ttyUSB0")->required();
  command.add_option("--baud", options.line.bits_per_s, "of the servos now [bit/s]; scan tells")->capture_default_str();
  command.add_option("--protocol", options.line.protocol)->check(example::one_of({1, 2}))->capture_default_str();
  command.add_option("--ids", options.ids, "such as 1-12; default: all that answer");
}

void add_scan(example::Command& program) {
  struct Options {
    std::vector<std::string> ports;
    ScanOptions scan;
  };
  auto options = std::make_shared<Options>();
  example::Command* command = program.add_subcommand("scan", "Find servos: all ports, speeds and protocols");
  command->add_option("--port", options->ports, "only there; several times");
  command->add_option("--baud", options->scan.bits_per_s, "only at these speeds [bit/s]")->delimiter(',');
  command->add_option("--protocol", options->scan.protocols, "only by that one")->check(example::one_of({1, 2}));
  command->add_option("--last-id", options->scan.last_id_1, "to be asked by Protocol 1.0, which has no broadcast ping")
      ->check(example::between(0, 253))
      ->capture_default_str();
  command->callback([options] {
    const auto ports = options->ports.empty() ? serial_ports() : options->ports;
    if (ports.empty()) throw UsageError("there is no serial adapter in /dev (ttyUSB, ttyACM, ttyAMA); plug one in");
    std::size_t count = 0;
    std::printf("%-24s %9s %9s %4s  %-12s %s\n", "port", "bit/s", "protocol", "id", "model", "firmware");
    for (const std::string& port : ports) {
      for (const std::uint32_t speed : options->scan.bits_per_s) {
        for (const int protocol : options->scan.protocols) {
          for (const FoundServo& servo : scan_line(port, speed, protocol, options->scan)) {
            const ServoModel* model = find_model(servo.model_number);
            const std::string name = model != nullptr ? std::string(model->name) : std::to_string(servo.model_number);
            std::printf("%-24s %9u %9d %4d  %-12s %d\n", port.c_str(), speed, protocol, servo.id, name.c_str(),
                        servo.firmware);
            std::fflush(stdout);
            ++count;
          }
        }
      }
    }
    if (count == 0) throw UsageError("no servo answers on any port; is their power on, and the cable right?");
    std::printf("%zu servos\n", count);
  });
}

void add_show(example::Command& program) {
  struct Options : LineOptions {
    bool all = false;
  };
  auto options = std::make_shared<Options>();
  example::Command* command = program.add_subcommand("show", "Tell how servos are and how they are set");
  add_line(*command, *options);
  command->add_flag("--all", options->all, "every register");
  command->callback([options] {
    const auto ids = options->wanted();
    with_protocol(options->line.protocol, [&](auto protocol) {
      auto bus = open_patiently<decltype(protocol)>(options->line.port, options->line.bits_per_s);
      options->all ? show_all(bus, ids) : show_briefly(bus, ids);
    });
  });
}

/// "temperature_limit=70".
std::pair<std::string, double> parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  const char* begin = equals == std::string::npos ? "" : text.c_str() + equals + 1;
  char* end = nullptr;
  const double value = std::strtod(begin, &end);
  if (end == begin || *end != '\0')
    throw UsageError("--set " + text + ": NAME=NUMBER is expected; show --all has names");
  return {text.substr(0, equals), value};
}

void add_setup(example::Command& program) {
  struct Options : LineOptions {
    SettingsChange change;
    std::vector<std::string> settings;
    double return_delay_us = -1;
    int new_id = -1;
    std::uint32_t new_baud = 0;
    std::filesystem::path backup;
  };
  auto options = std::make_shared<Options>();
  example::Command* command =
      program.add_subcommand("setup", "Set servos up; what they were goes into a backup file first");
  command->footer("Torque is switched off. New servos all have the id 1: connect them one by one, or set --ids.");
  add_line(*command, *options);
  command->add_option("--backup", options->backup, "file for the settings as they are now; must not exist")->required();
  command->add_option("--new-id", options->new_id, "of a single servo")->check(example::between(0, 252));
  command->add_option("--new-baud", options->new_baud, "of all [bit/s]");
  command->add_option("--return-delay", options->return_delay_us, "[us]")->check(example::between(0.0, 508.0));
  command->add_flag("--zero", options->change.zero_here, "where each is now becomes its centre (Protocol 2.0)");
  command->add_option("--set", options->settings, "NAME=VALUE in the unit that show --all prints; several times");
  command->callback([options] {
    if (exists(options->backup)) {
      throw UsageError(options->backup.string() + ": is there already; give another --backup, or restore it first");
    }
    SettingsChange& change = options->change;
    for (const std::string& text : options->settings) change.settings.push_back(parse_setting(text));
    if (options->return_delay_us >= 0) change.return_delay_s = 1e-6 * options->return_delay_us;
    if (options->new_id >= 0) change.new_id = static_cast<std::uint8_t>(options->new_id);
    if (options->new_baud > 0) change.new_bits_per_s = options->new_baud;
    const auto ids = options->wanted();
    if (change.new_id && ids.size() != 1) throw UsageError("--new-id is for a single servo; name it by --ids");
    with_protocol(options->line.protocol, [&](auto protocol) {
      change_settings<decltype(protocol)>(options->line, ids, change, options->backup);
    });
    std::printf("%zu servos are set up; as they were: %s\n", ids.size(), options->backup.c_str());
  });
}

void add_restore(example::Command& program) {
  struct Options {
    std::string port;
    std::filesystem::path backup;
  };
  auto options = std::make_shared<Options>();
  example::Command* command = program.add_subcommand("restore", "Make servos what they were before setup");
  command->add_option("--port", options->port, "such as /dev/ttyUSB0")->required();
  command->add_option("backup", options->backup, "file that setup wrote")->required()->check(example::existing_file());
  command->callback([options] {
    const SettingsBackup backup = read_backup(options->backup);
    with_protocol(backup.protocol, [&](auto protocol) { restore_settings<decltype(protocol)>(options->port, backup); });
    std::printf("%zu servos are as they were, at %u bit/s\n", backup.servos.size(), backup.bits_per_s);
  });
}

void add_reboot(example::Command& program) {
  auto options = std::make_shared<LineOptions>();
  example::Command* command =
      program.add_subcommand("reboot", "Start servos anew: a hardware error keeps their torque off");
  add_line(*command, *options);
  command->callback([options] {
    const auto ids = options->wanted();
    with_protocol(options->line.protocol, [&](auto protocol) {
      auto bus = open_patiently<decltype(protocol)>(options->line.port, options->line.bits_per_s);
      for (const std::uint8_t id : ids) reboot_servo(bus, id);
    });
    std::printf("%zu servos have started anew\n", ids.size());
  });
}

void add_measure(example::Command& program) {
  struct Options : LineOptions {
    int cycles = 200;
  };
  auto options = std::make_shared<Options>();
  example::Command* command =
      program.add_subcommand("measure", "Measure a line: what rate it can hold, and what would help");
  command->footer(
      "Torque must be off. Predicted: from single answers and the bytes of a cycle; measured: whole cycles.");
  add_line(*command, *options);
  command->add_option("--cycles", options->cycles)->check(example::between(10, 100'000))->capture_default_str();
  command->callback([options] {
    const auto ids = options->wanted();
    ask_for_realtime();  // as a walk does
    with_protocol(options->line.protocol, [&](auto protocol) {
      print(measure_line<decltype(protocol)>(options->line, ids, options->cycles), options->line.port);
    });
  });
}

}  // namespace

int main(int argc, char** argv) {
  example::Command program{"Servos on serial lines: found, shown, set up, restored, measured", "surefoot-servos"};
  program.require_subcommand(1);
  add_scan(program);
  add_show(program);
  add_setup(program);
  add_restore(program);
  add_reboot(program);
  add_measure(program);
  return example::run_program(program, argc, argv);
}
