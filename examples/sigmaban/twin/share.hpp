// A share of independent yes-or-no outcomes and how well it is known.
#pragma once

#include <cmath>
#include <cstddef>

namespace sigmaban {

/// The 95 % interval is Wilson's score interval (1927): it stays within [0, 1], for few trials too.
struct Share {
  std::size_t yes = 0, trials = 0;  // trials > 0

  double value() const { return static_cast<double>(yes) / static_cast<double>(trials); }
  double low() const { return middle() - half_width(); }
  double high() const { return middle() + half_width(); }

 private:
  static constexpr double z = 1.96;
  double weight() const { return z * z / static_cast<double>(trials); }
  double middle() const { return (value() + weight() / 2) / (1 + weight()); }
  double half_width() const {
    return z * std::sqrt((value() * (1 - value()) + weight() / 4) / static_cast<double>(trials)) / (1 + weight());
  }
};

}  // namespace sigmaban
