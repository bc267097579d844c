#!/usr/bin/env bash
# Builds and runs every benchmark and writes one JSON file, {"<area>": <Google Benchmark's report>, ...}.
# Arguments go to every benchmark program, for example: benchmarks/run.sh --benchmark_filter=predict
# The build is kept in $SUREFOOT_BUILD_DIR, by default build/release; the result is <build>/benchmarks.json.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/packages.sh
require_packages "${build_packages[@]}" libbenchmark-dev libpagmo-dev

build=${SUREFOOT_BUILD_DIR:-build/release}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=OFF -D SUREFOOT_BENCHMARKS=ON
cmake --build "$build"

result=$build/benchmarks.json
: >"$result.part"
separator='{'
for program in "$build"/bin/surefoot_*_benchmarks; do
  area=${program##*/surefoot_} area=${area%_benchmarks}
  echo "== $area"
  "$program" --benchmark_out="$build/$area.json" --benchmark_out_format=json "$@"
  printf '%s"%s": ' "$separator" "$area" >>"$result.part"
  cat "$build/$area.json" >>"$result.part"
  separator=','
done
echo '}' >>"$result.part"
mv "$result.part" "$result"
echo "benchmarks: $result"
