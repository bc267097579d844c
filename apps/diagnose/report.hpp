// The result as one page of HTML for people, with everything in it.
#pragma once

#include <string>
#include <vector>

#include "surefoot/diagnose/diagnosis.hpp"
#include "surefoot/diagnose/simulator.hpp"

namespace diagnose_program {

struct Picture {
  std::string name;  // of its file, without the ending
  std::string svg, caption;
};

struct Report {
  std::string html;
  std::vector<Picture> pictures;  // also part of the page
};

Report make_report(const surefoot::Diagnosis& diagnosis, const surefoot::SimulatorInfo& info);

/// Measured and simulated curves of the test recordings, with the stretches where the mismatch is.
std::vector<Picture> curve_pictures(const surefoot::Diagnosis& diagnosis, const surefoot::SimulatorInfo& info);

}  // namespace diagnose_program
