#include "formulas.hpp"

#include <muParser.h>

#include <cmath>
#include <string>

#include "surefoot/diagnose/recording.hpp"

namespace diagnose_program {
namespace {

// NaN in, NaN out, so that a simulation gone wrong is noticed.
double smaller(double a, double b) { return a < b || a != a ? a : b; }
double larger(double a, double b) { return a > b || a != a ? a : b; }
double sign(double a) { return a > 0 ? 1 : a < 0 ? -1 : a; }

void define_functions(mu::Parser& parser) {
  using Unary = double (*)(double);
  parser.ClearFun();
  parser.DefineFun("sin", static_cast<Unary>(std::sin));
  parser.DefineFun("cos", static_cast<Unary>(std::cos));
  parser.DefineFun("tan", static_cast<Unary>(std::tan));
  parser.DefineFun("asin", static_cast<Unary>(std::asin));
  parser.DefineFun("acos", static_cast<Unary>(std::acos));
  parser.DefineFun("atan", static_cast<Unary>(std::atan));
  parser.DefineFun("sinh", static_cast<Unary>(std::sinh));
  parser.DefineFun("cosh", static_cast<Unary>(std::cosh));
  parser.DefineFun("tanh", static_cast<Unary>(std::tanh));
  parser.DefineFun("exp", static_cast<Unary>(std::exp));
  parser.DefineFun("log", static_cast<Unary>(std::log));
  parser.DefineFun("sqrt", static_cast<Unary>(std::sqrt));
  parser.DefineFun("abs", static_cast<Unary>(std::fabs));
  parser.DefineFun("floor", static_cast<Unary>(std::floor));
  parser.DefineFun("ceil", static_cast<Unary>(std::ceil));
  parser.DefineFun("sign", sign);
  parser.DefineFun("atan2", static_cast<double (*)(double, double)>(std::atan2));
  parser.DefineFun("min", smaller);
  parser.DefineFun("max", larger);
}

}  // namespace

Formulas::Formulas(std::span<const PlanStep> steps, std::span<double> slots) {
  if (steps.empty()) return;
  parser_ = std::make_unique<mu::Parser>();
  try {
    define_functions(*parser_);
    for (std::size_t i = 0; i < slots.size(); ++i) parser_->DefineVar("v" + std::to_string(i), &slots[i]);
    std::string all;  // v7=...,v8=...
    for (const PlanStep& step : steps) {
      all += (all.empty() ? "v" : ",v") + std::to_string(step.slot) + "=" + step.text;
    }
    parser_->SetExpr(all);
    evaluate();  // compiles; from now on nothing can be thrown
  } catch (const mu::Parser::exception_type& error) {
    throw surefoot::DiagnoseError("the equations cannot be computed: " + error.GetMsg());
  }
}

Formulas::Formulas() = default;
Formulas::Formulas(Formulas&&) noexcept = default;
Formulas& Formulas::operator=(Formulas&&) noexcept = default;
Formulas::~Formulas() = default;

void Formulas::evaluate() const {
  if (parser_) parser_->Eval();
}

}  // namespace diagnose_program
