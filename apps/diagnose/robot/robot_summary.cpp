#include <cmath>
#include <sstream>

#include "../progress.hpp"
#include "../wording.hpp"
#include "robot_files.hpp"

namespace diagnose_robot {

std::string robot_summary(const RobotDiagnosis& d, const std::string& report) {
  using diagnose_program::percent;
  using diagnose_program::rounded;
  std::ostringstream text;
  const std::string unit = d.torque_driven ? " of the torque" : " rad";
  text << d.common.model << ": " << diagnose_program::headline(d.common.verdict)
       << (d.common.complete ? "" : " (so far)") << '\n';
  for (const auto& fault : d.common.log_faults)
    text << "  log     " << fault.sentence << (fault.repaired ? " (repaired for this diagnosis)" : "; " + fault.cure)
         << '\n';
  for (const auto& effect : d.common.effects) {
    text << "  effect  " << effect.name << " at " << effect.attached_to;
    for (const auto& fit : effect.parameters) text << ", " << fit.name << " " << diagnose_program::with_interval(fit);
    text << "; gain " << percent(effect.evidence.gain) << '\n';
  }
  for (const auto& effect : d.common.known_effects)
    text << "  as in the file  " << effect.name << " at " << effect.attached_to << '\n';
  std::size_t ruled_out = 0;
  for (const JointDifference& one : d.differences) ruled_out += one.differs ? 0 : 1;
  if (!d.differences.empty()) {
    text << "  joints against their groups: " << d.differences.size() - ruled_out << " differences named, " << ruled_out
         << " ruled out\n";
  }
  text << "  error: rigid bodies " << rounded(d.textbook) << unit << ", the file as it stands " << rounded(d.nominal)
       << ", after " << rounded(d.after) << ", held out " << rounded(d.held_out) << "; noise floor " << rounded(d.noise)
       << '\n';
  if (std::isfinite(d.replayed)) text << "  augmented.xml replayed in MuJoCo: " << rounded(d.replayed) << unit << '\n';
  if (!d.common.remarks.empty()) text << "  " << d.common.remarks.size() << " remark(s), see the report\n";
  text << "  " << diagnose_program::duration_text(d.common.seconds) << "; read " << report << '\n';
  return text.str();
}

}  // namespace diagnose_robot
