// What the experiment needs before anything walks to a ball: the twin recorded and calibrated, and for both problems
// the expert tuned and a policy trained, each for that walk.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "commands.hpp"

namespace sigmaban {

struct Table4Work {
  TwinOptions twin;
  int sequences = 25, cycles = 25;  // recorded for the calibration
  double tune_budget = 30;          // for each problem [s] of one nominal core
  double train_budget = 60;         // for each problem [s] of one nominal core
  std::filesystem::path folder;
  std::string given_motion{};  // motion.json of a robot, in place of the twin's

  std::filesystem::path motion() const { return folder / "motion.json"; }
};

/// Makes what is not in the folder yet; a file that is there is finished. Throws example::Interrupted after Ctrl-C.
void make_table4_policies(const Table4Work& work);

}  // namespace sigmaban
