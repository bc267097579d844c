// Losses that keep a few outliers from deciding a fit: how much a residual counts.
// Huber: "Robust Statistics", 1981. Each is s^2 rho(r^2 / s^2) for a residual r and the scale s, in place of r^2.
#pragma once

#include <cmath>
#include <cstdint>

namespace surefoot {

enum class Loss : std::uint8_t {
  squared,  // for normal noise
  huber,    // squared up to the scale, then linear; has one minimum where `squared` has
  cauchy,   // logarithmic: far outliers hardly count; may have several minima
};

/// Of a residual of `r` scales: rho, the weight psi(r) / r with psi = rho' / 2, and the slope of psi.
struct LossTerms {
  double rho = 0;
  double weight = 1;
  double slope = 1;
};

inline LossTerms loss_terms(Loss loss, double r) {
  const double u = r * r;
  switch (loss) {
    case Loss::huber:
      if (u > 1) return {.rho = 2 * std::sqrt(u) - 1, .weight = 1 / std::sqrt(u), .slope = 0};
      break;
    case Loss::cauchy:
      return {.rho = std::log1p(u), .weight = 1 / (1 + u), .slope = (1 - u) / ((1 + u) * (1 + u))};
    case Loss::squared:
      break;
  }
  return {.rho = u};
}

}  // namespace surefoot
