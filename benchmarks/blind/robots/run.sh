#!/usr/bin/env bash
# Blind robots: what does surefoot-diagnose find in robots with hidden faults?
#   benchmarks/blind/robots/run.sh [CASES [SEED [FAMILY]]]
# Without SEED a new one is drawn from the clock. Interrupt it at any time; the same CASES and SEED resume it.
# Results go to $SUREFOOT_RESULTS_DIR/robots_<seed>, by default under results; the build to $SUREFOOT_BUILD_DIR, by default
# build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
cases=${1:-20} seed=${2:-$(date +%s)}
build=${SUREFOOT_BUILD_DIR:-build/release}
out=${SUREFOOT_RESULTS_DIR:-results}/robots_$seed
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_BENCHMARKS=ON
cmake --build "$build" --target surefoot-diagnose concealed_robots concealed_robots_score
echo "seed $seed, $cases robots, results in $out"
"$build/bin/concealed_robots" "$out" "$cases" "$seed" ${3:+"$3"}
for folder in "$out"/cases/*; do
  result=$out/results/${folder##*/}
  [[ -e $result/diagnosis.json ]] && continue
  mkdir -p "$result"
  timeout 900 "$build/bin/surefoot-diagnose" --model "$folder/robot.xml" --setup "$folder/robot.toml" --out "$result" --quiet \
    "$folder"/rec_*.csv >"$result/log.txt" 2>&1 || echo "${folder##*/}: exit code $?"
done
"$build/bin/concealed_robots_score" "$out" "$out/results" | tee "$out/score.txt"
