#!/usr/bin/env bash
# The main job on a bare Debian 12, within ten minutes after the build: diagnoses a machine, calibrates a walk, then goes
# from nothing to policies for the ball approach: trains and tunes them for both problems, compares, draws and exports
# them. Ctrl-C ends it at any time. Machine and walk are real recordings if SUREFOOT_RECORDINGS names their folder, else
# a plant and a robot of ours.
# Results go to $SUREFOOT_RESULTS_DIR, by default results; the build to $SUREFOOT_BUILD_DIR, by default build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/packages.sh
require_packages "${build_packages[@]}" gnuplot-nox libmujoco-dev

build=${SUREFOOT_BUILD_DIR:-build/release}
results=${SUREFOOT_RESULTS_DIR:-results}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON
cmake --build "$build" --target sigmaban_approach minimal surefoot-diagnose surefoot-calibrate diagnose_own \
  concealed_plants walk_engine_check bus_check servo_check virtual_servos surefoot-walk surefoot-twin

echo
if [[ -d ${SUREFOOT_RECORDINGS:-} ]]; then
  echo "== what does the textbook model of a DC motor leave out?"
  "$build/bin/surefoot-diagnose" --model apps/diagnose/models/hoop_motor.toml --out "$results/diagnosis" \
    "$SUREFOOT_RECORDINGS"/hoop_motor/*.csv
else
  echo "== what does the model of a servo leave out? (SUREFOOT_RECORDINGS is not set: a plant of ours stands in)"
  "$build/bin/concealed_plants" --out "$results/plant" --cases 2 --seed 1 --families servo
  "$build/bin/surefoot-diagnose" --model "$results/plant/cases/case_0001/model.toml" --out "$results/diagnosis" \
    "$results"/plant/cases/case_0001/rec_*.csv
  echo "concealed was: $results/plant/truth/case_0001.json"
fi

echo
calibrate=$build/bin/surefoot-calibrate
if [[ -d ${SUREFOOT_RECORDINGS:-} ]]; then
  echo "== how does a robot really walk? (final poses of 60 sequences, judged on 25 others)"
  "$calibrate" fit --final-only --steps-per-cycle 2 --test "$SUREFOOT_RECORDINGS/twin_walk/plain.csv" \
    --out "$results/walk" "$SUREFOOT_RECORDINGS/twin_walk/plain_more.csv"
else
  echo "== how does a robot really walk? (SUREFOOT_RECORDINGS is not set: the robot of the paper is simulated)"
  "$calibrate" simulate --final-only --sequences 25 --seed 1 --out "$results/walks.csv"
  "$calibrate" fit --out "$results/walk" "$results/walks.csv"
fi

step() {
  echo
  echo "== $*"
  "$build/bin/sigmaban_approach" "$@"
}

# Budgets count work, in seconds of one core, so that the result is the same on every machine; --max-wall [s] keeps slow
# machines within the ten minutes.
for problem in ha anha; do
  policy=$results/rfpi_$problem
  step train --problem $problem --budget 180 --max-wall 95 --seed 1 --out "$policy.policy"
  step train --problem $problem --budget 800 --max-wall 145 --seed 1 --preset paper --out "$results/paper_$problem.policy"
  step tune --problem $problem --budget 50 --max-wall 35 --seed 1 --out "$results/tuned_$problem.json"
  step export --policy "$policy.policy" --out "$policy.c"
  step export --policy "$policy.policy" --max-kb 200 --out "${policy}_small.c"
done
step trajectories --results "$results"
step table --results "$results"
echo
echo "Policies, C files for the robot, pictures and table.json are in $results/; the diagnosis is $results/diagnosis/report.html, the walk $results/walk/motion.json"
