#!/usr/bin/env bash
# Spoilt logs: does surefoot-diagnose name faults of a log, and none in clean logs of machines with hidden physics?
#   benchmarks/blind/spoilt_logs/run.sh [--logs N] [--seed S]
# Half of the logs are spoilt. Without --seed a new one is drawn from the clock. Results go to
# $SUREFOOT_RESULTS_DIR/spoilt_<seed>, by default under results; the build to $SUREFOOT_BUILD_DIR, by default
# build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

logs=80 seed=$(date +%s)
while (($#)); do
  case $1 in
    --logs | --seed)
      (($# > 1)) || { echo "run.sh: $1 needs a value" >&2; exit 2; }
      declare "${1#--}=$2"
      shift 2 ;;
    *) echo "run.sh: unknown option $1; known: --logs N, --seed S" >&2; exit 2 ;;
  esac
done

source cmake/packages.sh
require_packages "${build_packages[@]}"
build=${SUREFOOT_BUILD_DIR:-build/release}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON
cmake --build "$build" --target surefoot-diagnose concealed_plants spoilt_logs

out=${SUREFOOT_RESULTS_DIR:-results}/spoilt_$seed
echo "seed $seed, $logs logs, results in $out"
mkdir -p "$out"
"$build/bin/concealed_plants" --out "$out/plants" --cases "$logs" --seed "$seed" >"$out/plants.txt"
"$build/bin/spoilt_logs" --draw "$out/plants" "$out" "$seed"
budget=60  # seconds of a diagnosis: the log is looked at again with what was found
diagnose_one() {
  local folder=$1 result=$out/results/${1##*/}
  mkdir -p "$result"
  timeout 900 "$build/bin/surefoot-diagnose" --model "$folder/model.toml" --out "$result" --quiet --threads 1 \
    --budget "$budget" --repair "$folder"/rec_*.csv >"$result/log.txt" 2>&1 || echo "${folder##*/}: exit code $?, see $result/log.txt"
}
export -f diagnose_one
export build out budget
printf '%s\0' "$out"/cases/case_* | xargs -0 -P "$(nproc)" -n 1 bash -c 'diagnose_one "$1"' _
"$build/bin/spoilt_logs" --score "$out" "$out/results" | tee "$out/score.txt"
