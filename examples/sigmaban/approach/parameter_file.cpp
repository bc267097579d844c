#include "parameter_file.hpp"

#include <cmath>
#include <string>

#include "../../../apps/common/files.hpp"
#include "commands.hpp"

namespace sigmaban {

using example::read_text;

nlohmann::ordered_json to_json(const Winner2016Parameters& parameters) {
  nlohmann::ordered_json json;
  for (const Winner2016Parameter& parameter : winner2016_parameters) {
    json[std::string(parameter.name)] = parameters.*parameter.member;
  }
  return json;
}

Winner2016Parameters read_parameters(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) { return UsageError(path.string() + ": " + why); };
  const auto json = nlohmann::json::parse(read_text(path), nullptr, false);
  if (!json.is_object()) throw fail("is not a JSON object, give a file that `sigmaban_approach tune` wrote");
  const auto policy = json.find("policy"), values = json.find("parameters");
  if (policy == json.end() || *policy != "winner2016" || values == json.end() || !values->is_object()) {
    throw fail("needs \"policy\": \"winner2016\" and an object \"parameters\" with the " +
               std::to_string(Winner2016Parameters::count) + " parameters by name");
  }
  Winner2016Parameters parameters;
  for (const Winner2016Parameter& parameter : winner2016_parameters) {
    const auto value = values->find(std::string(parameter.name));
    if (value == values->end() || !value->is_number() || !std::isfinite(value->get<double>())) {
      throw fail("parameters." + std::string(parameter.name) + " must be there and be a finite number [" +
                 std::string(parameter.unit) + "]");
    }
    parameters.*parameter.member = value->get<double>();
  }
  if (values->size() != winner2016_parameters.size()) {
    throw fail("has more than the " + std::to_string(Winner2016Parameters::count) +
               " parameters of Winner2016, remove the others");
  }
  return parameters;
}

}  // namespace sigmaban
