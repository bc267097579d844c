// Truth and answers as the scorer reads them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace score {

struct Effect {
  std::string name, attached_to;
  std::vector<std::string> also_accepted = {};  // truth only: other names of the same place
  /// Truth only: names and places of which no test on the recordings could tell it.
  std::vector<std::pair<std::string, std::string>> equivalents = {};
  bool same_formula = false;  // truth only: parameters can be compared
  std::map<std::string, double> parameters = {};
};

struct Truth {
  std::string name, family, kind;  // kind: nothing, one, two, outside
  std::vector<Effect> effects;
  std::map<std::string, double> noise;  // output -> standard deviation, in the output's unit
  std::map<std::string, double> rmse;   // recording -> error of the true model, in standard deviations of the noise
  std::map<std::string, double> floor;  // recording -> the same with outliers in it, as a held-out error may have them
  std::map<std::string, double> calibrated;  // recording -> error of the calibrated model without effects, likewise
  double strength = 1;
};

struct Alternative {
  std::vector<Effect> effects;
  bool indistinguishable = false;
};

/// A structure and the probability that is stated for it.
struct Stated {
  std::vector<Effect> effects;
  double probability = 0;
};

struct Answer {
  std::string verdict;
  std::vector<Effect> effects;  // without effects of the noise
  std::vector<Alternative> alternatives;
  std::vector<std::string> test;             // names of the recordings kept for the test
  std::map<std::string, double> rmse_after;  // output -> held-out error, in the output's unit
  double before = 0, after = 0;              // held-out errors in the method's own scale
  std::vector<Stated> structures;            // the chosen one first; empty: no probabilities are stated
  double noise_ratio = 0;                    // held-out error over the noise floor as stated; NaN: not stated
  double seconds = 0;
  bool complete = true;
};

std::vector<Truth> read_truths(const std::filesystem::path& folder);

/// Nothing if there is no such file; throws a sentence if it cannot be understood.
std::optional<Answer> read_answer(const std::filesystem::path& file);

}  // namespace score
