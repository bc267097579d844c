#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "../chart.hpp"
#include "../html.hpp"
#include "../progress.hpp"
#include "../report_style.hpp"
#include "../wording.hpp"
#include "../write_json.hpp"
#include "findings.hpp"
#include "robot_files.hpp"

namespace diagnose_robot {
namespace {

using diagnose_program::element;
using diagnose_program::escaped;
using diagnose_program::percent;
using diagnose_program::rounded;

std::string row(const std::vector<std::string>& cells, const std::string& tag = "td") {
  std::string result = "<tr>";
  for (const std::string& cell : cells) result += element(tag, cell);
  return result + "</tr>\n";
}

std::string tile(double value, const std::string& what) {
  return "<div class=\"tile\"><b>" + rounded(value) + "</b><span>" + escaped(what) + "</span></div>\n";
}

std::string with_unit(double value, const std::string& unit) {
  return rounded(value) + (unit == "1" ? "" : " " + unit);
}

std::string head_part(const RobotDiagnosis& d) {
  const auto& c = d.common;
  std::string html = "<header class=\"verdict " + diagnose_program::verdict_text(c.verdict) +
                     "\">\n<p class=\"model\">Diagnosis of " + escaped(c.model) + "</p>\n" +
                     element("h1", diagnose_program::headline(c.verdict)) + "\n<p class=\"lead\">" +
                     escaped(c.sentence) + "</p>\n</header>\n<div class=\"tiles\">\n";
  html += tile(d.textbook, "rigid bodies alone") + tile(d.nominal, "the file as it stands") +
          tile(d.after, "with what was found") + tile(d.held_out, "the same, on blocks held out") +
          tile(d.noise, "noise floor");
  if (std::isfinite(d.replayed)) html += tile(d.replayed, "augmented.xml, replayed in MuJoCo");
  return html + "</div>\n<p class=\"note\">" +
         (d.torque_driven
              ? "Root mean square torque along the measured motion that the model leaves, as a share of the drives' "
                "torque.</p>\n"
              : "Root mean square errors of the joint angles over simulations of whole recordings [rad].</p>\n");
}

std::string faults_part(const RobotDiagnosis& d) {
  if (d.common.log_faults.empty()) return "";
  std::string html = "<h2>Faults of the log</h2>\n<ul>\n";
  for (const auto& fault : d.common.log_faults) html += element("li", diagnose_program::fault_text(fault)) + "\n";
  return html + "</ul>\n";
}

std::string effects_part(const RobotDiagnosis& d) {
  if (d.common.effects.empty()) return "";
  std::string html = "<h2>What is missing</h2>\n<table>\n" +
                     row({"effect", "at", "size (95 %)", "error of its joints", "confidence"}, "th");
  for (const auto& effect : d.common.effects) {
    html += row({effect.name, effect.attached_to, diagnose_program::with_interval(effect.parameters.front()),
                 "-" + percent(effect.evidence.gain) + " held out", percent(effect.evidence.confidence)});
  }
  return html + "</table>\n";
}

// Joint by effect: the darker, the more of the joint's error goes with it.
std::string shares_svg(const RobotDiagnosis& d) {
  constexpr double cell = 34, left = 150, top = 150;
  const auto columns = static_cast<double>(d.effect_columns.size()), rows = static_cast<double>(d.joints.size());
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(),
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" style=\"max-width:%.0fpx\" "
                "role=\"img\"><title>Error by joint and "
                "effect</title><style>text{font:12px system-ui,sans-serif;fill:#333}</style>",
                left + cell * columns + 40, top + cell * rows + 10, left + cell * columns + 40);
  std::string svg = text.data();
  for (std::size_t c = 0; c < d.effect_columns.size(); ++c) {
    const double x = left + cell * (static_cast<double>(c) + 0.6);
    std::snprintf(text.data(), text.size(), "<text transform=\"translate(%.1f %.1f) rotate(-50)\">", x, top - 6);
    svg += text.data() + escaped(d.effect_columns[c]) + "</text>";
  }
  for (std::size_t j = 0; j < d.joints.size(); ++j) {
    const double y = top + cell * static_cast<double>(j);
    std::snprintf(text.data(), text.size(), "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"end\">", left - 8,
                  y + cell * 0.62);
    svg += text.data() + escaped(d.joints[j].joint) + "</text>";
    for (std::size_t c = 0; c < d.effect_columns.size(); ++c) {
      const double share = d.shares(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(c));
      const double strength = std::clamp(share, 0.0, 1.0);
      std::snprintf(text.data(), text.size(),
                    "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.0f\" height=\"%.0f\" fill=\"rgb(%.0f,%.0f,%.0f)\"/>",
                    left + cell * static_cast<double>(c), y, cell - 2, cell - 2, 240 - 217 * strength,
                    243 - 140 * strength, 246 - 65 * strength);
      svg += text.data();
      if (share < 0.01) continue;
      std::snprintf(
          text.data(), text.size(), "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\" style=\"fill:%s\">%.0f</text>",
          left + cell * (static_cast<double>(c) + 0.47), y + cell * 0.62, share > 0.5 ? "#fff" : "#333", 100 * share);
      svg += text.data();
    }
  }
  return svg + "</svg>";
}

std::string joints_part(const RobotDiagnosis& d) {
  std::string html = "<h2>Error by joint</h2>\n<table>\n" +
                     row({"joint", "group", "rigid bodies", "file", "after", "held out", "noise"}, "th");
  for (const JointError& joint : d.joints) {
    html += row({joint.joint, joint.group, with_unit(joint.textbook, joint.unit), rounded(joint.nominal),
                 rounded(joint.after), rounded(joint.held_out), rounded(joint.noise)});
  }
  html += "</table>\n";
  if (d.effect_columns.empty()) return html;
  return html +
         "<h2>Error by joint and effect</h2>\n<p>Per cent of the error of the joint that goes with the "
         "effect.</p>\n<figure>" +
         shares_svg(d) + "</figure>\n";
}

std::string differences_part(const RobotDiagnosis& d) {
  if (d.differences.empty()) return "";
  std::string html = "<h2>Joints against their groups</h2>\n<table>\n" +
                     row({"joint", "effect", "group has", "difference", "verdict"}, "th");
  for (const JointDifference& one : d.differences) {
    const double most = std::abs(one.difference) + z95 * one.standard_error;
    html += row({one.joint, one.effect + " " + one.parameter, with_unit(one.of_group, one.unit),
                 rounded(one.difference) + " +- " + rounded(z95 * one.standard_error, 2),
                 one.differs ? "differs" : "more than " + with_unit(most, one.unit) + " is ruled out"});
  }
  return html + "</table>\n";
}

std::string not_named_part(const RobotDiagnosis& d) {
  if (d.not_named.empty()) return "";
  std::string html =
      "<h2>Friction and rotor inertia that are not named</h2>\n<p>With the size that each would have "
      "beside what was found, and its interval.</p>\n<table>\n" +
      row({"joint", "effect", "size", "interval"}, "th");
  for (const SizeNotNamed& one : d.not_named) {
    const double reach = z95 * one.standard_error;
    html += row({one.place, one.effect + " " + one.parameter, with_unit(one.value, one.unit),
                 rounded(one.value - reach) + " to " + rounded(one.value + reach)});
  }
  return html + "</table>\n";
}

std::string charts_part(const RobotDiagnosis& d) {
  std::string html = "<h2>The worst joints</h2>\n<div class=\"charts\">\n";
  const auto figure = [&](const std::string& caption, const diagnose_program::Chart& chart) {
    html += "<figure>" + element("figcaption", caption) + diagnose_program::chart_svg(chart) + "</figure>\n";
  };
  for (const TorquePicture& one : d.torques) {
    diagnose_program::Chart chart{"Torque left at " + one.joint, "speed [rad/s]", one.speed, {}, {}};
    chart.panels.push_back({"torque left [" + one.unit + "]",
                            150,
                            {{"rigid bodies", "before", one.rigid}, {"after", "after", one.after}}});
    figure(one.joint + ": torque left over speed", chart);
  }
  for (const AngleCurve& one : d.curves) {
    diagnose_program::Chart chart{one.joint, "time [s]", one.time, {}, {}};
    diagnose_program::Panel panel{d.torque_driven ? "torque left" : "angle [rad]", 150, {}};
    if (one.measured.size() > 0) panel.series.push_back({"measured", "measured", one.measured});
    panel.series.push_back({d.torque_driven ? "rigid bodies" : "file", "before", one.nominal});
    panel.series.push_back({"after", "after", one.after});
    chart.panels.push_back(panel);
    if (one.measured.size() > 0) {
      chart.panels.push_back(
          {"error [rad]",
           110,
           {{"file", "before", one.nominal - one.measured}, {"after", "after", one.after - one.measured}}});
    }
    figure(one.joint + (d.torque_driven ? ": torque left over time" : ": angle over time"), chart);
  }
  return html + "</div>\n";
}

std::string augmented_part(const RobotDiagnosis& d) {
  if (d.augmented.empty()) return "";
  std::string html =
      "<h2>The corrected model</h2>\n<p>What went where; the rest of augmented.xml is the file as it "
      "was.</p>\n<table>\n" +
      row({"joint", "what", "value", "in the file", "where"}, "th");
  for (const AugmentedEntry& entry : d.augmented) {
    html += row({entry.joint, entry.effect + " " + entry.parameter, with_unit(entry.value, entry.unit),
                 rounded(entry.in_file), entry.where});
  }
  return html + "</table>\n";
}

std::string remarks_part(const RobotDiagnosis& d) {
  if (d.common.remarks.empty()) return "";
  std::string html = "<h2>Remarks</h2>\n<ul>\n";
  for (const auto& remark : d.common.remarks)
    html += element("li", (remark.recording.empty() ? "" : remark.recording + ": ") + remark.text) + "\n";
  return html + "</ul>\n";
}

}  // namespace

std::string robot_report(const RobotDiagnosis& d) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width,initial-scale=1\"><title>Diagnosis of " +
         escaped(d.common.model) + "</title><style>" + diagnose_program::report_style +
         "</style></head><body><main>\n" + head_part(d) + faults_part(d) + effects_part(d) + joints_part(d) +
         differences_part(d) + not_named_part(d) + charts_part(d) + augmented_part(d) + remarks_part(d) + "<footer>" +
         diagnose_program::duration_text(d.common.seconds) + ", seed " + std::to_string(d.common.seed) +
         "</footer>\n</main></body></html>\n";
}

}  // namespace diagnose_robot
