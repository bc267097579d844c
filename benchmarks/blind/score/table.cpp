#include "table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>

#include "reliability.hpp"

namespace score {
namespace {

double median(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::string percent(const Share& share) {
  if (share.of == 0) return "-";
  char text[48];
  std::snprintf(text, sizeof text, "%.1f %% (%d/%d)", 100.0 * share.hits / share.of, share.hits, share.of);
  return text;
}

std::string decimal(double value, const char* format) {
  if (!std::isfinite(value)) return "-";
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

const std::vector<std::string> verdicts{"adequate", "parameters-only", "missing-physics", "unexplained"};
const std::vector<std::string> kinds{"nothing", "one", "two", "outside"};

void print_confusion(const std::vector<Outcome>& outcomes) {
  std::map<std::string, std::map<std::string, std::map<std::string, int>>> counts;  // family, kind, verdict
  for (const Outcome& outcome : outcomes) ++counts[outcome.truth->family][outcome.truth->kind][outcome.answer.verdict];
  std::printf("Verdicts (rows: ground truth)\n%-12s %-10s", "family", "kind");
  for (const std::string& verdict : verdicts) std::printf(" %16s", verdict.c_str());
  std::printf("\n");
  for (auto& [family, rows] : counts)
    for (const std::string& kind : kinds) {
      if (!rows.contains(kind)) continue;
      std::printf("%-12s %-10s", family.c_str(), kind.c_str());
      for (const std::string& verdict : verdicts) std::printf(" %16d", rows[kind][verdict]);
      std::printf("\n");
    }
}

void print_by_effect(const std::vector<Outcome>& outcomes) {
  struct Row {
    Share detected, first;
    std::vector<double> errors;
    std::map<std::string, int> taken_for;
  };
  std::map<std::string, Row> rows;
  for (const Outcome& outcome : outcomes) {
    if (outcome.truth->kind != "one") continue;
    Row& row = rows[outcome.truth->effects[0].name];
    row.detected.add(outcome.detected);
    row.first.add(outcome.named_first);
    row.errors.insert(row.errors.end(), outcome.parameter_errors.begin(), outcome.parameter_errors.end());
    if (!outcome.named_first) {
      ++row.taken_for[outcome.answer.effects.empty() ? outcome.answer.verdict : outcome.answer.effects[0].name];
    }
  }
  std::printf("\nCases with one effect\n%-26s %10s %10s %12s  taken for\n", "effect", "detected", "right",
              "parameters");
  for (const auto& [name, row] : rows) {
    std::printf("%-26s %6d/%-3d %6d/%-3d %12s ", name.c_str(), row.detected.hits, row.detected.of, row.first.hits,
                row.first.of, decimal(100 * median(row.errors), "%.1f %%").c_str());
    for (const auto& [other, count] : row.taken_for) std::printf(" %s (%d)", other.c_str(), count);
    std::printf("\n");
  }
}

std::string joined(const std::vector<Effect>& effects) {
  std::string text;
  for (const Effect& effect : effects)
    text += (text.empty() ? "" : " + ") + effect.name + (effect.attached_to.empty() ? "" : " at " + effect.attached_to);
  return text.empty() ? "nothing" : text;
}

void print_wrong(const std::vector<Outcome>& outcomes) {
  std::printf("\nWrong cases\n");
  for (const Outcome& outcome : outcomes) {
    const std::string what = complaint(outcome);
    if (what.empty()) continue;
    std::printf("%s %-10s %-24s strength %5.1f | hidden: %s | said: %s, %s", outcome.truth->name.c_str(),
                outcome.truth->family.c_str(), what.c_str(), outcome.truth->strength,
                joined(outcome.truth->effects).c_str(), outcome.answer.verdict.c_str(),
                joined(outcome.answer.effects).c_str());
    for (const Alternative& other : outcome.answer.alternatives)
      if (other.indistinguishable) std::printf(" = %s", joined(other.effects).c_str());
    std::printf(" | error %s x true\n", decimal(outcome.error_ratio, "%.2f").c_str());
  }
}

}  // namespace

Summary summarize(const std::string& method, const std::vector<Outcome>& outcomes, std::size_t cases) {
  static const std::set<std::string> planar{"ground_slope", "slip_saturation", "cross_coupling", "body_drift"};
  Summary summary;
  summary.method = method;
  summary.done = outcomes.size();
  summary.cases = cases;
  std::vector<double> errors, ratios, seconds, sizes;
  for (const Outcome& outcome : outcomes) {
    const std::string& kind = outcome.truth->kind;
    seconds.push_back(outcome.answer.seconds);
    if (kind == "nothing") summary.false_alarm.add(outcome.detected);
    if (kind == "outside") {
      summary.unexplained.add(outcome.answer.verdict == "unexplained");
      summary.misnamed.add(outcome.answer.verdict == "missing-physics");
    }
    if (kind != "outside") {
      summary.structure.add(outcome.structure_right);
      summary.finished_structure.add(outcome.structure_right && outcome.answer.verdict != "search-not-finished");
    }
    if (std::isfinite(outcome.error_ratio)) summary.against_noise.add(outcome.against_noise);
    if (kind != "one" && kind != "two") continue;
    summary.detected.add(outcome.detected);
    summary.named_first.add(outcome.named_first);
    summary.named_in_three.add(outcome.named_in_three);
    if (outcome.named_first) summary.attached.add(outcome.attached);
    if (kind == "two") summary.both_named.add(outcome.all_named);
    summary.no_superfluous.add(outcome.superfluous == 0);
    if (outcome.truth->family == "walk_final" && kind == "one" && planar.contains(outcome.truth->effects[0].name)) {
      summary.final_poses.add(outcome.named_first);
    }
    errors.insert(errors.end(), outcome.parameter_errors.begin(), outcome.parameter_errors.end());
    ratios.push_back(outcome.error_ratio);
    sizes.push_back(outcome.class_size);
  }
  const std::vector<Statement> statements = statements_of(outcomes);
  summary.stated = statements.size();
  summary.calibration_error = expected_calibration_error(bins_of(statements));
  for (double size : sizes) summary.class_size += size / static_cast<double>(sizes.size());
  summary.parameter_error = median(errors);
  summary.error_ratio = median(ratios);
  summary.seconds = median(seconds);
  for (double value : seconds) summary.seconds_most = std::max(summary.seconds_most, value);
  return summary;
}

void print_details(const std::vector<Outcome>& outcomes) {
  print_confusion(outcomes);
  print_by_effect(outcomes);
  print_wrong(outcomes);
}

void print_summaries(const std::vector<Summary>& summaries) {
  std::printf("\n%-46s %-12s", "", "required");
  for (const Summary& summary : summaries) std::printf(" %-22s", summary.method.c_str());
  std::printf("\n");
  const auto row = [&](const char* what, const char* required, auto&& text) {
    std::printf("%-46s %-12s", what, required);
    for (const Summary& summary : summaries) std::printf(" %-22s", std::string(text(summary)).c_str());
    std::printf("\n");
  };
  row("cases done", ">= 200",
      [](const Summary& s) { return std::to_string(s.done) + " of " + std::to_string(s.cases); });
  row("false alarms, nothing missing", "<= 2 %", [](const Summary& s) { return percent(s.false_alarm); });
  row("effect detected", ">= 95 %", [](const Summary& s) { return percent(s.detected); });
  row("right name first, or in the declared class", ">= 90 %", [](const Summary& s) { return percent(s.named_first); });
  row("mean size of the class", "", [](const Summary& s) { return decimal(s.class_size, "%.2f"); });
  row("right name among the first three", ">= 98 %", [](const Summary& s) { return percent(s.named_in_three); });
  row("right attachment, of right names", ">= 90 %", [](const Summary& s) { return percent(s.attached); });
  row("both named, of two effects", "", [](const Summary& s) { return percent(s.both_named); });
  row("no superfluous name", "", [](const Summary& s) { return percent(s.no_superfluous); });
  row("median parameter error, same formula", "<= 5 %",
      [](const Summary& s) { return decimal(100 * s.parameter_error, "%.1f %%"); });
  row("held-out error / true model's, median", "<= 1.10",
      [](const Summary& s) { return decimal(s.error_ratio, "%.3f"); });
  row("outside the library: unexplained", ">= 80 %", [](const Summary& s) { return percent(s.unexplained); });
  row("outside the library: misnamed", "<= 10 %", [](const Summary& s) { return percent(s.misnamed); });
  row("final poses only: four planar effects", ">= 80 %", [](const Summary& s) { return percent(s.final_poses); });
  row("structure right, first or in the class", "", [](const Summary& s) { return percent(s.structure); });
  row("the same, and the search finished", "", [](const Summary& s) { return percent(s.finished_structure); });
  row("called explained above 1.5 x the noise", "0 %", [](const Summary& s) { return percent(s.against_noise); });
  row("probabilities stated", "", [](const Summary& s) { return std::to_string(s.stated); });
  row("expected calibration error", "", [](const Summary& s) { return decimal(s.calibration_error, "%.3f"); });
  row("seconds, median", "", [](const Summary& s) { return decimal(s.seconds, "%.2f"); });
  row("seconds, most", "", [](const Summary& s) { return decimal(s.seconds_most, "%.1f"); });
}

}  // namespace score
