// Units at the end of the names of columns: "v_left_m_s" is in m/s.
#pragma once

#include <string>
#include <string_view>

namespace diagnose_program {

/// The unit that a column's name ends in ("rad/s"), "1" for pure numbers (`_norm`, `_raw`), empty if there is none.
std::string unit_of_column(std::string_view column);

/// True unless the name ends in a known unit that is another one than `unit`.
bool unit_fits(std::string_view column, std::string_view unit);

}  // namespace diagnose_program
