// bus_check: the bus and its safety layer against virtual servos that lose and damage answers, in real time. Each cycle
// sends goals to all joints and reads all of them. Exit code 1 where anything is not as it must be.
//
// A damaged answer could in principle pass the CRC-16: damage to two bytes in a row, as made here, never does; damage
// to more does in one of 65,536 cases.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "../../../../apps/common/command.hpp"
#include "../../../../apps/common/interrupt.hpp"
#include "../bus/background_port.hpp"
#include "../bus/realtime.hpp"
#include "../bus/serial_port.hpp"
#include "../servos/joint_lines.hpp"
#include "../virtual_bus/virtual_bus.hpp"
#include "stall_watch.hpp"

namespace {

using namespace dynamixel;

struct Options {
  double seconds = 60;
  int servos = 20;
  int ports = 1;
  double rate_hz = 100;
  double latency_s = 1.5e-3;
  double memory_s = 60e-3;
  double silent_for_s = 2;
  std::uint32_t bits_per_s = 3'000'000;
  std::uint64_t seed = 1;
  Faults faults{.lost = 0.01, .corrupted = 0.01};
  bool fast_sync_read = false;
};

struct Findings {
  std::uint64_t cycles = 0;
  std::uint64_t missed = 0;          // were not over when the next one began
  std::uint64_t stalled = 0;         // of them, in which the machine itself stood still
  std::uint64_t incomplete = 0;      // some joint had no answer
  std::uint64_t accepted = 0;        // answers
  std::uint64_t wrong = 0;           // of them, not what the servo sent in that cycle
  std::uint64_t false_reports = 0;   // of silence
  double longest_s = 0;              // cycle, with how late it began
  double latest_s = 0;               // that a cycle began, because the system woke us late
  double spent_s = 0;                // in all cycles
  std::optional<double> reported_s;  // silence, after it began
  std::optional<double> back_s;      // after it ended
};

using ServoBus = Bus<Protocol2, BackgroundPort<SerialPort>>;

/// Some of the servos, behind a port of their own.
struct Line {
  Line(const Options& options, std::vector<Joint> made, std::uint64_t number)
      : joints(std::move(made)),
        simulated(Answerer<Protocol2>(
            servos(joints),
            {.bits_per_s = options.bits_per_s, .faults = options.faults, .seed = options.seed + number})),
        bus(BackgroundPort(SerialPort(simulated.path(), options.bits_per_s)),
            {.return_delay_s = 0,
             .latency_s = options.latency_s,
             .memory_s = options.memory_s,
             .fast_sync_read = options.fast_sync_read}),
        // Listening and care together take less than a cycle.
        group(bus, mx_64_protocol_2, joints,
              {.listen_s = 0.7 / options.rate_hz, .care = {.poll_s = 0.2 / options.rate_hz, .silent_longest_s = 1e9}}) {
  }

  static std::vector<VirtualServo> servos(const std::vector<Joint>& joints) {
    std::vector<VirtualServo> made;
    for (const Joint& joint : joints) made.emplace_back(mx_64_protocol_2, joint.id, 0.01 * (joint.id - 1));
    return made;
  }

