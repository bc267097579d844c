#include "compare_report.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "../common/printed.hpp"
#include "compare_words.hpp"

namespace calibrate_program {
namespace {

using Json = nlohmann::ordered_json;
using surefoot::CoefficientComparison;

constexpr double half_interval = 1.96;  // [standard errors] to either side: 95 %

const char* verdict(double probability, double certainty) {
  if (probability >= certainty) return "changed";
  return probability <= 1 - certainty ? "-" : "perhaps";
}

std::vector<std::string_view> changed_coefficients(const ComparedWalks& walks) {
  std::vector<std::string_view> names;
  for (const CoefficientComparison& one : walks.comparison.coefficients) {
    if (one.probability >= walks.certainty) names.push_back(one.info.name);
  }
  return names;
}

/// Where nothing is certain: that nothing was seen, or what may have happened.
std::string nothing_certain(const ComparedWalks& walks) {
  const surefoot::WalkComparison& result = walks.comparison;
  const double nothing = result.posterior.nothing;
  if (nothing >= 0.5) {
    return example::printed(
        "Nothing changed that these sequences could show (probability that nothing changed: %.2f; something is said "
        "from %.2f against it on).\nThe column \"visible from\" tells what would have been found.\n",
        nothing, walks.certainty);
  }
  return example::printed(
      "Something changed with a probability of %.2f, too little for a statement (%.2f): record more sequences.\n"
      "The likeliest: %s\n",
      1 - nothing, walks.certainty, likeliest_change(result, walks.falls).c_str());
}

std::string coefficient_table(const ComparedWalks& walks) {
  std::string text;
  text += example::printed("\n%-22s %10s %10s %10s %24s %12s  %s\n", "coefficient", "old", "new", "difference",
                           "95 % interval", "visible from", "changed?");
  for (const CoefficientComparison& one : walks.comparison.coefficients) {
    const std::string name =
        std::string(one.info.name) + (one.info.unit == "1" ? "" : " [" + std::string(one.info.unit) + "]");
    std::array<char, 40> range{}, smallest{};
    std::snprintf(range.data(), range.size(), "%.3g to %.3g", one.difference - half_interval * one.standard_error,
                  one.difference + half_interval * one.standard_error);
    if (std::isfinite(one.smallest)) std::snprintf(smallest.data(), smallest.size(), "%.2g", one.smallest);
    text += example::printed("%-22s %10.4g %10.4g %10.3g %24s %12s  %s (%.2f)\n", name.c_str(), one.before, one.after,
                             one.difference, range.data(), smallest.data(), verdict(one.probability, walks.certainty),
                             one.probability);
  }
  return text;
}

std::string noise_table(const ComparedWalks& walks) {
  std::string text = "\nNoise, as a multiple of the old one (95 % interval):\n";
  const surefoot::WalkComparison& result = walks.comparison;
  for (const surefoot::NoiseChange& one : result.noise) {
    double probability = 0;
    for (std::size_t i = 0; i < result.changes.size(); ++i) {
      if (result.changes[i].name == one.name) probability = result.posterior.inclusion[static_cast<Eigen::Index>(i)];
    }
    text += example::printed("  %-16s %.2f (%.2f to %.2f)  %s (%.2f)\n", one.name.c_str(), std::sqrt(one.change.ratio),
                             std::sqrt(one.change.low), std::sqrt(one.change.high),
                             verdict(probability, walks.certainty), probability);
  }
  return text;
}

Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json coefficients_json(const ComparedWalks& walks) {
  Json list = Json::array();
  for (const CoefficientComparison& one : walks.comparison.coefficients) {
    list.push_back({{"name", one.info.name},
                    {"unit", one.info.unit},
                    {"old", one.before},
                    {"new", one.after},
                    {"difference", one.difference},
                    {"low", one.difference - half_interval * one.standard_error},
                    {"high", one.difference + half_interval * one.standard_error},
                    {"probability", one.probability},
                    {"changed", one.probability >= walks.certainty},
                    {"smallest_detectable", finite(one.smallest)}});
  }
  return list;
}

Json found_json(const ComparedWalks& walks) {
  Json list = Json::array();
  const auto sentences = change_sentences(walks.comparison, walks.falls);
  for (std::size_t i = 0; i < walks.comparison.found.size(); ++i) {
    const surefoot::FoundChange& found = walks.comparison.found[i];
    Json any = Json::array();
    for (const int change : found.any_of) {
      Json one{{"change", name_of_change(walks.comparison, change)},
               {"probability", walks.comparison.posterior.any_of(std::array{change})}};
      if (change < 0) {
        one["cycles"] = walks.comparison.likeliest.delay;
      } else if (walks.comparison.changes[static_cast<std::size_t>(change)].direction.size() > 0) {
        one["size"] = walks.comparison.size_of(change);
      }
      any.push_back(std::move(one));
    }
    list.push_back({{"any_of", any}, {"probability", found.probability}, {"sentence", sentences[i]}});
  }
  return list;
}

Json noise_json(const surefoot::WalkComparison& result) {
  Json list = Json::array();
  for (const surefoot::NoiseChange& one : result.noise) {
    list.push_back({{"name", one.name},
                    {"old", one.before},
                    {"new", one.after},
                    {"ratio", std::sqrt(one.change.ratio)},
                    {"low", std::sqrt(one.change.low)},
                    {"high", std::sqrt(one.change.high)},
                    {"log_likelihood_ratio", one.change.log_likelihood_ratio}});
  }
  return list;
}

Json joints_json(const std::vector<JointChange>& changes) {
  Json list = Json::array();
  for (const JointChange& one : changes) {
    list.push_back({{"joint", one.joint},
                    {"what", one.what},
                    {"unit", one.unit},
                    {"old", one.before},
                    {"new", one.after},
                    {"difference", one.difference()},
                    {"standard_error", one.standard_error}});
  }
  return list;
}

}  // namespace

std::string compare_report(const ComparedWalks& walks) {
  const surefoot::WalkComparison& result = walks.comparison;
  std::string text;
  text += example::printed("%zu new sequences, compared with %zu old ones.\n\n", walks.after, walks.before);
  if (result.found.empty()) text += nothing_certain(walks);
  for (const std::string& sentence : change_sentences(result, walks.falls)) text += sentence + "\n";
  std::string names;
  for (const std::string_view name : changed_coefficients(walks))
    names += (names.empty() ? "" : ", ") + std::string(name);
  if (!names.empty()) text += "Coefficients that changed: " + names + ".\n";
  if (result.former_delay > 0) {
    text += example::printed("Already the old walk responded later than its commands, by %d cycles.\n",
                             result.former_delay);
  }
  const std::vector<std::string> causes = possible_causes(result);
  if (!causes.empty()) text += "\nWhat can cause it:\n";
  for (const std::string& cause : causes) text += "  " + cause + "\n";
  if (walks.joints) text += joint_report(*walks.joints);
  if (!walks.joints && !causes.empty()) text += "  Logs of the joints tell which joint: --old-joints, --new-joints.\n";
  text += coefficient_table(walks) + noise_table(walks);
  if (walks.falls && !result.falls) text += "\nNo sequence ended early.\n";
  text += example::printed(
      "\nWhole sequences differ %.2f times as much as independent cycles would (variance); it was counted with.\n",
      result.inflation);
  return text;
}

std::string compare_json(const ComparedWalks& walks) {
  const surefoot::WalkComparison& result = walks.comparison;
  Json json{{"schema", "surefoot.compare/1"},
            {"changed", !result.found.empty()},
            {"certainty", walks.certainty},
            {"probability_nothing_changed", result.posterior.nothing},
            {"found", found_json(walks)},
            {"changed_coefficients", changed_coefficients(walks)},
            {"coefficients", coefficients_json(walks)},
            {"noise", noise_json(result)},
            {"delay_cycles", result.likeliest.delay},
            {"former_delay_cycles", result.former_delay},
            {"inflation", result.inflation},
            {"sequences", {{"old", walks.before}, {"new", walks.after}}}};
  if (walks.joints) {
    json["joints"] = {{"changed", joints_json(walks.joints->changed)},
                      {"shifted", joints_json(walks.joints->shifted)},
                      {"common", joints_json(walks.joints->common)},
                      {"all", joints_json(walks.joints->all)}};
  }
  if (walks.falls) {
    json["falls"] = {{"old", walks.falls->before.fell},
                     {"of_old", walks.falls->before.sequences},
                     {"new", walks.falls->after.fell},
                     {"of_new", walks.falls->after.sequences},
                     {"p_value", result.falls ? Json(result.falls->p_value) : Json(nullptr)}};
  }
  return json.dump(1) + "\n";
}

}  // namespace calibrate_program
