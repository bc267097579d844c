#include "torque_scale.hpp"

#include "choose_terms.hpp"

namespace diagnose_robot {
namespace {

// The same with a term for the scale of each joint, behind the others.
Evidence with_scales(const Evidence& evidence) {
  Evidence wide = evidence;
  const PropertyInfo& info = info_of(Property::reading_scale);
  for (std::size_t j = 0; j < evidence.robot.joints.size(); ++j) {
    wide.terms.push_back(term_of_joint(info, j, evidence.scales[j]));
  }
  wide.entries = entries_of(wide.terms);
  return wide;
}

}  // namespace

std::vector<int> joints_of_other_scale(const Evidence& evidence, const ScaleCriteria& criteria) {
  const RobotSetup& setup = evidence.robot.setup;
  if (setup.drive != DriveKind::torque || setup.calibrate_gains) return {};
  const Evidence wide = with_scales(evidence);
  const Eigen::VectorXd theta = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(wide.terms.size()));
  RigidCache cache;
  const LinearModel model = linearize(wide, theta, wide.starts, errors_of(wide, wide.robot.nominal), cache);
  TermSet set = model.of_groups;
  std::fill(set.begin() + static_cast<std::ptrdiff_t>(evidence.terms.size()), set.end(), char{1});
  const LinearFit all = fit_linear(model, set);
  std::vector<int> joints;
  for (std::size_t t = evidence.terms.size(); t < wide.terms.size(); ++t) {
    const int joint = wide.terms[t].joints.front();
    const double scale = 1 + all.change[static_cast<Eigen::Index>(t)];
    if (evidence.silent[static_cast<std::size_t>(joint)] != 0) continue;
    if (scale > 1 / criteria.factor && scale < criteria.factor) continue;
    TermSet without = set;
    without[t] = 0;
    if (fit_linear(model, without).criterion - all.criterion > ChoiceCriteria().needed) joints.push_back(joint);
  }
  return joints;
}

}  // namespace diagnose_robot
