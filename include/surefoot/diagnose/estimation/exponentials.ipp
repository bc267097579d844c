// Definitions of surefoot/diagnose/estimation/exponentials.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/estimation/exponentials.hpp"

namespace surefoot::diagnosis {

using Packet = Eigen::internal::packet_traits<double>::type;
inline constexpr Eigen::Index packet_size = Eigen::internal::packet_traits<double>::size;

SUREFOOT_INLINE Eigen::VectorXd exponentials(const Eigen::VectorXd& x) {
  Eigen::VectorXd result(x.size());
  Eigen::Index i = 0;
  for (; i + packet_size <= x.size(); i += packet_size) {
    Eigen::internal::pstoreu(&result[i], Eigen::internal::pexp(Eigen::internal::ploadu<Packet>(&x[i])));
  }
  for (; i < x.size(); ++i) result[i] = std::exp(x[i]);
  return result;
}

SUREFOOT_INLINE Eigen::VectorXd logarithms(const Eigen::VectorXd& x) {
  Eigen::VectorXd result(x.size());
  Eigen::Index i = 0;
  for (; i + packet_size <= x.size(); i += packet_size) {
    Eigen::internal::pstoreu(&result[i], Eigen::internal::plog(Eigen::internal::ploadu<Packet>(&x[i])));
  }
  for (; i < x.size(); ++i) result[i] = std::log(x[i]);
  return result;
}

}  // namespace surefoot::diagnosis
