#include "any_policy.hpp"

#include <filesystem>
#include <string>

#include "../../../apps/common/files.hpp"
#include "commands.hpp"
#include "parameter_file.hpp"

namespace sigmaban {

using example::read_text;

std::optional<Winner2016> load_winner2016(const std::string& name_or_file) {
  if (name_or_file == "winner2016") return Winner2016(Winner2016Parameters::winner2016());
  if (name_or_file == "tuned") return Winner2016(Winner2016Parameters::tuned());
  if (!exists(std::filesystem::path(name_or_file))) {
    throw UsageError(name_or_file + ": no such file; a policy is winner2016, tuned, or a file of `train` or `tune`");
  }
  if (read_text(name_or_file).starts_with('{')) return Winner2016(read_parameters(name_or_file));
  return std::nullopt;
}

}  // namespace sigmaban
