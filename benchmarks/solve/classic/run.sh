#!/usr/bin/env bash
# The classic problems: references (kept in results/references.csv), trainings, the table, a picture of learning curves.
#   benchmarks/solve/classic/run.sh [SECONDS [SEEDS [NAME...]]]     by default 60 counted seconds, 5 seeds, all problems
# The build is kept in $SUREFOOT_BUILD_DIR, by default build/release; returns and curves go to <build>/classic.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
build=${SUREFOOT_BUILD_DIR:-build/release}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=OFF > /dev/null
cmake --build "$build" --target classic_problems
out=$build/classic
mkdir -p "$out"
cp -n benchmarks/solve/classic/results/references.csv "$out" || true
"$build"/bin/classic_problems train "$out" "${1:-60}" "${2:-5}" "${@:3}"
"$build"/bin/classic_problems table "$out" | tee "$out/table.md"
if command -v gnuplot > /dev/null; then
  {
    echo "set terminal pngcairo size 1600,1200; set output '$out/curves.png'; set multiplot layout 4,5; set key off"
    echo "set logscale x; set xlabel 'CPU seconds'"
    for curve in "$out"/curves/*_1.dat; do
      name=$(basename "$curve" _1.dat)
      line=$(awk -F, -v n="$name" '$1 == n {print $2}' "$out/references.csv")
      files=$(for f in "$out"/curves/"${name}"_[0-9].dat; do printf "'%s' using 1:3 with lines, " "$f"; done)
      echo "set title '${name//_/ }'; plot ${files} ${line:-0} with lines dashtype 2"
    done
  } | gnuplot
fi
