#include "wording.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace diagnose_program {

std::string rounded(double value, int digits) {
  if (!std::isfinite(value)) return "unknown";
  std::array<char, 40> buffer{};
  const double size = std::abs(value);
  if (size >= 1000 && size < 1e6) {
    std::snprintf(buffer.data(), buffer.size(), "%.0f", value);
  } else {
    std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  }
  return buffer.data();
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "unknown";
  const double size = 100 * std::abs(share);
  return rounded(100 * share, size < 9.5 ? 1 : size < 99.5 ? 2 : 3) + " %";  // else %g would print 1e+01 and 1e+02
}

std::string with_interval(const surefoot::FittedValue& fit) {
  const std::string unit = fit.unit.empty() || fit.unit == "1" ? "" : " " + fit.unit;
  return rounded(fit.value) + unit + " (" + rounded(fit.low) + " to " + rounded(fit.high) +
         (fit.at_bound ? ", at its bound)" : ")");
}

std::string p_text(double p) {
  if (!std::isfinite(p)) return "p unknown";
  return p < 0.001 ? "p < 0.001" : "p = " + rounded(p, 2);
}

std::string effects_text(const std::vector<std::pair<std::string, std::string>>& effects) {
  std::string text;
  for (const auto& [name, attached_to] : effects) text += (text.empty() ? "" : " + ") + name + " at " + attached_to;
  return text.empty() ? "no effect" : text;
}

std::string fault_text(const surefoot::LogFault& fault) {
  const bool left_out = fault.kind == "odd_recording";
  if (fault.repaired) {
    return fault.sentence + (left_out ? " (left out of this diagnosis)" : " (repaired for this diagnosis)");
  }
  return fault.sentence + "; " + fault.cure + (left_out ? ", as --repair does" : ", or run again with --repair");
}

std::string headline(surefoot::Verdict verdict) {
  switch (verdict) {
    case surefoot::Verdict::adequate:
      return "Nothing is missing";
    case surefoot::Verdict::parameters_only:
      return "Only the parameters were off";
    case surefoot::Verdict::missing_physics:
      return "Physics is missing";
    case surefoot::Verdict::unfinished:
      return "The search was not finished";
    case surefoot::Verdict::unexplained:
      break;
  }
  return "Something is missing that no known effect explains";
}

}  // namespace diagnose_program
