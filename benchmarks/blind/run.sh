#!/usr/bin/env bash
# The blind benchmark: machines with physics that their model files leave out; what does surefoot-diagnose find?
#   benchmarks/blind/run.sh [--cases N] [--seed S] [--families LIST | --machines development|examination] [--jobs N]
#                           [--inputs held|linear|before] [--budget SECONDS]
# --machines draws machines from a grammar, --families those of the five families. --inputs: what inputs of the former are
# between rows, which model files do not say (by default held). --budget is that of a diagnosis.
# Without --seed a new one is drawn from the clock. Interrupt it at any time; the same --cases and --seed resume it.
# Results go to $SUREFOOT_RESULTS_DIR/concealed_<seed>, by default under results; the build to $SUREFOOT_BUILD_DIR, by
# default build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

cases=200 seed=$(date +%s) families=servo,carriage,tanks,walk,walk_final jobs=2 machines= inputs=held budget=
while (($#)); do
  case $1 in
    --cases | --seed | --families | --jobs | --machines | --inputs | --budget)
      (($# > 1)) || { echo "run.sh: $1 needs a value" >&2; exit 2; }
      declare "${1#--}=$2"
      shift 2 ;;
    *) echo "run.sh: unknown option $1; known: --cases N, --seed S, --families LIST, --machines WHICH, --inputs WHICH, --jobs N, --budget SECONDS" >&2; exit 2 ;;
  esac
done
for number in cases seed jobs; do
  [[ ${!number} =~ ^[1-9][0-9]*$ ]] || { echo "run.sh: --$number needs a positive whole number, not '${!number}'" >&2; exit 2; }
done

case $machines in
  "") draw=(concealed_plants --families "$families") what=$families ;;
  development | examination) draw=(concealed_machines --machines "$machines" --inputs "$inputs") what="$machines machines, inputs $inputs" ;;
  *) echo "run.sh: --machines is development or examination, not '$machines'" >&2; exit 2 ;;
esac

source cmake/packages.sh
require_packages "${build_packages[@]}"
build=${SUREFOOT_BUILD_DIR:-build/release}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON
cmake --build "$build" --target surefoot-diagnose concealed_programs

out=${SUREFOOT_RESULTS_DIR:-results}/concealed_$seed
echo "seed $seed, $cases cases, results in $out"
mkdir -p "$out"
asked="$cases cases of $what"
if [[ ! -e $out/plants.txt || $(<"$out/plants.txt") != "$asked" ]]; then
  rm -rf "$out/cases" "$out/truth" "$out/results"
  "$build/bin/${draw[0]}" --out "$out" --cases "$cases" --seed "$seed" "${draw[@]:1}"
  echo "$asked" >"$out/plants.txt"
fi

# diagnose PROGRAM METHOD CASE: one case, written aside. A failure is kept in log.txt and does not stop the others.
diagnose() {
  local result=$out/results/$2/$3 model=$out/cases/$3 code=0 limit=()
  [[ -n $budget && $1 == surefoot-diagnose ]] && limit=(--budget "$budget")
  rm -rf "$result" "$result.part"
  mkdir -p "$result.part"
  timeout 900 "$build/bin/$1" --model "$model/model.toml" --out "$result.part" --quiet --threads 1 "${limit[@]}" "$model"/rec_*.csv \
    >"$result.part/log.txt" 2>&1 || code=$?
  if ((code)); then
    echo "exit code $code" >>"$result.part/log.txt"
    rm -f "$result.part/diagnosis.json"
  fi
  mv "$result.part" "$result"
}

stop() {
  trap - INT TERM
  for job in $(jobs -p); do pkill -P "$job" || true; done
  wait
  echo
  echo "interrupted; resume with: benchmarks/blind/run.sh --cases $cases --seed $seed ${draw[*]:1}"
  exit 130
}
trap stop INT TERM

# run_method PROGRAM METHOD: all cases that have no result yet.
run_method() {
  local program=$1 method=$2 done=0 fresh=0 started=$SECONDS name left
  [[ -x $build/bin/$program ]] || { echo "$method: skipped, there is no $build/bin/$program"; return 0; }
  mkdir -p "$out/results/$method"
  for folder in "$out"/cases/case_*; do
    name=${folder##*/} done=$((done + 1))
    [[ -e $out/results/$method/$name/diagnosis.json ]] && continue
    while (($(jobs -rp | wc -l) >= jobs)); do wait -n || true; done
    diagnose "$program" "$method" "$name" &
    fresh=$((fresh + 1))
    left=$(((SECONDS - started) * (cases - done) / fresh))
    ((fresh % 10)) || echo "$method: $done of $cases, about $((left / 60)) min $((left % 60)) s left"
  done
  wait
  local failed
  failed=$(grep -l "^exit code" "$out/results/$method"/*/log.txt 2>/dev/null | wc -l) || true
  echo "$method: all $cases cases done, $failed failed (see log.txt of the case)"
}

run_method surefoot-diagnose surefoot-diagnose
# The sparse regression knows the models of the five families only.
[[ -n $machines ]] || run_method concealed_sparse_regression sparse_regression
run_method concealed_all_at_once all_at_once

methods=()
for method in surefoot-diagnose sparse_regression all_at_once; do
  [[ -d $out/results/$method ]] && methods+=(--results "$out/results/$method")
done
rm -f "$out/reliability.dat"
"$build/bin/concealed_score" --cases "$out" "${methods[@]}" --reliability "$out/reliability.dat" | tee "$out/score.txt.part"
mv "$out/score.txt.part" "$out/score.txt"
if [[ -e $out/reliability.dat ]] && command -v gnuplot >/dev/null; then
  gnuplot -e "data='$out/reliability.dat'; picture='$out/reliability.png'" benchmarks/blind/score/reliability.gp
fi
echo
echo "score: $out/score.txt"
