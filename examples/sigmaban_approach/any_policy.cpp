#include "any_policy.hpp"

#include <string>
#include <variant>

#include "commands.hpp"
#include "files.hpp"
#include "parameter_file.hpp"

namespace sigmaban {

AnyPolicy load_any_policy(const Approach& problem, const std::string& name_or_file) {
  if (name_or_file == "winner2016") return Winner2016(Winner2016Parameters::winner2016());
  if (name_or_file == "tuned") return Winner2016(Winner2016Parameters::tuned());
  if (!exists(std::filesystem::path(name_or_file))) {
    throw UsageError(name_or_file + ": no such file; a policy is winner2016, tuned, or a file of `train` or `tune`");
  }
  if (read_text(name_or_file).starts_with('{')) return Winner2016(read_parameters(name_or_file));
  return surefoot::load_policy<Approach>(problem, name_or_file);
}

surefoot::Estimate mean_cost(const Approach& problem, const AnyPolicy& policy, int trials, std::uint64_t seed,
                             const surefoot::Threads& threads) {
  const surefoot::RolloutOptions options{.runs = trials, .horizon = Approach::horizon};
  surefoot::Estimate result =
      std::visit([&](const auto& p) { return surefoot::evaluate(problem, p, options, threads, seed); }, policy);
  result.mean = -result.mean;
  return result;
}

}  // namespace sigmaban
