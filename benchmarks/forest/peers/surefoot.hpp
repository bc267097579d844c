// This library's forests. The portable ones are the same source without SIMD, in a namespace of their own.
#pragma once

#include "model.hpp"

namespace peers {

std::unique_ptr<Model> train_constant(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_linear(const Samples& samples, const Size& size);
/// One tree with the wanted leaves (at most 2,000) that does what 25 do.
std::unique_ptr<Model> train_distilled(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_constant_portable(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_linear_portable(const Samples& samples, const Size& size);

}  // namespace peers
