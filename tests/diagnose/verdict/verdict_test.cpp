// The verdict on hand-made evidence: one case for every branch.
#include "surefoot/diagnose/verdict/verdict.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace surefoot::diagnosis {
namespace {

const VerdictCriteria criteria;

Verdict verdict_on(const VerdictEvidence& evidence) { return decide(evidence, criteria); }

// Residuals that hold so much structure that nothing but effects could excuse it.
VerdictEvidence structured(double share) {
  VerdictEvidence evidence;
  evidence.structure_p_value = 1e-6;
  evidence.structure_share = share;
  evidence.structure_energy = 1;
  return evidence;
}

TEST_CASE("a model whose calibration changes nothing, and that leaves noise alone, is adequate") {
  CHECK(verdict_on({}) == Verdict::adequate);
  VerdictEvidence evidence;
  evidence.calibration_gain = 0.5;
  evidence.calibration_t = 1.9;
  CHECK(verdict_on(evidence) == Verdict::adequate);  // large, but may be chance
  evidence.calibration_gain = 0.019;
  evidence.calibration_t = 50;
  CHECK(verdict_on(evidence) == Verdict::adequate);  // sure, but too small
}

TEST_CASE("a model that only its calibration makes agree lacks parameters only") {
  VerdictEvidence evidence;
  evidence.calibration_gain = 0.03;
  evidence.calibration_t = 3;
  CHECK(verdict_on(evidence) == Verdict::parameters_only);
}

TEST_CASE("effects that leave noise alone are the missing physics, whatever the calibration did") {
  VerdictEvidence evidence;
  evidence.effects_found = true;
  CHECK(verdict_on(evidence) == Verdict::missing_physics);
  evidence.calibration_gain = 0.5;
  evidence.calibration_t = 9;
  CHECK(verdict_on(evidence) == Verdict::missing_physics);
}

TEST_CASE("structure in the residuals is unexplained if it is sure and large") {
  CHECK(verdict_on(structured(0.13)) == Verdict::unexplained);
  CHECK(verdict_on(structured(0.11)) == Verdict::adequate);
  VerdictEvidence by_chance = structured(0.9);
  by_chance.structure_p_value = 0.002;
  CHECK(verdict_on(by_chance) == Verdict::adequate);
}

TEST_CASE("beside effects the same structure is unexplained, but for what other formulas of them leave") {
  for (const NoiseKind noise : {NoiseKind::measurement, NoiseKind::process}) {
    VerdictEvidence evidence = structured(0.13);  // an effect that leaves more than a twentieth of what there was
    evidence.noise = noise;
    evidence.effects_found = true;
    CHECK(verdict_on(evidence) == Verdict::unexplained);
    evidence.structure_share = 0.11;
    CHECK(verdict_on(evidence) == Verdict::missing_physics);
    evidence.structure_share = 0.31;
    evidence.structure_energy = 0.04;
    CHECK(verdict_on(evidence) == Verdict::missing_physics);
  }
}

TEST_CASE("nothing is explained, and nothing is adequate, that is further off than one and a half times the noise") {
  VerdictEvidence evidence;
  for (const bool effects : {false, true}) {
    evidence.effects_found = effects;
    evidence.noise_ratio = 1.51;
    CHECK(verdict_on(evidence) == Verdict::unexplained);
    evidence.noise_ratio = 1.49;
    CHECK(verdict_on(evidence) == (effects ? Verdict::missing_physics : Verdict::adequate));
    evidence.noise_ratio = std::numeric_limits<double>::quiet_NaN();  // unknown: it decides nothing
    CHECK(verdict_on(evidence) == (effects ? Verdict::missing_physics : Verdict::adequate));
  }
}

TEST_CASE("a search that was not finished concludes nothing") {
  VerdictEvidence evidence;
  evidence.search_finished = false;
  CHECK(verdict_on(evidence) == Verdict::unfinished);
  evidence.noise_ratio = 60;
  CHECK(verdict_on(evidence) == Verdict::unfinished);
}

TEST_CASE("steps whose errors can be predicted, from the motion or by place, are unexplained") {
  VerdictEvidence evidence;
  evidence.noise = NoiseKind::process;
  for (PredictionEvidence VerdictEvidence::*test : {&VerdictEvidence::prediction, &VerdictEvidence::by_place}) {
    evidence.*test = {.gain = 0.04, .p_value = 0.004};
    CHECK(verdict_on(evidence) == Verdict::unexplained);
    evidence.*test = {.gain = 0.02, .p_value = 0.004};
    CHECK(verdict_on(evidence) == Verdict::adequate);
    evidence.*test = {.gain = 0.04, .p_value = 0.006};
    CHECK(verdict_on(evidence) == Verdict::adequate);
    evidence.*test = {};
  }
}

TEST_CASE("rows that are off by no more than the stated process noise leave nothing unexplained") {
  VerdictEvidence evidence = structured(0.9);
  evidence.noise = NoiseKind::process;
  evidence.prediction = {.gain = 0.9, .p_value = 1e-9};
  CHECK(verdict_on(evidence) == Verdict::unexplained);  // none is stated
  evidence.process_ratio = 1.11;
  CHECK(verdict_on(evidence) == Verdict::adequate);
  evidence.effects_found = true;
  CHECK(verdict_on(evidence) == Verdict::missing_physics);
  evidence.process_ratio = 1.13;
  CHECK(verdict_on(evidence) == Verdict::unexplained);
}

TEST_CASE("tests of single steps say nothing where whole recordings are simulated") {
  VerdictEvidence evidence;
  evidence.prediction = {.gain = 0.9, .p_value = 1e-9};
  CHECK(verdict_on(evidence) == Verdict::adequate);
}

TEST_CASE("of final poses only the test of whole sequences counts") {
  VerdictEvidence evidence = structured(0.9);
  evidence.noise = NoiseKind::final_pose;
  evidence.prediction = {.gain = 0.9, .p_value = 1e-9};
  CHECK(verdict_on(evidence) == Verdict::adequate);
  evidence.sequence_p_value = 0.004;
  CHECK(verdict_on(evidence) == Verdict::unexplained);
  evidence.effects_found = true;
  evidence.sequence_p_value = 0.006;
  CHECK(verdict_on(evidence) == Verdict::missing_physics);
}

TEST_CASE("criteria are what decides, and may be others") {
  VerdictCriteria strict;
  strict.tolerated_share = 0.01;
  CHECK(decide(structured(0.05), criteria) == Verdict::adequate);
  CHECK(decide(structured(0.05), strict) == Verdict::unexplained);
}

}  // namespace
}  // namespace surefoot::diagnosis
