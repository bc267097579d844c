// Vectors of the numbers of a model's states, inputs or outputs, handled number by number: what has just been written
// so would be waited for if it were read in larger pieces, as Eigen and compilers would.
#pragma once

#include <Eigen/Core>
#include <atomic>

#include "model_file.hpp"

namespace diagnose_program {

/// Sets each number of a vector to value(i), by itself; the barrier to the compiler is no instruction.
template <class Vector, class Value>
void set_one_by_one(Vector& vector, Value&& value) {
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    vector[i] = value(i);
    std::atomic_signal_fence(std::memory_order_seq_cst);
  }
}

/// Up to 16 numbers without memory from the heap.
class Channels : public Eigen::Matrix<double, Eigen::Dynamic, 1, 0, static_cast<int>(most_channels), 1> {
 public:
  using Base = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, static_cast<int>(most_channels), 1>;
  using Base::Base;
  using Base::operator=;
  Channels() = default;
  Channels(const Channels& other) : Base(other.size()) { copy(other); }
  Channels& operator=(const Channels& other) {
    resize(other.size());
    copy(other);
    return *this;
  }
  ~Channels() = default;

 private:
  void copy(const Channels& other) {
    set_one_by_one(*this, [&other](Eigen::Index i) { return other[i]; });
  }
};

}  // namespace diagnose_program
