// Parameters of Winner2016 that were read are written as they were.
#include "apps/common/usage_error.hpp"
#include "examples/sigmaban/approach/parameter_file.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/memory_file.hpp"

void fuzz::parameters(Input input) {
  const MemoryFile file(std::as_bytes(input));
  accepted<example::UsageError>([&] {
    const auto json = sigmaban::to_json(sigmaban::read_parameters(file.path()));
    const std::string text = nlohmann::ordered_json{{"policy", "winner2016"}, {"parameters", json}}.dump();
    const MemoryFile again(std::as_bytes(std::span(text)));
    require(sigmaban::to_json(sigmaban::read_parameters(again.path())) == json,
            "parameters that are written as others");
  });
}
