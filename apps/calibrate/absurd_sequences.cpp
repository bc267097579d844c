#include "absurd_sequences.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/monitor/recursive_update.hpp"

namespace calibrate_program {
namespace {

using surefoot::WalkSequence;

constexpr double once_in_a_million = 4.75;  // [deviations]

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string sentence(const WalkSequence& sequence, const surefoot::Innovation& innovation, double distance,
                     double typical) {
  char text[200];
  const auto cut = sequence.name.substr(0, 80);
  const double degrees = innovation.error.size() == 3 ? std::abs(innovation.error[2]) * 180 / std::numbers::pi : 0;
  if (distance > 2.5 * typical) {
    std::snprintf(text, sizeof text, "sequence %s ends %.2f m from where the model puts it, %.2f m is typical",
                  cut.c_str(), distance, typical);
  } else {
    std::snprintf(text, sizeof text, "sequence %s ends %.0f degrees turned from where the model puts it", cut.c_str(),
                  degrees);
  }
  return std::string(text) + ": a wrong reading? It was kept";
}

template <surefoot::MotionModel M>
std::vector<std::string> absurd_by(std::span<const WalkSequence> sequences,
                                   const surefoot::CalibrationOptions& options) {
  std::vector<WalkSequence> finals(sequences.begin(), sequences.end());
  for (WalkSequence& sequence : finals) sequence = final_pose_only(std::move(sequence));
  surefoot::CalibrationOptions robust = options;
  robust.model.loss = surefoot::Loss::huber;
  const auto fit = surefoot::calibrate<M>(finals, robust);
  std::vector<surefoot::Innovation> last;
  std::vector<double> relative, distances;
  for (const WalkSequence& sequence : finals) {
    last.push_back(innovations(fit.model, fit.noise, options.model.accuracy, sequence).back());
    const surefoot::Surprise surprise{last.back().whitened().squaredNorm(), last.back().error.size()};
    const double middle =
        static_cast<double>(surprise.freedoms) * std::pow(1 - 2.0 / (9.0 * static_cast<double>(surprise.freedoms)), 3);
    relative.push_back(surprise.squared / middle);
    distances.push_back(last.back().error.head<2>().norm());
  }
  const double ratio = std::max(median(relative), 1e-9), typical = median(distances);
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < finals.size(); ++i) {
    const surefoot::Surprise surprise{last[i].whitened().squaredNorm() / ratio, last[i].error.size()};
    if (surprise.deviations() > once_in_a_million) {
      sentences.push_back(sentence(finals[i], last[i], distances[i], typical));
    }
  }
  return sentences;
}

}  // namespace

std::vector<std::string> absurd_sequences(std::span<const WalkSequence> sequences,
                                          const surefoot::CalibrationOptions& options) {
  if (sequences.size() < 8) return {};  // too few to say what is typical
  if (sequences.size() < 20) return absurd_by<surefoot::ProportionalCorrection>(sequences, options);
  return absurd_by<surefoot::FullLinearCorrection>(sequences, options);
}

}  // namespace calibrate_program
