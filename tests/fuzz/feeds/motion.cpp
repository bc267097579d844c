// A calibrated walk that was read is written as it was.
#include "apps/calibrate/motion_file/motion_file.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/text_of.hpp"

void fuzz::motion(Input input) {
  using namespace calibrate_program;
  accepted<surefoot::MotionError>([&] {
    const std::string text = motion_file_text(parse_motion_file(text_of(input), "motion.json"));
    require(motion_file_text(parse_motion_file(text, "again.json")) == text, "a walk that is written as another one");
  });
}
