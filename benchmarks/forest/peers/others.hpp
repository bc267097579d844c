// Other libraries' forests, as far as they are installed. All predict one output only.
#pragma once

#include "model.hpp"

namespace peers {

#ifdef HAVE_DLIB
std::unique_ptr<Model> train_dlib(const Samples& samples, const Size& size);
#endif
#ifdef HAVE_OPENCV
std::unique_ptr<Model> train_opencv(const Samples& samples, const Size& size);
#endif
#ifdef HAVE_XGBOOST
std::unique_ptr<Model> train_xgboost(const Samples& samples, const Size& size);
#endif

/// One forest for each output.
std::unique_ptr<Model> train_each_output(Train train, const Samples& samples, const Size& size);

}  // namespace peers
