#include "expression.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>

#include "names.hpp"

namespace diagnose_program {
namespace {

constexpr std::array<KnownFunction, 19> functions{{
    {"sin", 1, 1},  {"cos", 1, 1},  {"tan", 1, 1},  {"asin", 1, 1},  {"acos", 1, 1}, {"atan", 1, 1}, {"atan2", 2, 2},
    {"sinh", 1, 1}, {"cosh", 1, 1}, {"tanh", 1, 1}, {"exp", 1, 1},   {"log", 1, 1},  {"sqrt", 1, 1}, {"abs", 1, 1},
    {"min", 2, 16}, {"max", 2, 16}, {"sign", 1, 1}, {"floor", 1, 1}, {"ceil", 1, 1},
}};

constexpr int deepest = 100;             // nested parentheses, calls and signs
constexpr std::size_t longest = 20'000;  // characters

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Recursive descent over the text.
class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Expression parse() {
    if (text_.size() > longest) throw ExpressionError("the expression is longer than 20000 characters");
    skip();
    if (at_ == text_.size()) throw ExpressionError("the expression is empty");
    tree_.root = choice();
    if (at_ != text_.size()) fail("an operator or the end is expected");
    return std::move(tree_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const std::string found =
        at_ < text_.size() ? "found \"" + printable(text_.substr(at_, 12)) + "\"" : "found its end";
    throw ExpressionError("at character " + std::to_string(at_ + 1) + " of the expression " + what + ", " + found);
  }

  void skip() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) {
      ++at_;
    }
  }

  bool take(std::string_view symbol) {
    if (!text_.substr(at_).starts_with(symbol)) return false;
    at_ += symbol.size();
    skip();
    return true;
  }

  int add(Node node) {
    tree_.nodes.push_back(std::move(node));
    return static_cast<int>(tree_.nodes.size()) - 1;
  }

  int binary(std::string_view symbol, int left, int right) {
    return add({Node::Kind::binary, 0, std::string(symbol), {left, right}});
  }

  int choice() {
    if (++depth_ > deepest) fail("parentheses are nested more than 100 deep");
    const int condition = any_of();
    int result = condition;
    if (take("?")) {
      const int yes = choice();
      if (!take(":")) fail("a ':' is expected");
      result = add({Node::Kind::choice, 0, "?", {condition, yes, choice()}});
    }
    --depth_;
    return result;
  }

  int any_of() {
    int left = all_of();
    while (take("||")) left = binary("||", left, all_of());
    return left;
  }

  int all_of() {
    int left = comparison();
    while (take("&&")) left = binary("&&", left, comparison());
    return left;
  }

  int comparison() {
    const int left = sum();
    for (const std::string_view symbol : {"<=", ">=", "==", "!=", "<", ">"}) {
      if (take(symbol)) return binary(symbol, left, sum());
    }
    return left;
  }

  int sum() {
    int left = product();
    for (;;) {
      if (take("+")) {
        left = binary("+", left, product());
      } else if (take("-")) {
        left = binary("-", left, product());
      } else {
        return left;
      }
    }
  }

  int product() {
    int left = sign();
    for (;;) {
      if (take("*")) {
        left = binary("*", left, sign());
      } else if (take("/")) {
        left = binary("/", left, sign());
      } else {
        return left;
      }
    }
  }

  int sign() {
    if (++depth_ > deepest) fail("signs are nested more than 100 deep");
    int result = 0;
    if (take("-")) {
      result = add({Node::Kind::negate, 0, "-", {sign()}});
    } else if (take("+")) {
      result = sign();
    } else {
      result = power();
    }
    --depth_;
    return result;
  }

  int power() {
    const int base = item();
    if (take("^")) return binary("^", base, sign());
    return base;
  }

  int item() {
    if (take("(")) {
      const int inside = choice();
      if (!take(")")) fail("a ')' is expected");
      return inside;
    }
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return number();
    if (at_ < text_.size() && is_letter(text_[at_])) return name();
    fail("a number, a name or '(' is expected");
  }

  int number() {
    double value = 0;
    const char* begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (error != std::errc()) fail("a number is expected");
    at_ += static_cast<std::size_t>(end - begin);
    if (at_ < text_.size() && is_letter(text_[at_])) fail("an operator is expected after the number");
    skip();
    return add({Node::Kind::number, value, {}, {}});
  }

  int name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string name(text_.substr(begin, at_ - begin));
    skip();
    const auto known = std::ranges::find(functions, name, &KnownFunction::name);
    if (take("(")) {
      if (known == functions.end()) {
        std::vector<std::string> names;
        for (const KnownFunction& function : functions) names.emplace_back(function.name);
        throw ExpressionError("there is no function " + in_quotes(name) + suggestion(name, names));
      }
      return call(*known);
    }
    if (known != functions.end())
      throw ExpressionError("the function " + in_quotes(name) + " needs its arguments in ()");
    if (name == "pi") return add({Node::Kind::number, std::numbers::pi, {}, {}});
    return add({Node::Kind::name, 0, name, {}});
  }

  int call(const KnownFunction& function) {
    Node node{Node::Kind::call, 0, std::string(function.name), {}};
    do {
      node.arguments.push_back(choice());
    } while (take(","));
    if (!take(")")) fail("a ')' or ',' is expected");
    const std::size_t count = node.arguments.size();
    if (count < function.least || count > function.most) {
      throw ExpressionError("the function '" + node.text + "' takes " + std::to_string(function.least) +
                            (function.most > function.least ? " or more arguments, not " : " argument(s), not ") +
                            std::to_string(count));
    }
    return add(std::move(node));
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  Expression tree_;
};

}  // namespace

Expression parse_expression(std::string_view text) { return Parser(text).parse(); }

std::vector<std::string> names_in(const Expression& expression) {
  std::vector<std::string> names;
  for (const Node& node : expression.nodes) {
    if (node.kind == Node::Kind::name && std::ranges::find(names, node.text) == names.end()) names.push_back(node.text);
  }
  return names;
}

std::span<const KnownFunction> known_functions() { return functions; }

bool is_reserved(std::string_view name) {
  return name == "pi" || std::ranges::find(functions, name, &KnownFunction::name) != functions.end();
}

bool is_identifier(std::string_view name) {
  return !name.empty() && is_letter(name.front()) &&
         std::ranges::all_of(name, [](char c) { return is_letter(c) || is_digit(c); });
}

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc() ? std::string(buffer.data(), end) : "0";
}

}  // namespace diagnose_program
