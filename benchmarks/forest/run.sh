#!/usr/bin/env bash
# Compares our forests with those of other libraries on the same data, everything on one core.
#   benchmarks/forest/run.sh [--quick] [OPTIONS OF forest_peers]     for example: --leaves 200,2000 --rounds 3
# --quick: fewer samples, sizes and rounds; minutes instead of half an hour.
# The build is kept in $SUREFOOT_BUILD_DIR, by default build/release; tables and plots go to <build>/forest.
# $SUREFOOT_CORE is the core to run on, by default the last one.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source cmake/packages.sh
require_packages "${build_packages[@]}" libdlib-dev libopencv-ml-dev libxgboost-dev python3-sklearn gnuplot-nox valgrind

table=() sizes=(--samples 50000 --leaves 3,6,20,60,200,600,2000,6000 --rounds 3) training=() scaling=()
if [[ ${1:-} == --quick ]]; then
  shift
  table=(--leaves 200,2000 --rounds 3)
  sizes=(--samples 10000 --leaves 3,6,20,60,200,600 --rounds 1)
  training=(--samples 5000,50000 --rounds 3)
  scaling=(--rounds 1)
fi

build=${SUREFOOT_BUILD_DIR:-build/release}
core=${SUREFOOT_CORE:-$(($(nproc) - 1))}
programs=(forest_peers forest_training forest_scaling forest_instructions)
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=OFF -D SUREFOOT_BENCHMARKS=ON
cmake --build "$build" --target "${programs[@]}"

out=$build/forest
bin=$build/bin
peers=benchmarks/forest/peers
mkdir -p "$out"

echo "== every library"
taskset -c "$core" "$bin/forest_peers" "${table[@]}" "$@" --csv "$out/peers.csv" | tee "$out/peers.txt"

echo "== many sizes, the same samples for all"
taskset -c "$core" "$bin/forest_peers" --trees 1,5,25 "${sizes[@]}" --without 'linear, portable;surefoot C' \
  --csv "$out/sizes.csv" >"$out/sizes.txt"
gnuplot -e "csv='$out/sizes.csv'; folder='$out'; scripts='$peers'" "$peers/plot_compare.gp"
for outputs in 1 3; do
  for x in '10 bytes' '7 time, warm' '8 time, cold' '9 time, batch'; do
    echo "$outputs output(s), forests without linear leaves beaten by one with in error and ${x#* }:"
    awk -F';' -v x="${x%% *}" -v outputs="$outputs" -f "$peers/best.awk" "$out/sizes.csv"
  done
done | tee "$out/best.txt"

echo "== training"
taskset -c "$core" "$bin/forest_training" "${training[@]}" --script "$peers/train_sklearn.py" | tee "$out/training.txt"

echo "== scaling"
"$bin/forest_scaling" "${scaling[@]}" >"$out/scaling.csv"
gnuplot -e "csv='$out/scaling.csv'; folder='$out'" "$peers/plot_scaling.gp"
awk -F';' '$1 == "threads" { printf "%d threads, %s leaves: training %.3f s\n", $2, $3, $4 }' "$out/scaling.csv"

echo "== instructions per warm prediction, 200 leaves"
predictions=$(valgrind --quiet --tool=callgrind --callgrind-out-file="$out/callgrind.out" \
  --toggle-collect='*predict_all_points*' "$bin/forest_instructions")
awk -v n="$predictions" '/^(summary|totals):/ { print int($2 / n); exit }' "$out/callgrind.out" | tee "$out/instructions.txt"
echo "tables and plots: $out"
