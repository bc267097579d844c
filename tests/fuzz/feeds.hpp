// What is done with bytes that may come from anywhere: one feed for each reader. Bytes that a reader refuses in one
// sentence are fine, and so are bytes that it accepts, if what came out of them can be used. Anything else leaves the
// feed as an exception or kills the process: libfuzzer.cpp and replay_test.cpp see to it that somebody notices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace fuzz {

using Input = std::span<const std::uint8_t>;

void dynamixel(Input input);   // bytes of a servo bus, both protocols
void forest(Input input);      // forest file, as each kind of forest
void policy(Input input);      // policy file
void checkpoint(Input input);  // of RFPI
void search(Input input);      // of CMA-ES
void residual(Input input);    // residual model file

#ifdef SUREFOOT_FUZZ_PROGRAMS  // the packages of the programs are there
void model(Input input);       // model file, its equations computed
void recording(Input input);   // CSV file of a model
void walks(Input input);       // CSV file of walks
void sheet(Input input);       // sheet that was filled in, or the orders it belongs to
void motion(Input input);      // motion.json
void joints(Input input);      // joints of surefoot-walk
void parameters(Input input);  // tuned parameters of Winner2016
void reference(Input input);   // joint targets of a walk engine
#endif

struct Feed {
  std::string_view name;  // of its folder in seeds/, too
  void (*run)(Input);
  std::string_view fixture;  // files in tests/fixtures/VERSION that end so are seeds as well
};

inline constexpr std::array feeds{
    Feed{"dynamixel", dynamixel, ""},
    Feed{"forest", forest, ".forest"},
    Feed{"policy", policy, ".policy"},
    Feed{"checkpoint", checkpoint, ".rfpi"},
    Feed{"search", search, ".cma"},
    Feed{"residual", residual, ""},
#ifdef SUREFOOT_FUZZ_PROGRAMS
    Feed{"model", model, ""},
    Feed{"recording", recording, ""},
    Feed{"walks", walks, ""},
    Feed{"sheet", sheet, ""},
    Feed{"motion", motion, "motion.json"},
    Feed{"joints", joints, ""},
    Feed{"parameters", parameters, "tuned.json"},
    Feed{"reference", reference, ""},
#endif
};

}  // namespace fuzz
