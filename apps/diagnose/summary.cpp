#include "summary.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "progress.hpp"
#include "wording.hpp"
#include "write_json.hpp"

namespace diagnose_program {

std::string summary(const surefoot::Diagnosis& d, const std::filesystem::path& out) {
  std::ostringstream text;
  text << d.model << ": " << headline(d.verdict) << (d.complete ? "" : " (so far)") << '\n';
  if (!d.sentence.empty()) text << "  " << d.sentence << '\n';
  for (const auto& fault : d.log_faults) text << "  log     " << fault_text(fault) << '\n';
  const bool clean = d.verdict == surefoot::Verdict::adequate || d.verdict == surefoot::Verdict::parameters_only;
  if (!clean && !d.regions.empty()) {
    const auto& region = d.regions.front();
    text << "  where   " << region.rule << ": " << percent(region.share_of_excess) << " of the excess error in "
         << percent(region.share_of_samples) << " of the samples\n";
  }
  for (const auto& effect : d.effects) {
    text << "  effect  " << effect.name << " at " << effect.attached_to;
    for (const auto& fit : effect.parameters) text << ", " << fit.name << " " << with_interval(fit);
    text << "; gain " << percent(effect.evidence.gain) << " +- " << percent(effect.evidence.gain_stderr)
         << ", confidence " << percent(effect.evidence.confidence) << '\n';
  }
  std::string changed;
  for (const auto& parameter : d.augmented_parameters.empty() ? d.parameters : d.augmented_parameters) {
    if (parameter.fixed) continue;
    changed += (changed.empty() ? "" : ", ") + parameter.fit.name + " " + rounded(parameter.fit.value) +
               (parameter.at_bound ? " (at its bound)" : "");
  }
  if (!changed.empty()) text << "  calibrated  " << changed << '\n';
  if (!d.held_out.empty()) {
    text << "  on " << d.held_out.size() << " held-out recording(s): error " << rounded(d.held_out_before);
    if (!d.effects.empty()) text << " before, " << rounded(d.held_out_after) << " after";
    text << "; forest " << rounded(d.held_out_forest);
    if (std::isfinite(d.noise_ratio)) {
      text << ", noise floor " << rounded(d.noise_floor) << " (" << rounded(d.noise_ratio) << " times it is left)";
    }
    text << '\n';
  }
  if (d.forest_residual.kept) {
    text << "  offered  " << residual_file << ", a forest that corrects what is simulated: error "
         << rounded(d.forest_residual.held_out_after) << " instead of " << rounded(d.forest_residual.held_out_before)
         << '\n';
  }
  std::string noise;
  for (const auto& one : d.noise_findings) noise += (noise.empty() ? "" : "; ") + one.sentence;
  if (!noise.empty()) text << "  " << noise << '\n';
  const auto twins = std::ranges::count_if(d.alternatives, [](const auto& one) { return one.indistinguishable; });
  if (twins > 0) {
    const auto twin = std::ranges::find_if(d.alternatives, [](const auto& one) { return one.indistinguishable; });
    text << "  cannot be told apart from  " << effects_text(twin->effects)
         << (twins > 1 ? " and " + std::to_string(twins - 1) + " more" : "") << '\n';
  }
  if (!d.next_experiment.empty()) text << "  next experiment  " << d.next_experiment << '\n';
  if (!d.remarks.empty()) text << "  " << d.remarks.size() << " remark(s) on the recordings, see the report\n";
  text << "  " << duration_text(d.seconds) << "; read " << (out / "report.html").string() << '\n';
  return text.str();
}

}  // namespace diagnose_program
