// A search by predictions over short horizons, for what simulations of whole recordings do not show. Where what is
// missing makes small differences grow, as the detents of a motor that recorded currents drive, a model without it is
// lost in every recording, and no effect brings it near by itself.
#pragma once

#include "surefoot/diagnose/verdict/examine_recordings.hpp"
#include "surefoot/diagnose/verdict/prepare.hpp"

namespace surefoot::diagnosis {

/// One effect or two that explain predictions over the shortest of the horizons of guided fits, into `found`; false if
/// none leave only noise. FoundModel::follow is 0 unless they make the machine unstable. Takes at most as long as the
/// diagnosis took until now.
bool search_along_readings(EstimationSetup& setup, const RunContext& run, FoundModel& found);

}  // namespace surefoot::diagnosis

#ifndef SUREFOOT_COMPILED
#include "surefoot/diagnose/verdict/search_along_readings.ipp"
#endif
