#!/usr/bin/env bash
# Which lines of the library its tests run: tests/coverage.sh [AREA...], by default all of core forest optimize motion diagnose
# solve; apps and examples are others. Works on a bare Debian 12 with clang 19. Prints lines, lines run and the missing ones of every file;
# html/index.html of the build has the lines themselves. The build is kept in $SUREFOOT_BUILD_DIR, by default build/coverage.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/packages.sh
require_packages "${build_packages[@]}" doctest-dev clang-19 libclang-rt-19-dev llvm-19

areas=("$@")
((${#areas[@]})) || areas=(core forest optimize motion diagnose solve)
for area in "${areas[@]}"; do
  if ! [[ -d tests/$area ]]; then
    echo "surefoot: there is no area $area; those of tests/ are meant, like core" >&2
    exit 2
  fi
done
build=$(realpath -m "${SUREFOOT_BUILD_DIR:-build/coverage}")
programs=OFF
[[ " ${areas[*]} " =~ " apps "|" examples " ]] && programs=ON
# Clang counts what the source says before it is optimised, so that inlining hides no line.
cmake -S . -B "$build" -G Ninja -D CMAKE_CXX_COMPILER=clang++-19 -D CMAKE_BUILD_TYPE=Debug -D SUREFOOT_APPS=$programs \
  -D SUREFOOT_EXAMPLES=$programs -D SUREFOOT_BENCHMARKS=OFF -D CMAKE_CXX_FLAGS_DEBUG="-O1 -fprofile-instr-generate -fcoverage-mapping"
targets=("${areas[@]/#/surefoot_}")
cmake --build "$build" --target "${targets[@]/%/_tests}"
rm -rf "$build/profiles" "$build/html"
LLVM_PROFILE_FILE="$build/profiles/%4m.profraw" \
  ctest --test-dir "$build" --output-on-failure -R "^($(IFS='|' && echo "${areas[*]}"))$"
llvm-profdata-19 merge -o "$build/tests.profdata" "$build"/profiles/*.profraw

files=() what=("$build/bin/surefoot_${areas[0]}_tests" -instr-profile "$build/tests.profdata")
for area in "${areas[@]}"; do
  what+=(-object "$build/bin/surefoot_${area}_tests")
  folder=include/surefoot/$area
  [[ $area == apps || $area == examples ]] && folder=$area
  mapfile -t -O "${#files[@]}" files < <(find "$PWD/$folder" -name '*.?pp' | sort)
done
llvm-cov-19 show "${what[@]}" -format=html -output-dir "$build/html" "${files[@]}"
llvm-cov-19 export "${what[@]}" -format=lcov "${files[@]}" |
  awk -v root="$PWD/" '
    function line(name, of, run, missing) { printf "%-56s %6d %6d %5.1f %%  %s\n", name, of, run, 100 * run / of, missing }
    /^SF:/ { name = substr($0, 4); sub(root, "", name); of = run = 0; missing = "" }
    /^DA:/ { split(substr($0, 4), at, ","); ++of; if (at[2] > 0) ++run; else missing = missing " " at[1] }
    /^end_of_record/ && of { line(name, of, run, missing); all += of; all_run += run }
    END { line("all", all, all_run, "") }' | tee "$build/coverage.txt"
