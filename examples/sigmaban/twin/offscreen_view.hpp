// Pictures of the twin by MuJoCo's own renderer, without a screen.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "twin.hpp"

namespace sigmaban {

/// Rows from the top, three bytes (red, green, blue) per pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

/// Looks at one twin, which must outlive it, from its right and a little from the front. Belongs to the thread that
/// made it.
class OffscreenView {
 public:
  /// Throws example::UsageError if nothing can be rendered here: no EGL at run time, or when this was built.
  OffscreenView(const Twin& twin, int width, int height);
  ~OffscreenView();
  OffscreenView(const OffscreenView&) = delete;
  OffscreenView& operator=(const OffscreenView&) = delete;

  Image render(Twin& twin);

 private:
  struct Renderer;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace sigmaban
