// Pictures by the program gnuplot, as SVG and PNG.
#pragma once

#include <filesystem>
#include <string>

namespace example {

/// Writes BASE.gp with `commands` and BASE.dat with `data`, then draws BASE.svg and BASE.png. The commands name the
/// data file as `data`; they set neither terminal nor output. `width` and `height` are in pixels.
/// Throws UsageError if gnuplot is missing or complains.
void draw(const std::filesystem::path& base, const std::string& commands, const std::string& data, int width,
          int height);

}  // namespace example
