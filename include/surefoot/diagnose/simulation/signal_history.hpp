// Past of a signal inside the equations, for what comes late there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace surefoot::diagnosis {

/// What a signal was at the times at which it was evaluated, in their order.
struct SignalHistory {
  std::vector<double> time, value;

  /// Notes that the signal is `now` at time t, forgets what was noted for later times (a step that was taken back), and
  /// returns what it was `delay` before: interpolated, and before there was any the first value or, `from_rest`, 0.
  /// Cost: log of the length.
  double delayed(double t, double now, double delay, bool from_rest = false) {
    while (!time.empty() && time.back() >= t) {
      time.pop_back();
      value.pop_back();
    }
    time.push_back(t);
    value.push_back(now);
    const auto after = std::lower_bound(time.begin(), time.end(), t - delay);
    if (after == time.begin()) return from_rest && t - delay < time.front() ? 0 : value.front();
    if (after == time.end()) return now;
    const auto k = static_cast<std::size_t>(std::distance(time.begin(), after));
    const double share = (t - delay - time[k - 1]) / (time[k] - time[k - 1]);
    return value[k - 1] + share * (value[k] - value[k - 1]);
  }
};

}  // namespace surefoot::diagnosis
