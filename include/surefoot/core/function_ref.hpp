// A reference to what can be called, for parameters of functions that call it and do not keep it: std::function without
// a copy, at a fifth of the compiler's memory for each lambda.
#pragma once

namespace surefoot {

template <class Signature>
class FunctionRef;

/// Refers to a function object that must outlive the reference, as an argument of a call does.
template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  template <class Function>
  FunctionRef(const Function& function)  // NOLINT(google-explicit-constructor): an argument, as with std::function
      : function_(&function), call_([](const void* any, Arguments... arguments) -> Result {
          return (*static_cast<const Function*>(any))(arguments...);
        }) {}

  Result operator()(Arguments... arguments) const { return call_(function_, arguments...); }

 private:
  const void* function_;
  Result (*call_)(const void*, Arguments...);
};

}  // namespace surefoot
