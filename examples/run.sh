#!/usr/bin/env bash
# The ball approach from nothing to policies for the robot, on a bare Debian 12, within ten minutes after the build:
# trains and tunes policies for both problems, then compares, draws and exports them. Ctrl-C ends it at any time.
# Results go to $SUREFOOT_RESULTS_DIR, by default results; the build to $SUREFOOT_BUILD_DIR, by default build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/packages.sh
require_packages "${build_packages[@]}" gnuplot-nox

build=${SUREFOOT_BUILD_DIR:-build/release}
results=${SUREFOOT_RESULTS_DIR:-results}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=OFF
cmake --build "$build"

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
echo "Policies, C files for the robot, pictures and table.json are in $results/"
