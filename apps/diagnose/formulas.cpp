#include "formulas.hpp"

#include <cmath>
#include <cstddef>

namespace diagnose_program {

Formulas::Formulas(std::span<const Operation> operations, std::span<double> slots) {
  const auto at = [&](int slot) { return &slots[static_cast<std::size_t>(slot)]; };
  for (const Operation& one : operations) operations_.push_back({one, at(one.to), at(one.a), at(one.b), at(one.c)});
}

void Formulas::evaluate() const {
  using enum Operation::Code;
  for (const auto& [operation, to, a, b, c] : operations_) {
    switch (operation.code) {
      case copy:
        *to = *a;
        break;
      case negate:
        *to = -*a;
        break;
      case add:
        *to = *a + *b;
        break;
      case subtract:
        *to = *a - *b;
        break;
      case multiply:
        *to = *a * *b;
        break;
      case divide:
        *to = *a / *b;
        break;
      case power:
        *to = std::pow(*a, *b);
        break;
      case less:
        *to = *a < *b ? 1 : 0;
        break;
      case less_or_equal:
        *to = *a <= *b ? 1 : 0;
        break;
      case greater:
        *to = *a > *b ? 1 : 0;
        break;
      case greater_or_equal:
        *to = *a >= *b ? 1 : 0;
        break;
      case equal:
        *to = *a == *b ? 1 : 0;
        break;
      case not_equal:
        *to = *a != *b ? 1 : 0;
        break;
      case both:
        *to = *a != 0 && *b != 0 ? 1 : 0;
        break;
      case either:
        *to = *a != 0 || *b != 0 ? 1 : 0;
        break;
      case choice:
        *to = *a != 0 ? *b : *c;
        break;
      case unary:
        *to = operation.unary(*a);
        break;
      case binary:
        *to = operation.binary(*a, *b);
        break;
    }
  }
}

}  // namespace diagnose_program
