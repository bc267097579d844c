#include "formulas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace diagnose_program {
namespace {

// Instructions call each other, always at their end, so that compilers make jumps of it. They hand over their result:
// the next one would wait much longer for it if it had to come out of memory.
using Instruction = Formulas::Instruction;
using Run = void (*)(const Instruction*, double);
using Code = Operation::Code;

inline void pass_on(const Instruction* at, double result) {
  *at->to = result;
  ++at;
  at->run(at, result);
}

void end(const Instruction* /*at*/, double /*last*/) {}

// The operand that is the last result; all others come out of their slots.
enum class Last : std::uint8_t { none, a, b, c };

template <Last Which, Last Is>
double operand(const double* slot, double last) {
  return Which == Is ? last : *slot;
}

template <Code Operator>
double result(double a, double b) {
  using enum Operation::Code;
  if constexpr (Operator == add) return a + b;
  if constexpr (Operator == subtract) return a - b;
  if constexpr (Operator == multiply) return a * b;
  if constexpr (Operator == divide) return a / b;
  if constexpr (Operator == power) return std::pow(a, b);
  if constexpr (Operator == less) return a < b ? 1 : 0;
  if constexpr (Operator == less_or_equal) return a <= b ? 1 : 0;
  if constexpr (Operator == greater) return a > b ? 1 : 0;
  if constexpr (Operator == greater_or_equal) return a >= b ? 1 : 0;
  if constexpr (Operator == equal) return a == b ? 1 : 0;
  if constexpr (Operator == not_equal) return a != b ? 1 : 0;
  if constexpr (Operator == both) return a != 0 && b != 0 ? 1 : 0;
  if constexpr (Operator == either) return a != 0 || b != 0 ? 1 : 0;
  if constexpr (Operator == smaller) return a < b || a != a ? a : b;
  if constexpr (Operator == larger) return a > b || a != a ? a : b;
}

template <Code Operator, Last Is>
void single(const Instruction* at, double last) {
  pass_on(at, result<Operator>(operand<Last::a, Is>(at->a, last), operand<Last::b, Is>(at->b, last)));
}

// (a First b) Second c, or c Second (a First b).
template <Code First, Code Second, bool Reversed, Last Is>
void pair(const Instruction* at, double last) {
  const double inner = result<First>(operand<Last::a, Is>(at->a, last), operand<Last::b, Is>(at->b, last));
  const double c = operand<Last::c, Is>(at->c, last);
  pass_on(at, Reversed ? result<Second>(c, inner) : result<Second>(inner, c));
}

void copied(const Instruction* at, double /*last*/) { pass_on(at, *at->a); }
void negated(const Instruction* at, double /*last*/) { pass_on(at, -*at->a); }
void chosen(const Instruction* at, double /*last*/) { pass_on(at, *at->a != 0 ? *at->b : *at->c); }
void of_one(const Instruction* at, double /*last*/) { pass_on(at, at->unary(*at->a)); }
void of_two(const Instruction* at, double /*last*/) { pass_on(at, at->binary(*at->a, *at->b)); }

// Operators of two operands stand side by side among the codes, and those that pairs are made of come first.
constexpr std::size_t first_operator = static_cast<std::size_t>(Code::add);
constexpr std::size_t operators = static_cast<std::size_t>(Code::larger) + 1 - first_operator;
constexpr std::size_t paired = static_cast<std::size_t>(Code::divide) + 1 - first_operator;

constexpr std::size_t number(Code code) { return static_cast<std::size_t>(code) - first_operator; }
constexpr Code code(std::size_t number) { return static_cast<Code>(number + first_operator); }

template <std::size_t... I>
constexpr std::array<Run, sizeof...(I)> all_singles(std::index_sequence<I...> /*indices*/) {
  return {single<code(I / 3), static_cast<Last>(I % 3)>...};
}
template <std::size_t... I>
constexpr std::array<Run, sizeof...(I)> all_pairs(std::index_sequence<I...> /*indices*/) {
  return {pair<code(I / 8 / paired), code(I / 8 % paired), I / 4 % 2 == 1, static_cast<Last>(I % 4)>...};
}
constexpr auto singles = all_singles(std::make_index_sequence<operators * 3>());
constexpr auto pairs = all_pairs(std::make_index_sequence<paired * paired * 8>());

bool is_operator(Code code) { return code >= Code::add && code <= Code::larger; }
bool can_pair(Code code) { return code >= Code::add && code <= Code::divide; }

Run run_of(const Operation& one, int last) {
  switch (one.code) {
    case Code::copy:
      return copied;
    case Code::negate:
      return negated;
    case Code::choice:
      return chosen;
    case Code::unary:
      return of_one;
    case Code::binary:
      return of_two;
    default:
      return singles[number(one.code) * 3 + (one.a == last ? 1 : one.b == last ? 2 : 0)];
  }
}

// How often operations read a slot.
std::ptrdiff_t readers(std::span<const Operation> operations, int slot) {
  std::ptrdiff_t count = 0;
  for (const Operation& one : operations) {
    count += one.a == slot ? 1 : 0;
    if (is_operator(one.code) || one.code == Code::choice || one.code == Code::binary) count += one.b == slot ? 1 : 0;
    if (one.code == Code::choice) count += one.c == slot ? 1 : 0;
  }
  return count;
}

std::vector<int> computed_by(std::span<const Operation> operations) {
  std::vector<int> slots;
  for (const Operation& one : operations) slots.push_back(one.to);
  return slots;
}

}  // namespace

Formulas::Formulas(std::span<const Operation> operations, std::span<double> slots)
    : Formulas(operations, computed_by(operations), slots) {}

Formulas::Formulas(std::span<const Operation> operations, std::span<const int> asked, std::span<double> slots) {
  if (operations.empty()) return;
  const auto at = [&](int slot) { return &slots[static_cast<std::size_t>(slot)]; };
  int last = -1;  // slot of the result of the instruction before
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const Operation& one = operations[i];
    const Operation* then = i + 1 < operations.size() ? &operations[i + 1] : nullptr;
    const bool together = then != nullptr && can_pair(one.code) && can_pair(then->code) &&
                          (then->a == one.to) != (then->b == one.to) && readers(operations, one.to) == 1 &&
                          std::ranges::find(asked, one.to) == asked.end();
    if (together) {
      const bool reversed = then->b == one.to;
      const int c = reversed ? then->a : then->b;
      const std::size_t is = one.a == last ? 1 : one.b == last ? 2 : c == last ? 3 : 0;
      const Run run = pairs[(number(one.code) * paired + number(then->code)) * 8 + (reversed ? 4 : 0) + is];
      instructions_.push_back({run, at(then->to), at(one.a), at(one.b), at(c), nullptr, nullptr});
      ++i;
    } else {
      instructions_.push_back({run_of(one, last), at(one.to), at(one.a), at(one.b), at(one.c), one.unary, one.binary});
    }
    last = operations[i].to;
  }
  instructions_.push_back({end, nullptr, nullptr, nullptr, nullptr, nullptr, nullptr});
}

}  // namespace diagnose_program
