#!/usr/bin/env bash
# Does the answer depend on what it must not depend on? Machines of the grammar are diagnosed with seeds 1 to 5, from
# starting values of all parameters x 0.5 and x 2 (within their bounds), and with the recordings in another order.
#   benchmarks/blind/invariance/run.sh [--cases N] [--seed S] [--budget SECONDS]
# Without --seed a new one is drawn from the clock. Results go to $SUREFOOT_RESULTS_DIR/invariance_<seed>, by default
# under results, and what is there already is not made again; the build to $SUREFOOT_BUILD_DIR, by default build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

cases=12 seed=$(date +%s) budget=60
while (($#)); do
  case $1 in
    --cases | --seed | --budget)
      (($# > 1)) || { echo "run.sh: $1 needs a value" >&2; exit 2; }
      declare "${1#--}=$2"
      shift 2 ;;
    *) echo "run.sh: unknown option $1; known: --cases N, --seed S, --budget SECONDS" >&2; exit 2 ;;
  esac
done

source cmake/packages.sh
require_packages "${build_packages[@]}"
build=${SUREFOOT_BUILD_DIR:-build/release}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON >/dev/null
cmake --build "$build" --target surefoot-diagnose concealed_machines concealed_invariance

out=${SUREFOOT_RESULTS_DIR:-results}/invariance_$seed
echo "seed $seed, $cases machines, results in $out"
mkdir -p "$out"
[[ -d $out/cases ]] || "$build/bin/concealed_machines" --out "$out" --cases "$cases" --seed "$seed" --machines development

# scaled MODEL FACTOR: the model file with starting values of its free parameters times a factor, within their bounds
scaled() {
  awk -v factor="$2" '
    /^\[/ { inside = $0 == "[parameters]" }
    inside && match($0, /value = [^,]*/) && !/fixed = true/ {
      value = substr($0, RSTART + 8, RLENGTH - 8) * factor
      before = substr($0, 1, RSTART + 7); after = substr($0, RSTART + RLENGTH)
      if (match(after, /min = [^,]*/) && value < substr(after, RSTART + 6, RLENGTH - 6) + 0) value = substr(after, RSTART + 6, RLENGTH - 6)
      if (match(after, /max = [^,]*/) && value > substr(after, RSTART + 6, RLENGTH - 6) + 0) value = substr(after, RSTART + 6, RLENGTH - 6)
      print before sprintf("%.10e", value) after
      next
    }
    { print }' "$1"
}

# reordered FOLDER TO: the recordings under names that sort the other way round, as a diagnosis sorts them by name
reordered() {
  local files=("$1"/rec_*.csv) i
  mkdir -p "$2"
  for ((i = 0; i < ${#files[@]}; ++i)); do cp "${files[i]}" "$2/$(basename "${files[${#files[@]} - 1 - i]}")"; done
}

# diagnose VARIANT CASE MODEL SEED RECORDING...
diagnose() {
  local result=$out/results/$1/$2 model=$3 seed=$4
  shift 4
  [[ -e $result ]] && return
  rm -rf "$result.part"
  mkdir -p "$result.part"
  timeout 900 "$build/bin/surefoot-diagnose" --model "$model" --out "$result.part" --quiet --threads 1 --budget "$budget" \
    --seed "$seed" "$@" >"$result.part/log.txt" 2>&1 || echo "exit code $?, see $result/log.txt"
  mv "$result.part" "$result"
}

for folder in "$out"/cases/case_*; do
  name=${folder##*/} other=$out/other/${folder##*/}
  reordered "$folder" "$other"
  scaled "$folder/model.toml" 0.5 >"$other/half.toml"
  scaled "$folder/model.toml" 2 >"$other/twice.toml"
  for number in 1 2 3 4 5; do diagnose "seed_$number" "$name" "$folder/model.toml" "$number" "$folder"/rec_*.csv; done
  diagnose half "$name" "$other/half.toml" 1 "$folder"/rec_*.csv
  diagnose twice "$name" "$other/twice.toml" 1 "$folder"/rec_*.csv
  diagnose reordered "$name" "$folder/model.toml" 1 "$other"/rec_*.csv
done
"$build/bin/concealed_invariance" "$out/results" | tee "$out/score.txt"
