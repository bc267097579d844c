#include "report.hpp"

#include <algorithm>
#include <cmath>

#include "html.hpp"
#include "progress.hpp"
#include "report_style.hpp"
#include "wording.hpp"
#include "write_json.hpp"

namespace diagnose_program {
namespace {

using surefoot::Diagnosis;
using surefoot::Verdict;

std::string paragraph(const std::string& text) { return text.empty() ? "" : element("p", text) + "\n"; }

std::string row(const std::vector<std::string>& cells, const std::string& tag = "td") {
  std::string result = "<tr>";
  for (const std::string& cell : cells) result += element(tag, cell);
  return result + "</tr>\n";
}

std::string tile(const std::string& value, const std::string& what) {
  return "<div class=\"tile\"><b>" + escaped(value) + "</b><span>" + escaped(what) + "</span></div>\n";
}

std::string verdict_part(const Diagnosis& d) {
  std::string html = "<header class=\"verdict " + verdict_text(d.verdict) + "\">\n<p class=\"model\">Diagnosis of " +
                     escaped(d.model) + "</p>\n" + element("h1", headline(d.verdict)) + "\n";
  if (!d.complete) html += "<p><strong>The search was stopped, or ran out of its budget: this is what was known by then.</strong></p>\n";
  if (!d.sentence.empty()) html += "<p class=\"lead\">" + escaped(d.sentence) + "</p>\n";
  html += "</header>\n<div class=\"tiles\">\n";
  const bool effects = !d.effects.empty();
  html +=
      tile(rounded(d.held_out_before), effects ? "error before, calibrated model" : "error of the calibrated model");
  if (effects) html += tile(rounded(d.held_out_after), "error after, with the effects");
  if (std::isfinite(d.held_out_forest))
    html += tile(rounded(d.held_out_forest), "error of a forest instead of effects");
  if (std::isfinite(d.noise_ratio)) {
    html += tile(rounded(d.noise_floor), "noise floor");
    html += tile(rounded(d.noise_ratio), "times the noise: of each output over its own, root mean square");
  }
  html += tile(std::to_string(d.held_out.size()), "held-out recordings, for these figures");
  return html +
         "</div>\n<p class=\"note\">Errors are those of whole simulations, of each recording with parameters that were "
         "fitted to others, in units of the noise, or of the standard deviation of the output where the noise is "
         "unknown.</p>\n";
}

std::string log_faults_part(const Diagnosis& d) {
  if (d.log_faults.empty()) return "";
  std::string html =
      "<h2>Faults of the log</h2>\n<p>Not of the machine, but they would pass for missing physics:</p>\n<ul>\n";
  for (const auto& fault : d.log_faults) html += element("li", fault_text(fault)) + "\n";
  return html + "</ul>\n";
}

std::string where_part(const Diagnosis& d, const std::string& unit) {
  if (d.regions.empty() && d.channels.empty() && d.intervals.empty()) return "";
  std::string html = d.regions.empty() ? "<h2>How far the model is off</h2>\n" : "<h2>Where the model is off</h2>\n";
  for (const auto& region : d.regions) {
    html += "<p><span class=\"rule\">" + escaped(region.rule) + "</span>: " + percent(region.share_of_excess) +
            " of the excess error in " + percent(region.share_of_samples) + " of the samples (" +
            escaped(p_text(region.p_value)) + ").</p>\n";
  }
  if (!d.channels.empty()) {
    const bool effects = !d.effects.empty();
    html +=
        "<table>\n" + row({"output", "nominal", "calibrated", effects ? "with effects" : "noise", "by chance"}, "th");
    for (const auto& channel : d.channels) {
      const std::string unit = channel.unit.empty() || channel.unit == "1" ? "" : " " + channel.unit;
      html += row({channel.output, rounded(channel.rmse_nominal) + unit, rounded(channel.rmse_calibrated) + unit,
                   rounded(effects ? channel.rmse_after : channel.noise) + unit, p_text(channel.p_value)});
    }
    html +=
        "</table>\n<p class=\"note\">Root mean square errors on held-out recordings; \"by chance\": the "
        "probability that the "
        "calibrated model is off like this by noise alone.</p>\n";
  }
  constexpr std::size_t most = 8;
  if (!d.intervals.empty()) html += "<p>Stretches that hold most of it:</p>\n<ul>\n";
  for (std::size_t i = 0; i < std::min(most, d.intervals.size()); ++i) {
    const auto& one = d.intervals[i];
    html += element("li", one.recording + " from " + rounded(one.from, 4) + " to " + rounded(one.to, 4) + unit + ": " +
                              percent(one.share_of_excess)) +
            "\n";
  }
  return html + (d.intervals.empty() ? "" : "</ul>\n");
}

std::string what_part(const Diagnosis& d) {
  if (d.effects.empty()) return "";
  std::string html = "<h2>What is missing</h2>\n";
  for (const auto& effect : d.effects) {
    html += "<div class=\"card\">" + element("h3", effect.sentence.empty() ? effect.name : effect.sentence) +
            "<p class=\"note\">" +
            escaped(effect.name + (effect.form.empty() ? "" : " (" + effect.form + ")") + " at " + effect.attached_to) +
            "</p>\n<table>\n";
    for (const auto& fit : effect.parameters) html += row({fit.name, with_interval(fit)});
    html += "</table>\n" +
            element("p", "Takes away " + percent(effect.evidence.gain) + " of the error (standard error " +
                             percent(effect.evidence.gain_stderr) + "), " + p_text(effect.evidence.p_value) +
                             "; chosen in " + percent(effect.evidence.confidence) + " of the repetitions.") +
            "</div>\n";
  }
  return html;
}

std::string limits_part(const Diagnosis& d) {
  if (d.limits.empty()) return "";
  std::string html =
      "<h2>What would have been seen</h2>\n<p>The smallest effect of each kind that these recordings would have "
      "shown:</p>\n<table>\n";
  html += row({"effect", "at", "smallest"}, "th");
  for (const auto& limit : d.limits) {
    const std::string unit = limit.smallest.unit.empty() || limit.smallest.unit == "1" ? "" : " " + limit.smallest.unit;
    html += row({limit.name, limit.attached_to, limit.smallest.name + " " + rounded(limit.smallest.value, 2) + unit});
  }
  return html + "</table>\n";
}

std::string curves_part(const Diagnosis& d, const std::vector<Picture>& pictures) {
  std::string html;
  if (!pictures.empty())
    html += std::string(d.effects.empty() ? "<h2>Simulated and measured, held-out recordings</h2>"
                                          : "<h2>Before and after, held-out recordings</h2>") +
            "\n<div class=\"charts\">\n";
  for (const Picture& picture : pictures) {
    html += "<figure>" + element("figcaption", picture.caption) + picture.svg + "</figure>\n";
  }
  if (!pictures.empty()) html += "</div>\n";
  if (d.per_recording.empty()) return html;
  const bool effects = !d.effects.empty();
  html += "<h2>Error of each held-out recording</h2>\n<table>\n" +
          row(effects ? std::vector<std::string>{"recording", "before", "after", "ratio"}
                      : std::vector<std::string>{"recording", "error"},
              "th");
  for (const auto& one : d.per_recording) {
    std::vector<std::string> cells{one.recording, rounded(one.before)};
    if (effects) cells.insert(cells.end(), {rounded(one.after), rounded(one.after / one.before, 2)});
    html += row(cells);
  }
  html += "</table>\n";
  if (effects && d.gain_high > 0) {
    html += paragraph("After over before, 95 % interval over recordings: " + rounded(d.gain_low, 2) + " to " +
                      rounded(d.gain_high, 2) + ".");
  }
  return html;
}

std::string ranking_part(const Diagnosis& d) {
  if (d.alternatives.empty()) return "";
  struct Entry {
    std::string name, kind, remark;
    double error;
  };
  std::vector<std::pair<std::string, std::string>> chosen;
  for (const auto& effect : d.effects) chosen.emplace_back(effect.name, effect.attached_to);
  std::vector<Entry> entries;
  for (const auto& one : d.alternatives) {
    entries.push_back({effects_text(one.effects), "other", one.indistinguishable ? "cannot be told apart" : "",
                       one.fitted_rmse});
  }
  double worst = 0;
  for (const Entry& entry : entries) worst = std::isfinite(entry.error) ? std::max(worst, entry.error) : worst;
  std::ranges::stable_sort(entries, {}, &Entry::error);
  std::string html = "<h2>Other candidates</h2>\n";
  if (!chosen.empty()) html += paragraph("Chosen: " + effects_text(chosen) + ". What else was tried, best first:");
  html += "<table>\n<tr><th>effects</th><th>error</th><th class=\"bar\"></th><th>remark</th></tr>\n";
  for (const Entry& entry : entries) {
    const double share = worst > 0 && std::isfinite(entry.error) ? 100 * entry.error / worst : 0;
    html += "<tr>" + element("td", entry.name) + element("td", rounded(entry.error)) +
            "<td class=\"bar\"><div class=\"" + (entry.remark.empty() ? "" : "chosen") +
            "\" style=\"width:" + rounded(share) + "%\"></div></td>" + element("td", entry.remark) + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string next_part(const Diagnosis& d) {
  const auto twin = [](const auto& one) { return one.indistinguishable; };
  if (d.next_experiment.empty() && std::ranges::none_of(d.alternatives, twin)) return "";
  std::string html = "<h2>What these recordings cannot tell apart</h2>\n";
  if (std::ranges::any_of(d.alternatives, twin)) html += "<p>These would explain them as well:</p>\n<ul>\n";
  for (const auto& one : d.alternatives) {
    if (one.indistinguishable) html += element("li", effects_text(one.effects)) + "\n";
  }
  if (std::ranges::any_of(d.alternatives, twin)) html += "</ul>\n";
  if (!d.next_experiment.empty())
    html += "<p><strong>Next experiment:</strong> " + escaped(d.next_experiment) + "</p>\n";
  return html;
}

std::string forest_part(const surefoot::ForestResidual& forest) {
  if (!forest.tried) return "";
  std::string html = "<h2>A forest in place of physics</h2>\n";
  const std::string figures = "On held-out recordings the error is " + rounded(forest.held_out_after) +
                              " with it and " + rounded(forest.held_out_before) + " without.";
  if (!forest.kept) {
    return html + paragraph(
                      "A forest that corrects the simulated outputs by what it learned from the residuals is not kept: "
                      "where each recording of the fit is left out in turn it takes away " +
                      percent(forest.gain) + " (standard error " + percent(forest.gain_stderr) + "). " + figures);
  }
  return html + paragraph(std::string(residual_file) +
                          " corrects the simulated outputs by what a forest learned from the residuals: no explanation,"
                          " but closer. " +
                          figures + " In simulations of other recordings it has not seen it took away " +
                          percent(forest.gain) + " (standard error " + percent(forest.gain_stderr) + ").");
}

std::string noise_part(const Diagnosis& d) {
  if (d.noise_findings.empty()) return "";
  std::string html = "<h2>What the noise is like</h2>\n";
  for (const auto& noise : d.noise_findings) {
    html +=
        "<div class=\"card\">" + element("h3", noise.sentence) + element("p class=\"note\"", noise.name) + "<table>\n";
    for (const auto& fit : noise.parameters) html += row({fit.name, with_interval(fit)});
    html += "</table>\n" +
            element("p", "Log-likelihood on recordings not used for the fit: " + rounded(noise.gain, 2) +
                             " more per sample than without it, " + p_text(noise.p_value) + ".") +
            "</div>\n";
  }
  return html;
}

std::string parameters_part(const Diagnosis& d) {
  const auto& fitted = d.augmented_parameters.empty() ? d.parameters : d.augmented_parameters;
  if (fitted.empty()) return "";
  const bool effects = !d.augmented_parameters.empty();
  std::string html =
      "<h2>Parameters</h2>\n<table>\n" +
      row({"parameter", "in the model file", effects ? "calibrated, with the effects (95 %)" : "calibrated (95 %)"},
          "th");
  for (const auto& parameter : fitted) {
    const std::string unit = parameter.fit.unit.empty() || parameter.fit.unit == "1" ? "" : " " + parameter.fit.unit;
    html +=
        row({parameter.fit.name, rounded(parameter.nominal) + unit,
             parameter.fixed ? "fixed" : with_interval(parameter.fit) + (parameter.at_bound ? ", at its bound" : "")});
  }
  html += "</table>\n";
  for (const auto& effect : d.known_effects) {
    std::string text = "The model has " + effect.name + " at " + effect.attached_to + " already";
    for (const auto& fit : effect.parameters) text += ", " + fit.name + " " + with_interval(fit);
    html += paragraph(text + ".");
  }
  for (const std::string& pair : d.correlated) html += paragraph("Hardly separated by these recordings: " + pair + ".");
  return html + paragraph(d.noise_sentence);
}

std::string list_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 30;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (text.empty() ? "" : ", ") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text.empty() ? "none" : text;
}

std::string remarks_part(const Diagnosis& d) {
  std::string html = "<h2>The recordings</h2>\n";
  html += paragraph("To fit: " + list_of(d.fit) + ".") + paragraph("To choose: " + list_of(d.select) + ".") +
          paragraph("Held out: " + list_of(d.held_out) + ".");
  constexpr std::size_t most = 40;
  if (!d.remarks.empty()) html += "<ul>\n";
  for (std::size_t i = 0; i < std::min(most, d.remarks.size()); ++i) {
    const auto& remark = d.remarks[i];
    html += element("li", (remark.recording.empty() ? "" : remark.recording + ": ") + remark.text) + "\n";
  }
  if (d.remarks.size() > most)
    html += element("li", std::to_string(d.remarks.size() - most) + " more in diagnosis.json");
  return html + (d.remarks.empty() ? "" : "</ul>\n");
}

}  // namespace

Report make_report(const Diagnosis& d, const surefoot::SimulatorInfo& info) {
  Report report{{}, curve_pictures(d, info)};
  report.html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(d.model) + ": " + escaped(headline(d.verdict)) + "</title>\n<style>" + report_style +
      "</style>\n</head>\n<body>\n<main>\n" + verdict_part(d) + log_faults_part(d) +
      where_part(d, info.kind == surefoot::SimulatorKind::ode ? " s" : "") + what_part(d) + limits_part(d) +
      curves_part(d, report.pictures) + ranking_part(d) + next_part(d) + forest_part(d.forest_residual) +
      parameters_part(d) + noise_part(d) + remarks_part(d) + "<footer>" +
      escaped("Computed in " + duration_text(d.seconds) + " with seed " + std::to_string(d.seed) + ".") +
      "</footer>\n</main>\n</body>\n</html>\n";
  return report;
}

}  // namespace diagnose_program
