// Commands and a sheet that go together become walks that can be read.
#include "apps/calibrate/sheet.hpp"

#include "apps/calibrate/load_sequences.hpp"
#include "apps/calibrate/walk_csv.hpp"
#include "surefoot/diagnose/recording.hpp"
#include "surefoot/motion/plan.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/text_of.hpp"

namespace {

using namespace calibrate_program;
using diagnose_program::parse_csv;

void merge(const std::string& commands, const std::string& sheet) {
  MergedSheet merged;
  const bool good = fuzz::accepted<surefoot::MotionError, surefoot::DiagnoseError>(
      [&] { merged = merge_sheet(parse_csv(commands, "commands.csv"), parse_csv(sheet, "sheet.csv")); });
  if (!good) return;
  fuzz::accepted<surefoot::MotionError, surefoot::DiagnoseError>(
      [&] { sequences_of(parse_csv(merged.walks, "walks.csv"), {}); });
}

}  // namespace

void fuzz::sheet(Input input) {
  static const std::string commands = commands_csv(surefoot::plan_commands(surefoot::CommandBounds(), 3, 2, 1), 1);
  merge(commands, text_of(input));
  merge(text_of(input), "seq,x_cm,y_cm,heading_clock\n1,100,-20,3\n2,,,\n3,50,10,12\n");
}
