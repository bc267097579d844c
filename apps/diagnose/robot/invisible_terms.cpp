#include <algorithm>

#include "choose_terms.hpp"
#include "findings.hpp"

namespace diagnose_robot {
namespace {

// The largest size that is possible takes less off every joint's error than a name needs. Errors are linear in bodies and
// offsets of encoders, so that the derivative tells of all sizes.
bool is_invisible(const Evidence& evidence, const LinearModel& model, const Eigen::VectorXd& left, Eigen::Index t) {
  const Term& term = evidence.terms[static_cast<std::size_t>(t)];
  if (!is_of_body(term.property) && term.property != Property::sensor_bias) return false;
  const double remaining = 1 - ChoiceCriteria().smallest_gain;
  const double least = 1 / (remaining * remaining) - 1;  // of the squares that are left
  const double largest = std::max(std::abs(term.low), std::abs(term.high));
  for (std::size_t j = 0; j < model.whole.size(); ++j) {
    if (largest * largest * model.whole[j].gram(t, t) > least * left[static_cast<Eigen::Index>(j)]) return false;
  }
  return true;
}

}  // namespace

void name_invisible(const Evidence& evidence, const SearchResult& found, RobotDiagnosis& d) {
  const Eigen::VectorXd left = fit_linear(found.linear, found.set).square;
  std::string list;
  for (std::size_t t = 0; t < evidence.terms.size(); ++t) {
    const Term& term = evidence.terms[t];
    if (term.joints.size() != 1 || found.set[t] != 0) continue;
    if (!is_invisible(evidence, found.linear, left, static_cast<Eigen::Index>(t))) continue;
    const PropertyInfo& info = info_of(term.property);
    d.invisible.push_back({place_of(evidence.robot, term), info.effect, info.parameter});
    list += (list.empty() ? "" : ", ") + std::string(info.effect) + " (" + info.parameter + ") at " +
            place_of(evidence.robot, term);
  }
  if (!list.empty()) d.common.remarks.push_back({"", "no size of these would show in such recordings: " + list});
}

}  // namespace diagnose_robot
