#include "../offscreen_view.hpp"

#include "../../../../apps/common/usage_error.hpp"

namespace sigmaban {

struct OffscreenView::Renderer {};

OffscreenView::OffscreenView(const Twin& /*twin*/, int /*width*/, int /*height*/) {
  throw example::UsageError("this program was built without EGL; install libegl-dev and build it anew");
}

OffscreenView::~OffscreenView() = default;

Image OffscreenView::render(Twin& /*twin*/) { return {}; }

}  // namespace sigmaban
