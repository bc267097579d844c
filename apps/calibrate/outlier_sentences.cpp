#include "outlier_sentences.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "surefoot/motion/linear_correction.hpp"
#include "surefoot/motion/outliers.hpp"

namespace calibrate_program {
namespace {

using surefoot::WalkSequence;

constexpr std::size_t least_sequences = 8;        // fewer do not tell what is typical
constexpr std::size_t enough_for_all_terms = 20;  // sequences for the full model

std::string sentence(const WalkSequence& sequence, const surefoot::SequenceOutlier& outlier) {
  constexpr double far = 2.5;  // [typical distances] from where the position itself is what is wrong
  char text[200];
  const auto cut = sequence.name.substr(0, 80);
  if (outlier.distance > far * outlier.typical) {
    std::snprintf(text, sizeof text, "sequence %s ends %.2f m from where the model puts it, %.2f m is typical",
                  cut.c_str(), outlier.distance, outlier.typical);
  } else {
    std::snprintf(text, sizeof text, "sequence %s ends %.0f degrees turned from where the model puts it", cut.c_str(),
                  std::abs(outlier.turned) * 180 / std::numbers::pi);
  }
  return std::string(text) + ": a wrong reading? It was kept";
}

}  // namespace

std::vector<std::string> outlier_sentences(std::span<const WalkSequence> sequences,
                                           const surefoot::CalibrationOptions& options) {
  if (sequences.size() < least_sequences) return {};
  const surefoot::AnyMotionModel model = sequences.size() < enough_for_all_terms
                                             ? surefoot::AnyMotionModel(surefoot::ProportionalCorrection())
                                             : surefoot::AnyMotionModel(surefoot::FullLinearCorrection());
  std::vector<std::string> sentences;
  for (const surefoot::SequenceOutlier& outlier : surefoot::find_outliers(model, sequences, options)) {
    sentences.push_back(sentence(sequences[outlier.sequence], outlier));
  }
  return sentences;
}

}  // namespace calibrate_program
