// Reader of a case as it is given to every method: the model file (for its nominal values; the equations of the
// families are known) and the recordings.
#pragma once

#include <filesystem>
#include <vector>

#include "plant.hpp"

namespace sparse {

/// Nominal model and readings. Throws a sentence naming file and line if something cannot be read.
plants::System load_case(const std::filesystem::path& model, const std::vector<std::filesystem::path>& recordings);

}  // namespace sparse
