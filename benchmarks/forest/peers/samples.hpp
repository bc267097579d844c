// The data of ../data.hpp for every library.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model.hpp"

namespace peers {

/// With one output (a value), three (a policy), or more (the policy's again and again).
Samples make_samples(std::size_t outputs, std::size_t count, std::uint64_t seed);

/// The share of the test set's variance that the model explains (R2).
double explained(Model& model, const Samples& test);

}  // namespace peers
