// Definitions of surefoot/diagnose/residual_tests/noise_spectrum.hpp.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "surefoot/core/compiled.hpp"
#include "surefoot/diagnose/residual_tests/noise_spectrum.hpp"
#include "surefoot/diagnose/residual_tests/whiteness.hpp"

namespace surefoot::diagnosis {

SUREFOOT_ONCE std::vector<Eigen::VectorXd> filled_series(const BoundSimulator& bound,
                                                         const std::vector<std::size_t>& recordings,
                                                         const std::vector<SimulatedRun>& runs, Eigen::Index output) {
  constexpr double few = 0.2;  // of the rows
  std::vector<Eigen::VectorXd> result;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (!runs[i].finite) continue;
    const Eigen::MatrixXd& readings = bound.recordings[recordings[i]].outputs;
    Eigen::VectorXd series = series_of(bound, recordings[i], runs[i], output);
    std::vector<Eigen::Index> read;
    for (Eigen::Index row = 0; row < series.size(); ++row) {
      if (std::isfinite(readings(output, row))) read.push_back(row);
    }
    if (static_cast<double>(read.size()) < (1 - few) * static_cast<double>(series.size())) continue;
    for (std::size_t n = 1; n < read.size(); ++n) {
      const Eigen::Index from = read[n - 1], to = read[n];
      for (Eigen::Index row = from + 1; row < to; ++row) {
        const double share = static_cast<double>(row - from) / static_cast<double>(to - from);
        series[row] = (1 - share) * series[from] + share * series[to];
      }
    }
    result.push_back(std::move(series));
  }
  return result;
}

SUREFOOT_ONCE FastSpectrum fast_spectrum(const std::vector<Eigen::VectorXd>& series) {
  constexpr Eigen::Index rows = 64, slowest = rows / 8, fastest = rows / 2;
  constexpr std::size_t fewest = 8;  // chunks: their median is known to a third then
  constexpr double pi = std::numbers::pi;
  std::array<double, rows> taper = {}, cosine = {}, sine = {};
  double weight = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / rows;
    cosine[i] = std::cos(angle);
    sine[i] = std::sin(angle);
    taper[i] = 0.5 * (1 - cosine[i]);
    weight += taper[i] * taper[i];
  }
  std::vector<std::vector<double>> powers(fastest - slowest);  // of chunks, by frequency
  for (const Eigen::VectorXd& y : series) {
    for (Eigen::Index from = 0; from + rows + 3 <= y.size(); from += rows / 2) {
      std::array<double, rows> chunk = {};
      for (Eigen::Index i = 0; i < rows; ++i) {
        const double* at = y.data() + from + i;
        chunk[static_cast<std::size_t>(i)] =
            taper[static_cast<std::size_t>(i)] * (at[3] - 3 * at[2] + 3 * at[1] - at[0]);
      }
      for (std::size_t k = 0; k < powers.size(); ++k) {
        double real = 0, imaginary = 0;
        for (std::size_t i = 0; i < rows; ++i) {
          const std::size_t turned = i * (k + slowest) % rows;
          real += chunk[i] * cosine[turned];
          imaginary += chunk[i] * sine[turned];
        }
        powers[k].push_back((real * real + imaginary * imaginary) / weight);
      }
    }
  }
  FastSpectrum spectrum;
  if (powers.front().size() < fewest) return spectrum;
  for (std::size_t k = 0; k < powers.size(); ++k) {
    std::vector<double>& of_chunks = powers[k];
    const auto middle = of_chunks.begin() + static_cast<std::ptrdiff_t>(of_chunks.size() / 2);
    std::nth_element(of_chunks.begin(), middle, of_chunks.end());
    const double frequency = 2 * pi * static_cast<double>(k + slowest) / rows;
    const double differenced = std::pow(2 * std::sin(frequency / 2), 6);  // what third differences do to it
    spectrum.frequency.push_back(frequency);
    spectrum.power.push_back(*middle / std::numbers::ln2 / differenced);  // a power is exponentially distributed
  }
  return spectrum;
}

SUREFOOT_ONCE FadingNoise noise_from_spectrum(const FastSpectrum& spectrum) {
  constexpr double most_memory = 0.9;
  double least = std::numeric_limits<double>::infinity();
  FadingNoise noise;
  const std::size_t count = spectrum.power.size();
  const bool nothing_left = std::find(spectrum.power.begin(), spectrum.power.end(), 0) != spectrum.power.end();
  if (count == 0 || nothing_left) return noise;
  for (double rho = 0; rho < 0.99; rho += 0.01) {
    std::vector<double> logarithms;
    double mean = 0, off = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double shape = 1 - 2 * rho * std::cos(spectrum.frequency[k]) + rho * rho;
      logarithms.push_back(std::log(spectrum.power[k] * shape));
      mean += logarithms.back() / static_cast<double>(count);
    }
    for (const double one : logarithms) off += (one - mean) * (one - mean);
    if (!(off < least)) continue;
    least = off;
    noise = {std::sqrt(std::exp(mean) / (1 - rho * rho)), rho};
    if (rho > most_memory) noise = {std::sqrt(spectrum.power.back()), 0, true};
  }
  return noise;
}

}  // namespace surefoot::diagnosis
