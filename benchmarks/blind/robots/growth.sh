#!/usr/bin/env bash
# How does the time of a diagnosis grow with the number of joints?
#   benchmarks/blind/robots/growth.sh [CASES [SEED]]
# Draws CASES robots of 3, 6, 12 and 24 joints (legs, three joints each) with one hidden fault and as many without, all
# logs as long (three recordings of 6 s at 200 Hz), and prints CPU seconds of a diagnosis and the exponent of a power law.
# Results and build go where those of run.sh go.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
cases=${1:-4} seed=${2:-$(date +%s)}
build=${SUREFOOT_BUILD_DIR:-build/release}
out=${SUREFOOT_RESULTS_DIR:-results}/growth_$seed
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_BENCHMARKS=ON >/dev/null
cmake --build "$build" --target surefoot-diagnose concealed_robots >/dev/null
echo "seed $seed, $cases robots of each kind"
mkdir -p "$out"
: >"$out/seconds.txt"
TIMEFORMAT='%U'
for faults in 1 0; do
  for joints in 3 6 12 24; do
    robots=$out/faults_$faults/joints_$joints
    "$build/bin/concealed_robots" "$robots" "$cases" "$seed" "legs$joints" "$faults"
    for folder in "$robots"/cases/*; do
      seconds=$({ time "$build/bin/surefoot-diagnose" --model "$folder/robot.xml" --setup "$folder/robot.toml" \
        --out "${folder/cases/results}" --quiet "$folder"/rec_*.csv >/dev/null 2>&1; } 2>&1)
      echo "$faults $joints $seconds" >>"$out/seconds.txt"
    done
  done
done
awk '{ key = $1 " " $2; sum[key] += $3; most[key] = $3 > most[key] ? $3 : most[key]; count[key]++ }
  END {
    for (faults = 1; faults >= 0; faults--) {
      printf "%s:", faults ? "one hidden fault" : "none"
      n = sx = sy = sxx = sxy = 0
      for (joints = 3; joints <= 24; joints *= 2) {
        key = faults " " joints; mean = sum[key] / count[key]
        printf " %d joints %.1f CPU s (at most %.1f),", joints, mean, most[key]
        x = log(joints); y = log(mean); n++; sx += x; sy += y; sxx += x * x; sxy += x * y
      }
      printf " exponent %.2f\n", (n * sxy - sx * sy) / (n * sxx - sx * sx)
    }
  }' "$out/seconds.txt" | tee "$out/growth.txt"