  std::vector<Joint> joints;
  VirtualBus<Protocol2> simulated;
  ServoBus bus;
  ServoGroup<ServoBus> group;
};

/// Every so manieth servo on each port.
std::vector<std::unique_ptr<Line>> make_lines(const Options& options, std::vector<std::size_t>& line_of) {
  std::vector<std::vector<Joint>> joints(static_cast<std::size_t>(options.ports));
  for (int i = 0; i < options.servos; ++i) {
    const auto id = static_cast<std::uint8_t>(i + 1);
    line_of.push_back(static_cast<std::size_t>(i % options.ports));
    joints[line_of.back()].push_back({.name = "joint " + std::to_string(id), .id = id});
  }
  std::vector<std::unique_ptr<Line>> lines;
  for (std::size_t i = 0; i < joints.size(); ++i) lines.push_back(std::make_unique<Line>(options, joints[i], i));
  return lines;
}

/// Answers of this cycle that are not what the servo sent. `first` has the number of its first instruction.
std::uint64_t wrong_answers(Line& line, std::uint64_t first) {
  std::uint64_t wrong = 0;
  for (std::size_t i = 0; i < line.joints.size(); ++i) {
    if (!line.group.states()[i].fresh) continue;
    const bool right = line.simulated.with(
        [&](const auto& answerer) { return answerer.gave(line.joints[i].id, line.group.received(i), first); });
    wrong += right ? 0 : 1;
  }
  return wrong;
}

/// Runs the cycles. A servo in the middle is silent for a while, from a third of the time on.
Findings run(const Options& options, std::vector<std::unique_ptr<Line>>& lines, const std::vector<std::size_t>& line_of,
             StallWatch& watch, const example::Interrupt& interrupt) {
  Findings found;
  const Time period = from_seconds(1 / options.rate_hz);
  std::vector<ServoGroup<ServoBus>*> groups;
  for (const auto& line : lines) groups.push_back(&line->group);
  JointLines all(groups, line_of);
  all.start();
  const std::size_t victim = line_of.size() / 2;
  const auto victim_id = static_cast<std::uint8_t>(victim + 1);
  const auto silence = [&](bool silent) {
    lines[line_of[victim]]->simulated.with([&](auto& answerer) { answerer.set_silent(victim_id, silent); });
  };
  const Time begin = all.now() + period;
  const Time silent_from = begin + from_seconds(options.seconds / 3);
  const Time silent_to = silent_from + from_seconds(options.silent_for_s);
  bool silenced = false, heard_again = false;
  std::vector<double> goals(line_of.size());
  std::vector<std::uint64_t> first(lines.size());
  std::vector<std::array<Time, 2>> missed;
  for (Time start = begin; start < begin + from_seconds(options.seconds) && !interrupt.requested(); start += period) {
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(start));
    if (!silenced && start >= silent_from) silence(silenced = true);
    if (!heard_again && start >= silent_to) silence(!(heard_again = true));
    for (std::size_t i = 0; i < lines.size(); ++i) {
      first[i] = lines[i]->simulated.with([](const auto& answerer) { return answerer.instructions() + 1; });
    }
    for (std::size_t i = 0; i < goals.size(); ++i) {
      goals[i] = 0.5 * std::sin(3 * to_seconds(start - begin) + static_cast<double>(i));
    }
    const Time work = all.now();
    found.latest_s = std::max(found.latest_s, to_seconds(work - start));
    all.set_goals(goals);
    const std::size_t answered = all.update();
    const Time end = all.now();

    ++found.cycles;
    if (end > start + period) missed.push_back({start - period, end});
    found.incomplete += answered < goals.size() ? 1 : 0;
    found.accepted += answered;
    found.longest_s = std::max(found.longest_s, to_seconds(end - start));
    found.spent_s += to_seconds(end - work);
    for (const ServoEvent& event : all.events()) {
      if (event.kind == ServoEventKind::silent) {
        if (event.joint != victim || found.reported_s || !silenced) {
          ++found.false_reports;
        } else {
          found.reported_s = to_seconds(end - silent_from);
        }
      }
      if (event.kind == ServoEventKind::back && event.joint == victim && !found.back_s && heard_again) {
        found.back_s = to_seconds(end - silent_to);
      }
    }
    for (std::size_t i = 0; i < lines.size(); ++i) found.wrong += wrong_answers(*lines[i], first[i]);
  }
  found.missed = missed.size();
  for (const auto& [from, to] : missed) found.stalled += watch.any(from, to) ? 1 : 0;
  return found;
}

bool say(bool right, const std::string& what) {
  std::cout << (right ? "  ok      " : "  FAILED  ") << what << '\n';
  return right;
}

std::string milliseconds(std::optional<double> seconds) {
  return seconds ? std::to_string(static_cast<int>(std::lround(*seconds * 1e3))) + " ms" : "never";
}

