// This library's forests. The portable ones are the same source without SIMD, in a namespace of their own.
#pragma once

#include "model.hpp"

namespace peers {

std::unique_ptr<Model> train_constant(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_linear(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_constant_portable(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_linear_portable(const Samples& samples, const Size& size);

/// Linear leaves: grown to four times the wanted leaves, then pruned to the bytes of those wanted.
std::unique_ptr<Model> train_pruned(const Samples& samples, const Size& size);
/// One tree with the wanted leaves (at most 2,000) that does what 25 with linear leaves do.
std::unique_ptr<Model> train_distilled(const Samples& samples, const Size& size);
/// One tree with linear leaves grown from many thresholds per input.
std::unique_ptr<Model> train_one_tree(const Samples& samples, const Size& size);

/// The forests of train_constant as compiled C code.
bool have_c_compiler();
std::unique_ptr<Model> train_c_tables(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_c_tables_int16(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_c_whole(const Samples& samples, const Size& size);
std::unique_ptr<Model> train_c_branches(const Samples& samples, const Size& size);

}  // namespace peers
