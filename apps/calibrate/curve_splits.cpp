#include "curve_splits.hpp"

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "../common/files.hpp"

namespace calibrate_program {
namespace {

/// FNV-1a of the bits of numbers.
void mix(std::uint64_t& hash, double number) {
  const auto bits = std::bit_cast<std::uint64_t>(number);
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ ((bits >> (8 * byte)) & 0xFF)) * 1'099'511'628'211ULL;
}

std::string exact(double number) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), end};
}

/// Takes the number before the next comma or the end; none where there is none.
template <class Number>
std::optional<Number> take(std::string_view& line) {
  Number number{};
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
  if (error != std::errc()) return std::nullopt;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  if (line.starts_with(',')) line.remove_prefix(1);
  return number;
}

}  // namespace

std::string curve_fingerprint(const surefoot::AnyMotionModel& model, std::span<const surefoot::WalkSequence> sequences,
                              const surefoot::LearningCurveOptions& options, std::uint64_t seed) {
  std::uint64_t hash = 14'695'981'039'346'656'037ULL;
  for (const surefoot::WalkSequence& sequence : sequences) {
    for (const double number : sequence.commands.reshaped()) mix(hash, number);
    for (const double number : sequence.poses.reshaped()) mix(hash, number);
    for (const double number : sequence.command_before) mix(hash, number);
  }
  const surefoot::PredictorOptions& predictor = options.predictor;
  for (const double number :
       {predictor.published.heading_tolerance, predictor.published.heading_weight,
        predictor.calibration.model.accuracy.position, predictor.calibration.model.accuracy.heading,
        predictor.calibration.model.accuracy.heading_tolerance}) {
    mix(hash, number);
  }
  std::ostringstream text;
  text << "# splits of surefoot-calibrate curve 1: " << model.name() << ", seed " << seed << ", validation "
       << options.validation << ", method " << static_cast<int>(predictor.method) << ", counts";
  for (const std::size_t count : options.counts) text << ' ' << count;
  text << ", data and accuracy " << std::hex << hash;
  return text.str();
}

CurveSplits::CurveSplits(std::filesystem::path file, const std::string& fingerprint, std::vector<std::size_t> counts)
    : counts_(std::move(counts)) {
  std::istringstream old(exists(file) ? example::read_text(file) : "");
  std::string line;
  if (std::getline(old, line) && line == fingerprint) {
    while (std::getline(old, line) && !old.eof()) {
      std::string_view rest = line;
      const auto repetition = take<std::size_t>(rest), count = take<std::size_t>(rest);
      surefoot::SplitResult result;
      const auto position = take<double>(rest);
      std::vector<double> parameters;
      while (const auto parameter = take<double>(rest)) parameters.push_back(*parameter);
      if (!repetition || !count || !position || parameters.empty()) break;
      std::vector<surefoot::SplitResult>& split = known_[*repetition];
      if (split.size() >= counts_.size() || counts_[split.size()] != *count) break;
      result.position = *position;
      result.parameters = Eigen::VectorXd::Map(parameters.data(), static_cast<Eigen::Index>(parameters.size()));
      split.push_back(std::move(result));
    }
  }
  std::erase_if(known_, [&](const auto& split) { return split.second.size() != counts_.size(); });
  std::string text = fingerprint + "\n";
  for (const auto& [repetition, split] : known_) text += rows(repetition, split);
  example::write_text(file, text);
  out_.open(file, std::ios::app);
}

std::optional<std::vector<surefoot::SplitResult>> CurveSplits::known(std::size_t repetition) const {
  const auto found = known_.find(repetition);
  if (found == known_.end()) return std::nullopt;
  return found->second;
}

void CurveSplits::add(std::size_t repetition, const std::vector<surefoot::SplitResult>& result) {
  out_ << rows(repetition, result) << std::flush;
}

std::string CurveSplits::rows(std::size_t repetition, const std::vector<surefoot::SplitResult>& result) const {
  std::string text;
  for (std::size_t i = 0; i < result.size(); ++i) {
    text += std::to_string(repetition) + ',' + std::to_string(counts_[i]) + ',' + exact(result[i].position);
    for (const double parameter : result[i].parameters) text += ',' + exact(parameter);
    text += '\n';
  }
  return text;
}

}  // namespace calibrate_program
