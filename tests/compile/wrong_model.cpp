// A motion model of which WRONG_<member>, defined on the command line, spoils one member, given to calibrate().
#include <vector>

#include "surefoot/motion/calibrate.hpp"

struct Scale {
#if defined(WRONG_default_constructor)
  Scale(double s) : scale(s) {}
#endif
#if !defined(WRONG_parameter_count)
  static constexpr int parameter_count = 1;
#endif
#if !defined(WRONG_parameter_info)
  static std::array<surefoot::ModelParameter, 1> parameter_info() { return {{{"scale", "1", 0.5, 2.0}}}; }
#endif
#if !defined(WRONG_from_parameters)
  static Scale from_parameters(const surefoot::Vec<1>& p) { return {p[0]}; }
#endif
#if !defined(WRONG_parameters)
  surefoot::Vec<1> parameters() const { return surefoot::Vec<1>(scale); }
#endif
#if !defined(WRONG_displacement)
  surefoot::Pose2 displacement(const surefoot::Vec<3>& command) const {
    return surefoot::Pose2::from_vec(scale * command);
  }
#endif
  double scale = 1;
};

int main() {
  const std::vector<surefoot::WalkSequence> walks;
  auto found = surefoot::calibrate<Scale>(walks);
  return static_cast<int>(found.log_likelihood);
}
