#!/usr/bin/env bash
# From an empty clone of the repository on a bare Debian 12 to results: a first diagnosis within minutes, then all the rest.
# Ctrl-C ends it at any time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'HELP'
usage: examples/run.sh [--quick]

Builds what it runs next, and only that, and runs it:
  1. a diagnosis: what does the model of a servo leave out? A first report after about three minutes on two cores.
  2. a calibrated walk, with its noise
  3. policies for the ball approach, trained and tuned for both problems, compared, drawn, and as C files for the robot
All of it takes about fifteen minutes. With --quick it ends after the first.

Machine and walk are real recordings if SUREFOOT_RECORDINGS names their folder, else a plant and a robot of ours.
Results go to $SUREFOOT_RESULTS_DIR, by default results; the build to $SUREFOOT_BUILD_DIR, by default build/release.
HELP
}
quick=
case "$*" in
  "") ;;
  --quick) quick=yes ;;
  -h | --help) usage && exit ;;
  *) usage >&2 && exit 2 ;;
esac

source cmake/packages.sh
require_packages "${build_packages[@]}"
build=${SUREFOOT_BUILD_DIR:-build/release}
results=${SUREFOOT_RESULTS_DIR:-results}

say() { printf '\n== %s\n' "$*"; }
build() { cmake --build "$build" --target "$@"; }

say "building surefoot-diagnose"
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON >/dev/null
if [[ -d ${SUREFOOT_RECORDINGS:-} ]]; then
  build surefoot-diagnose
  say "what does the textbook model of a DC motor leave out?"
  model=apps/diagnose/models/hoop_motor.toml
  recordings=("$SUREFOOT_RECORDINGS"/hoop_motor/*.csv)
else
  build surefoot-diagnose concealed_plants
  say "what does the model of a servo leave out? (SUREFOOT_RECORDINGS is not set: a plant of ours stands in)"
  "$build/bin/concealed_plants" --out "$results/plant" --cases 2 --seed 10 --families servo
  model=$results/plant/cases/case_0002/model.toml
  recordings=("$results"/plant/cases/case_0002/rec_*.csv)
fi
"$build/bin/surefoot-diagnose" --model "$model" --out "$results/diagnosis" "${recordings[@]}"
echo "The report, with pictures: $results/diagnosis/report.html"
[[ -d ${SUREFOOT_RECORDINGS:-} ]] || echo "What was hidden in the plant: $results/plant/truth/case_0002.json"
[[ $quick ]] && exit

say "building the calibration of walks"
require_packages gnuplot-nox  # for pictures
build surefoot-calibrate
calibrate=$build/bin/surefoot-calibrate
if [[ -d ${SUREFOOT_RECORDINGS:-} ]]; then
  say "how does a robot really walk? (final poses of 60 sequences, tested on 25 others)"
  "$calibrate" fit --final-only --steps-per-cycle 2 --test "$SUREFOOT_RECORDINGS/twin_walk/plain.csv" \
    --out "$results/walk" "$SUREFOOT_RECORDINGS/twin_walk/plain_more.csv"
else
  say "how does a robot really walk? (SUREFOOT_RECORDINGS is not set: the robot of the paper is simulated)"
  "$calibrate" simulate --final-only --sequences 25 --seed 1 --out "$results/walks.csv"
  "$calibrate" fit --out "$results/walk" "$results/walks.csv"
fi

say "building the policies for the ball approach"
build minimal sigmaban_approach
say "a policy for a problem of your own: examples/minimal"
"$build/bin/minimal"
step() {
  say "$*"
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
say "results in $results/"
echo "policies, C files for the robot, pictures and table.json; the diagnosis: diagnosis/report.html; the walk: walk/motion.json"
echo "The other examples, a simulator in C++ and the robot among them: cmake --build $build"
