#!/usr/bin/env bash
# Feeds every reader of files and streams with bytes that libFuzzer makes up: tests/fuzz.sh [SECONDS [READER...]], by
# default 20 seconds for each. Works on a bare Debian 12 with clang 19. Ends with 1 at the first finding, whose bytes are kept.
# The build is kept in $SUREFOOT_BUILD_DIR, by default build/fuzz, what was learnt there in corpus/, findings in findings/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/packages.sh
require_packages "${build_packages[@]}" doctest-dev clang-19 libclang-rt-19-dev

seconds=${1:-20}
shift || true
readers=("$@")
build=${SUREFOOT_BUILD_DIR:-build/fuzz}
cmake -S . -B "$build" -G Ninja -D CMAKE_CXX_COMPILER=clang++-19 -D CMAKE_BUILD_TYPE=RelWithDebInfo \
  -D CMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1" -D SUREFOOT_FUZZ=ON -D SUREFOOT_BENCHMARKS=OFF \
  -D CMAKE_CXX_FLAGS="-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer"
cmake --build "$build" --target surefoot_fuzz
if ((${#readers[@]} == 0)); then
  # Its usage names them.
  read -ra readers <<<"$("$build/bin/surefoot_fuzz" 2>&1 | sed -n 's/.*the readers are: //p')"
fi

for reader in "${readers[@]}"; do
  corpus=$build/corpus/$reader
  mkdir -p "$corpus" "$build/findings"
  seeds=()
  [[ -d tests/fuzz/seeds/$reader ]] && seeds+=("tests/fuzz/seeds/$reader")
  # Files of earlier versions are seeds as well.
  case $reader in
    forest) cp tests/fixtures/*/*.forest "$corpus" ;;
    policy) cp tests/fixtures/*/*.policy "$corpus" ;;
    checkpoint) cp tests/fixtures/*/*.rfpi "$corpus" ;;
    search) cp tests/fixtures/*/*.cma "$corpus" ;;
    motion) cp tests/fixtures/*/motion.json "$corpus" ;;
    parameters) cp tests/fixtures/*/tuned.json "$corpus" ;;
  esac
  log=$build/fuzz_$reader.log
  if ! "$build/bin/surefoot_fuzz" "$reader" -max_total_time="$seconds" -max_len=16384 -timeout=10 -rss_limit_mb=2048 \
    -malloc_limit_mb=512 -print_final_stats=1 -artifact_prefix="$build/findings/$reader-" "$corpus" "${seeds[@]}" \
    >"$log" 2>&1; then
    tail -n 40 "$log" >&2
    echo "surefoot: $reader: a finding, see $log" >&2
    exit 1
  fi
  echo "$reader: $(sed -n 's/^Done \([0-9]*\) runs in \([0-9]*\) second.*/\1 inputs in \2 s, nothing found/p' "$log")"
done