int check(const Options& options) {
  const example::Interrupt interrupt;
  const bool realtime = ask_for_realtime();
  std::vector<std::size_t> line_of;
  auto lines = make_lines(options, line_of);
  std::cout << options.servos << " virtual servos at " << options.bits_per_s << " bit/s behind " << options.ports
            << (options.ports == 1 ? " port, " : " ports, ") << options.rate_hz << " Hz for " << options.seconds
            << " s, " << (realtime ? "real-time priority" : "no real-time priority") << '\n'
            << std::flush;
  StallWatch watch;
  const Findings found = run(options, lines, line_of, watch, interrupt);

  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  ServoStatistics ours;
  FaultCounts made;
  for (const auto& line : lines) {
    line->bus.listen();
    for (const Joint& joint : line->joints) ours += line->bus.statistics(joint.id);
    made += line->simulated.with([](const auto& answerer) { return answerer.counts(); });
  }
  const std::uint64_t unheard = ours.lost + ours.skipped, unsent = made.lost + made.silent + made.withheld;
  const auto pair = [](std::uint64_t counted, std::uint64_t truth) {
    return std::to_string(counted) + " counted, " + std::to_string(truth) + " made";
  };
  std::cout << std::fixed << std::setprecision(2) << found.cycles << " cycles of "
            << found.spent_s / static_cast<double>(std::max<std::uint64_t>(found.cycles, 1)) * 1e3 << " ms on average, "
            << found.longest_s * 1e3 << " ms at most, begun up to " << found.latest_s * 1e3 << " ms late; "
            << found.incomplete << " without all answers; " << found.accepted << " answers\n"
            << "asked " << ours.asked << " times: " << ours.answered << " answered, " << ours.lost << " lost, "
            << ours.corrupted << " corrupted, " << ours.late << " late, " << ours.skipped << " behind a silent one, "
            << ours.wrong_id << " wrong id, " << ours.wrong_length << " wrong length, " << ours.duplicates
            << " twice\n";
  bool right = say(!interrupt.requested(), "ran to the end");
  right &= say(found.missed == found.stalled,
               "missed control cycles: " + std::to_string(found.missed) +
                   ", of them while the machine stood still: " + std::to_string(found.stalled) +
                   " (threads that only sleep woke late " + std::to_string(watch.count()) + " times)");
  // An answer that the system hands over late may look like another fault, each late one like one at most. In a fast
  // sync read one fault costs the packet of all, so that there is nothing to compare.
  const auto agree = [&](std::uint64_t counted, std::uint64_t truth) {
    return options.fast_sync_read || std::max(counted, truth) - std::min(counted, truth) <= ours.late;
  };
  const std::string note =
      ours.late == 0 ? "" : " (late ones, which may count as others: " + std::to_string(ours.late) + ")";
  right &=
      say(agree(ours.corrupted, made.corrupted), "corrupted answers: " + pair(ours.corrupted, made.corrupted) + note);
  right &= say(agree(ours.lost, made.lost + made.silent),
               "lost answers, with those of the silent servo: " + pair(ours.lost, made.lost + made.silent) + note);
  right &= say(agree(ours.corrupted + unheard, made.corrupted + unsent),
               "all of these, with those not sent behind a silent one: " +
                   pair(ours.corrupted + unheard, made.corrupted + unsent) + note);
  const std::uint64_t others = ours.wrong_id + ours.wrong_length + ours.duplicates + ours.refused;
  right &= say(agree(others, 0), "faults counted but not made: " + std::to_string(others) + note);
  right &= say(found.wrong == 0, "wrong values accepted: " + std::to_string(found.wrong));
  right &= say(found.false_reports == 0, "false reports of silence: " + std::to_string(found.false_reports));
  right &= say(found.reported_s && *found.reported_s <= 0.050,
               "silence reported after " + milliseconds(found.reported_s) + " (at most 50 ms)");
  right &= say(found.back_s.has_value(), "heard again after " + milliseconds(found.back_s));
  return right ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  example::Command program{"The servo bus against virtual servos with faults, in real time", "bus_check"};
  Options options;
  program.add_option("--seconds", options.seconds)->check(example::between(1.0, 1e6))->capture_default_str();
  program.add_option("--servos", options.servos)->check(example::between(2, 64))->capture_default_str();
  program.add_option("--ports", options.ports, "that the servos share")
      ->check(example::between(1, 8))
      ->capture_default_str();
  program.add_option("--rate", options.rate_hz, "[Hz]")->check(example::between(1.0, 1000.0))->capture_default_str();
  program.add_option("--baud", options.bits_per_s, "[bit/s]")->capture_default_str();
  program.add_option("--latency", options.latency_s, "of the operating system, allowed for [s]")
      ->check(example::between(0.0, 1.0))
      ->capture_default_str();
  program
      .add_option(
          "--memory", options.memory_s,
          "how late answers are still recognised [s]; a busy kernel hands over the bytes of a pseudo-terminal late")
      ->check(example::between(1e-3, 1.0))
      ->capture_default_str();
  program.add_option("--silent-for", options.silent_for_s, "[s]")->capture_default_str();
  program.add_option("--lost", options.faults.lost, "share of answers")->capture_default_str();
  program.add_option("--corrupted", options.faults.corrupted, "share of answers")->capture_default_str();
  program.add_flag("--fast-sync-read", options.fast_sync_read,
                   "one packet of all servos in a cycle, where it comes through");
  program.add_option("--seed", options.seed)->capture_default_str();
  int code = EXIT_SUCCESS;
  program.callback([&] { code = check(options); });
  const int parsed = example::run_program(program, argc, argv);
  return parsed == EXIT_SUCCESS ? code : parsed;
}
