#include "robot_strip.hpp"

#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>

#include "../../../apps/common/gnuplot.hpp"
#include "offscreen_view.hpp"

namespace sigmaban {

void draw_robot_strip(const std::filesystem::path& base, const WalkingTwinOptions& options,
                      const surefoot::Vec<3>& commands) {
  constexpr std::size_t panels = 8;
  constexpr int width = 300, height = 360;  // [pixels]
  WalkingTwin robot(options);
  OffscreenView view(robot.twin(), width, height);
  for (int i = 0; i < 2; ++i) robot.cycle(commands);
  std::string pixels;
  std::ostringstream script;
  script << "set multiplot layout 2,4 margins 0.005,0.995,0.005,0.94 spacing 0.01,0.06\n"
            "unset tics\nunset key\nunset colorbox\nset border 0\n";
  const auto ticks = static_cast<std::size_t>(1 / (options.walk.frequency * options.twin.order_period));
  std::size_t tick = 0, drawn = 0;
  robot.cycle(commands, [&](const Twin&) {
    if (tick++ != drawn * ticks / panels || drawn == panels) return;
    const Image image = view.render(robot.twin());
    script << "set title 'after " << std::lround(1000 * options.twin.order_period * static_cast<double>(tick))
           << " ms'\nplot [0:" << width - 1 << "] [" << height - 1 << ":0] data binary array=(" << width << ","
           << height << ") format='%uchar%uchar%uchar' skip=" << pixels.size() << " using 1:2:3 with rgbimage\n";
    pixels.append(image.pixels.begin(), image.pixels.end());
    ++drawn;
  });
  script << "unset multiplot\n";
  example::draw(base, script.str(), pixels, 1200, 780);
}

}  // namespace sigmaban
