#include "formula.hpp"

#include <cctype>
#include <cmath>
#include <stdexcept>

namespace machines {
namespace {

const std::map<std::string, char, std::less<>> functions{{"sin", 's'},  {"cos", 'c'}, {"tanh", 't'},
                                                         {"sqrt", 'q'}, {"abs", 'a'}, {"sign", 'g'},
                                                         {"exp", 'e'},  {"min", 'm'}, {"max", 'M'}};

class Parser {
 public:
  Parser(std::string_view text, Registers& registers) : text_(text), registers_(registers) {}

  Formula all() {
    formula_.result = sum();
    if (next() != '\0') fail();
    return std::move(formula_);
  }

 private:
  [[noreturn]] void fail() const { throw std::invalid_argument("not a formula: " + std::string(text_)); }

  char next() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(char wanted) {
    if (next() != wanted) return false;
    ++at_;
    return true;
  }

  int step(char operation, int a, int b) {
    const int to = registers_.temporary();
    formula_.steps.push_back({operation, to, a, b});
    return to;
  }

  int sum() {
    int value = product();
    for (char sign = next(); sign == '+' || sign == '-'; sign = next()) {
      ++at_;
      value = step(sign, value, product());
    }
    return value;
  }

  int product() {
    int value = factor();
    for (char sign = next(); sign == '*' || sign == '/'; sign = next()) {
      ++at_;
      value = step(sign, value, factor());
    }
    return value;
  }

  int factor() {
    if (take('-')) return step('-', registers_.constant(0), factor());
    const int base = atom();
    return take('^') ? step('^', base, factor()) : base;
  }

  int atom() {
    if (take('(')) {
      const int value = sum();
      if (!take(')')) fail();
      return value;
    }
    const char first = next();
    if (std::isdigit(static_cast<unsigned char>(first)) != 0) {
      std::size_t used = 0;
      const double value = std::stod(std::string(text_.substr(at_)), &used);
      at_ += used;
      return registers_.constant(value);
    }
    std::string name;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_'))
      name += text_[at_++];
    if (name.empty()) fail();
    return next() == '(' ? call(name) : registers_.known(name);
  }

  int call(const std::string& name) {
    const auto function = functions.find(name);
    if (function == functions.end() || !take('(')) fail();
    const int a = sum(), b = take(',') ? sum() : a;
    if (!take(')')) fail();
    return step(function->second, a, b);
  }

  std::string_view text_;
  Registers& registers_;
  Formula formula_;
  std::size_t at_ = 0;
};

double computed(char operation, double a, double b) {
  switch (operation) {
    case '+':
      return a + b;
    case '-':
      return a - b;
    case '*':
      return a * b;
    case '/':
      return a / b;
    case '^':
      return b == 2 ? a * a : std::pow(a, b);
    case 's':
      return std::sin(a);
    case 'c':
      return std::cos(a);
    case 't':
      return std::tanh(a);
    case 'q':
      return std::sqrt(a);
    case 'a':
      return std::abs(a);
    case 'g':
      return a > 0 ? 1 : a < 0 ? -1 : 0;
    case 'e':
      return std::exp(a);
    case 'm':
      return a < b ? a : b;
    default:
      return a > b ? a : b;
  }
}

}  // namespace

int Registers::of(const std::string& name) {
  const auto [at, added] = names_.emplace(name, static_cast<int>(values_.size()));
  if (added) values_.push_back(0);
  return at->second;
}

int Registers::known(const std::string& name) const {
  const auto at = names_.find(name);
  if (at == names_.end()) throw std::invalid_argument("unknown name in a formula: " + name);
  return at->second;
}

int Registers::constant(double value) {
  values_.push_back(value);
  return static_cast<int>(values_.size()) - 1;
}

int Registers::temporary() { return constant(0); }

Formula compile(std::string_view text, Registers& registers) { return Parser(text, registers).all(); }

void evaluate(const std::vector<Step>& steps, std::span<double> registers) {
  for (const Step& step : steps) {
    registers[static_cast<std::size_t>(step.to)] = computed(step.operation, registers[static_cast<std::size_t>(step.a)],
                                                            registers[static_cast<std::size_t>(step.b)]);
  }
}

}  // namespace machines
