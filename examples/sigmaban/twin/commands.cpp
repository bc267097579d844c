#include "commands.hpp"

#include <sstream>

namespace sigmaban {

void add_twin_options(example::Command& command, TwinOptions& options) {
  std::ostringstream help;
  help << "physics that is off by default, NAME or NAME=VALUE (of one joint: NAME:JOINT=VALUE), several times:";
  for (const TwinSwitch& s : twin_switches) {
    help << ' ' << s.name << (s.of_joints ? "[:JOINT]=" : "=") << s.usual << " [" << s.unit << ']';
  }
  command.add_option("--switch", options.switches, help.str());
  command.add_option("--noise", options.noise, "[rad] standard deviation of noise on every joint target")
      ->check(example::between(0.0, 1.0))
      ->capture_default_str();
  command.add_flag("--stabilize", options.stabilized, "the walk feels gyroscope, accelerometer and load cells");
  command.add_option("--seed", options.seed, "of all randomness")->capture_default_str();
  command.add_option("--threads", options.threads, "0: as many as the machine has; results do not depend on it")
      ->check(example::between(0, 1024))
      ->capture_default_str();
}

void add_sequence_options(example::Command& command, int& sequences, int& cycles) {
  command.add_option("--sequences", sequences, "of random commands within the paper's bounds")
      ->check(example::between(1, 100'000))
      ->capture_default_str();
  command.add_option("--cycles", cycles, "of each sequence")->check(example::between(1, 10'000))->capture_default_str();
}

WalkingTwinOptions walking_twin_options(const TwinOptions& options) {
  WalkingTwinOptions result;
  for (const std::string& text : options.switches) set_switch(result.switches, text);
  result.target_noise = options.noise;
  result.stabilized = options.stabilized;
  return result;
}

}  // namespace sigmaban
