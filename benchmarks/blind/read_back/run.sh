#!/usr/bin/env bash
# Does augmented.toml survive being read back? Each model is diagnosed; the augmented model that comes of it is diagnosed
# again with no further effects, which has to give the same error; and no fit may be worse than its start.
#   benchmarks/blind/read_back/run.sh [--cases DIR] [--first N] [--budget SECONDS]
# DIR holds case_0001/model.toml and rec_*.csv as concealed_machines writes them. Without --cases: the real sets of
# $SUREFOOT_RECORDINGS with the models of apps/diagnose/models. Results go to $SUREFOOT_RESULTS_DIR/read_back, by
# default under results, and what is there already is not made again; the build to $SUREFOOT_BUILD_DIR, by default
# build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."

cases='' first=1000000 budget=60
while (($#)); do
  case $1 in
    --cases | --first | --budget)
      (($# > 1)) || { echo "run.sh: $1 needs a value" >&2; exit 2; }
      declare "${1#--}=$2"
      shift 2 ;;
    *) echo "run.sh: unknown option $1; known: --cases DIR, --first N, --budget SECONDS" >&2; exit 2 ;;
  esac
done
[[ -n $cases || -n ${SUREFOOT_RECORDINGS:-} ]] || { echo "run.sh: needs --cases or SUREFOOT_RECORDINGS" >&2; exit 2; }

source cmake/packages.sh
require_packages "${build_packages[@]}"
build=${SUREFOOT_BUILD_DIR:-build/release}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON >/dev/null
cmake --build "$build" --target surefoot-diagnose concealed_read_back

out=${SUREFOOT_RESULTS_DIR:-results}/read_back
mkdir -p "$out/found" "$out/again"

# diagnose FOLDER NAME MODEL [OPTION]... -- RECORDING...: written aside, so that an interrupted one is made again
diagnose() {
  local result=$out/$1/$2 model=$3
  shift 3
  [[ -e $result ]] && return
  rm -rf "$result.part"
  mkdir -p "$result.part"
  timeout 900 "$build/bin/surefoot-diagnose" --model "$model" --out "$result.part" --quiet --threads 1 --budget "$budget" \
    "$@" >"$result.part/log.txt" 2>&1 || echo "$2: exit code $?, see $result/log.txt"
  mv "$result.part" "$result"
}

# both NAME MODEL RECORDING...
both() {
  local name=$1 model=$2
  shift 2
  diagnose found "$name" "$model" "$@"
  [[ -e $out/found/$name/augmented.toml ]] || return 0
  diagnose again "$name" "$out/found/$name/augmented.toml" --max-effects 0 "$@"
}

if [[ -n $cases ]]; then
  count=0
  for folder in "$cases"/case_*; do
    ((count++ < first)) || break
    both "${folder##*/}" "$folder/model.toml" "$folder"/rec_*.csv
  done
else
  for model in apps/diagnose/models/*.toml; do
    name=$(basename "$model" .toml)
    recordings=("$SUREFOOT_RECORDINGS/$name"/*.csv)
    [[ $name == neato_orders ]] && recordings=("$SUREFOOT_RECORDINGS/$name"/as_recordings/*.csv)
    [[ -e ${recordings[0]} ]] && both "$name" "$model" "${recordings[@]}"
  done
fi
"$build/bin/concealed_read_back" "$out/found" "$out/again" | tee "$out/score.txt"
