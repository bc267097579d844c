// Two rods that hang on each other with dry friction in both joints, by Lagrange's equations, integrated from event to
// event: what simulations of coupled joints are compared with.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace two_links {

using Pair = std::array<double, 2>;

constexpr double gravity = 9.81, rotor = 0.01;  // [m/s^2], [kg m^2] of each joint's motor

struct LinkState {
  Pair q{}, v{};
};

// slides[i]: direction in which joint i slips, 0: it sticks.
struct TwoLinks {
  double l1 = 0.25, l2 = 0.25, m1 = 1.5, m2 = 0.8;
  Pair friction{};

  static double rod_inertia(double m, double l) { return m * (l * l / 12 + 0.0009); }

  std::array<double, 3> mass(const Pair& q) const {  // M11, M12, M22
    const double a = l2 / 2, c = l1 * a * std::cos(q[1]), i2 = rod_inertia(m2, l2);
    return {rod_inertia(m1, l1) + m1 * l1 * l1 / 4 + i2 + m2 * (l1 * l1 + a * a + 2 * c) + rotor, i2 + m2 * (a * a + c),
            i2 + m2 * a * a + rotor};
  }

  Pair pull(const LinkState& s) const {  // of gravity and Coriolis forces
    const double a = l2 / 2, w = m2 * l1 * a * std::sin(s.q[1]), second = m2 * gravity * a * std::sin(s.q[0] + s.q[1]);
    return {w * (2 * s.v[0] * s.v[1] + s.v[1] * s.v[1]) - (m1 * l1 / 2 + m2 * l1) * gravity * std::sin(s.q[0]) - second,
            -w * s.v[0] * s.v[0] - second};
  }

  double energy(const LinkState& s) const {
    const auto [a, b, c] = mass(s.q);
    return (a * s.v[0] * s.v[0] + 2 * b * s.v[0] * s.v[1] + c * s.v[1] * s.v[1]) / 2 -
           (m1 * l1 / 2 + m2 * l1) * gravity * std::cos(s.q[0]) - m2 * gravity * l2 / 2 * std::cos(s.q[0] + s.q[1]);
  }

  Pair acceleration(const LinkState& s, const std::array<int, 2>& slides) const {
    const auto [a, b, c] = mass(s.q);
    Pair push = pull(s);
    for (std::size_t i = 0; i < 2; ++i) push[i] -= friction[i] * slides[i];
    if (slides[0] == 0 && slides[1] == 0) return {0, 0};
    if (slides[0] == 0) return {0, push[1] / c};
    if (slides[1] == 0) return {push[0] / a, 0};
    const double determinant = a * c - b * b;
    return {(c * push[0] - b * push[1]) / determinant, (a * push[1] - b * push[0]) / determinant};
  }

  // Torque that a sticking joint has to hold.
  Pair held(const LinkState& s, const std::array<int, 2>& slides) const {
    const auto [a, b, c] = mass(s.q);
    const Pair at = acceleration(s, slides), push = pull(s);
    return {push[0] - a * at[0] - b * at[1], push[1] - b * at[0] - c * at[1]};
  }

  // Of joints that stand still, what they do next: the only choice that contradicts nothing.
  std::array<int, 2> choose(const LinkState& s) const {
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        const std::array<int, 2> slides{s.v[0] != 0 ? (s.v[0] > 0 ? 1 : -1) : i,
                                        s.v[1] != 0 ? (s.v[1] > 0 ? 1 : -1) : j};
        const Pair at = acceleration(s, slides), torque = held(s, slides);
        bool good = true;
        for (std::size_t k = 0; k < 2; ++k) {
          if (s.v[k] != 0) continue;
          good = good && (slides[k] == 0 ? std::abs(torque[k]) <= friction[k] : at[k] * slides[k] > 0);
        }
        if (good) return slides;
      }
    }
    return {0, 0};
  }

  LinkState runge_kutta(const LinkState& s, const std::array<int, 2>& slides, double h) const {
    const auto moved = [&](const Pair& v, const Pair& a, double t) {
      LinkState next = s;
      for (std::size_t i = 0; i < 2; ++i) {
        next.q[i] += t * v[i];
        next.v[i] += t * a[i];
      }
      return next;
    };
    const Pair a1 = acceleration(s, slides);
    const LinkState s2 = moved(s.v, a1, h / 2);
    const Pair a2 = acceleration(s2, slides);
    const LinkState s3 = moved(s2.v, a2, h / 2);
    const Pair a3 = acceleration(s3, slides);
    const LinkState s4 = moved(s3.v, a3, h);
    const Pair a4 = acceleration(s4, slides);
    LinkState next = s;
    for (std::size_t i = 0; i < 2; ++i) {
      next.q[i] += h / 6 * (s.v[i] + 2 * s2.v[i] + 2 * s3.v[i] + s4.v[i]);
      next.v[i] += h / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
    }
    return next;
  }

  bool is_valid(const LinkState& s, const std::array<int, 2>& slides) const {
    const Pair torque = held(s, slides);
    for (std::size_t i = 0; i < 2; ++i) {
      if (slides[i] == 0 ? std::abs(torque[i]) > friction[i] : s.v[i] * slides[i] < 0) return false;
    }
    return true;
  }

  // By steps that end where a joint comes to rest or breaks away.
  void advance(LinkState& s, std::array<int, 2>& slides, double length) const {
    double left = length;
    while (left > 0) {
      LinkState next = runge_kutta(s, slides, left);
      if (is_valid(next, slides)) {
        s = next;
        return;
      }
      double low = 0, high = left;
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = (low + high) / 2;
        (is_valid(runge_kutta(s, slides, middle), slides) ? low : high) = middle;
      }
      next = runge_kutta(s, slides, high);
      for (std::size_t i = 0; i < 2; ++i) {
        if (slides[i] == 0 || next.v[i] * slides[i] <= 0) next.v[i] = 0;
      }
      s = next;
      slides = choose(s);
      left -= high;
    }
  }
};

}  // namespace two_links
