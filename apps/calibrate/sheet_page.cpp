#include "sheet_page.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

namespace calibrate_program {
namespace {

constexpr const char* top = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Walk calibration</title>
<style>
body { font: 11pt sans-serif; margin: 12mm; max-width: 185mm }
h1 { font-size: 15pt; margin: 0 0 3mm }
.how { display: flex; gap: 8mm; align-items: flex-start }
ol { margin: 0; padding-left: 5mm } li { margin-bottom: 1.5mm }
table { border-collapse: collapse; width: 100%; margin-top: 5mm }
th, td { border: 1px solid #777; padding: 1.6mm 2mm; text-align: left }
th { background: #eee } td:first-child { width: 14mm; text-align: right }
thead { display: table-header-group } tr { break-inside: avoid }
svg { flex: 0 0 auto } svg text { font: 11px sans-serif }
@media print { body { margin: 0 } }
</style></head><body>
<h1>Walk calibration: where did the robot end?</h1>
<div class="how">
)";

/// The frame of the start, and the hours of the clock around it.
std::string frame() {
  std::string svg =
      "<svg width=\"250\" height=\"250\" viewBox=\"-125 -125 250 250\" role=\"img\" "
      "aria-label=\"x ahead, y to the left, headings as hours of a clock\">"
      "<circle r=\"84\" fill=\"none\" stroke=\"#bbb\"/>";
  char text[260];
  for (int hour = 1; hour <= 12; ++hour) {
    const double angle = hour * std::numbers::pi / 6, c = std::cos(angle), s = std::sin(angle);
    std::snprintf(text, sizeof text,
                  "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#777\"/><text x=\"%.1f\" y=\"%.1f\" "
                  "text-anchor=\"middle\">%d</text>",
                  78 * s, -78 * c, 90 * s, -90 * c, 104 * s, -104 * c + 4, hour);
    svg += text;
  }
  return svg +
         "<rect x=\"-20\" y=\"-11\" width=\"40\" height=\"22\" rx=\"6\" fill=\"#e8e8e8\" stroke=\"#555\"/>"
         "<g stroke=\"#d55e00\" stroke-width=\"2.5\" fill=\"#d55e00\"><line x1=\"0\" y1=\"0\" x2=\"0\" y2=\"-58\"/>"
         "<path d=\"M-5,-56 L0,-68 L5,-56 Z\"/></g><text x=\"8\" y=\"-52\">x, ahead</text>"
         "<g stroke=\"#0072b2\" stroke-width=\"2.5\" fill=\"#0072b2\"><line x1=\"0\" y1=\"0\" x2=\"-56\" y2=\"0\"/>"
         "<path d=\"M-54,-5 L-66,0 L-54,5 Z\"/></g><text x=\"-66\" y=\"20\">y, left</text>"
         "<circle r=\"3.5\"/></svg>";
}

}  // namespace

std::string sheet_page(std::span<const Eigen::Matrix3Xd> commands, const surefoot::Box<2>& space) {
  std::string page = top + frame();
  char text[700];
  std::snprintf(
      text, sizeof text,
      "<ol><li>Free a space of %.1f m ahead of the start, %.1f m behind, %.1f m to the left and %.1f m to the "
      "right.</li><li>Mark the start on the floor: a cross, one arm pointing ahead.</li>",
      space.high()[0], -space.low()[0], space.high()[1], -space.low()[1]);
  page += text;
  page +=
      "<li>For each sequence put the robot on the cross, let it walk on the spot, then give it the commands of the "
      "sequence (commands.csv) and stop.</li>"
      "<li>Measure where the point between its feet is, seen from the cross: x ahead and y to the left in cm; negative "
      "behind and to the right.</li>"
      "<li>Note where it looks as the nearest hour of a clock on the floor whose 12 is ahead: 3 is to the right, 9 to "
      "the left. An angle is better if you can measure it: degrees, counterclockwise.</li>"
      "<li>Did it fall or bump into something? Leave the row empty.</li></ol></div>\n"
      "<table><thead><tr><th>No.</th><th>cycles</th><th>x [cm]</th><th>y [cm]</th><th>heading [hour]</th>"
      "<th>remarks</th></tr></thead><tbody>\n";
  for (std::size_t i = 0; i < commands.size(); ++i) {
    page += "<tr><td>" + std::to_string(i + 1) + "</td><td>" + std::to_string(commands[i].cols()) +
            "</td><td></td><td></td><td></td><td></td></tr>\n";
  }
  return page +
         "</tbody></table>\n<p>Then type the rows into sheet.csv (for angles rename its column heading_clock to "
         "heading_deg) and run <code>surefoot-calibrate sheet</code>.</p>\n</body></html>\n";
}

std::string blank_sheet_csv(std::size_t sequences) {
  std::string text =
      "# x ahead, y to the left; heading: hour of a clock whose 12 is ahead and 3 to the right. Other names that are "
      "read: x_m, y_m, heading_deg, heading_rad\nseq,x_cm,y_cm,heading_clock\n";
  for (std::size_t i = 1; i <= sequences; ++i) text += std::to_string(i) + ",,,\n";
  return text;
}

}  // namespace calibrate_program
