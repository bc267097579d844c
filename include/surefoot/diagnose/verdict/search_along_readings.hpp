// A search by predictions over short horizons, for what simulations of whole recordings do not show. Where what is
// missing makes small differences grow, as the detents of a motor that recorded currents drive, a model without it is
// lost in every recording, and no effect brings it near by itself.
#pragma once

#include <optional>

#include "surefoot/diagnose/verdict/examine_recordings.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"

namespace surefoot::diagnosis {

/// One effect or two that explain predictions over the shortest of the horizons of guided fits; none if no such leave
/// only noise. Its Integration::follow is what the machine needs with them: 0 unless they make it unstable. Takes at
/// most as long as the diagnosis took until now.
std::optional<FoundModel> search_along_readings(EstimationSetup& setup, const RunContext& run);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/search_along_readings.ipp"
#endif
