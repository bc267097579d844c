#include "prepare.hpp"

#include <string>
#include <utility>

using namespace surefoot::diagnosis;

namespace all_at_once {

Prepared prepare(const BindSimulator& bind, const surefoot::SimulatorInfo& info,
                 std::vector<surefoot::Recording> recordings, const RunContext& run) {
  if (recordings.size() < 4) {
    throw surefoot::DiagnoseError(
        "this baseline needs at least four recordings, to hold out and to choose the penalty; " +
        std::to_string(recordings.size()) + " given");
  }
  Prepared result;
  surefoot::Diagnosis& diagnosis = result.diagnosis;
  diagnosis.model = info.name;
  diagnosis.seed = run.seed;
  diagnosis.remarks = screen_recordings(info, recordings);
  result.setup = hold_out_recordings(bind, std::move(recordings), run);
  name_recordings(result.setup, diagnosis);
  result.calibration = calibrate_model(result.setup, run);
  diagnosis.integration_order = result.setup.bound.integration.order;
  diagnosis.integration_step = result.setup.bound.integration.step;
  return result;
}

}  // namespace all_at_once
