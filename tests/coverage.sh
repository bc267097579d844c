#!/usr/bin/env bash
# Which lines of the library its tests run: tests/coverage.sh [AREA...], by default core forest optimize motion; others are solve,
# diagnose and examples. Works on a bare Debian 12. Prints lines, lines run and the missing ones of every header; the pages with the
# lines themselves are in html/ of the build, which is kept in $SUREFOOT_BUILD_DIR, by default build/coverage.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/packages.sh
require_packages "${build_packages[@]}" doctest-dev gcovr

areas=("$@")
((${#areas[@]})) || areas=(core forest optimize motion)
for area in "${areas[@]}"; do
  if ! [[ -d tests/$area ]]; then
    echo "surefoot: there is no area $area; those of tests/ are meant, like core" >&2
    exit 2
  fi
done
build=${SUREFOOT_BUILD_DIR:-build/coverage}
examples=OFF
[[ " ${areas[*]} " == *" examples "* ]] && examples=ON
# Without inlining a line is counted where it stands, and without optimisation every line is one.
cmake -S . -B "$build" -G Ninja -D CMAKE_BUILD_TYPE=Debug -D SUREFOOT_EXAMPLES=$examples -D SUREFOOT_BENCHMARKS=OFF \
  -D CMAKE_CXX_FLAGS_DEBUG="-O0 --coverage -fprofile-update=atomic -fprofile-abs-path -Wno-maybe-uninitialized"
targets=("${areas[@]/#/surefoot_}")
cmake --build "$build" --target "${targets[@]/%/_tests}"
find "$build" -name '*.gcda' -delete
ctest --test-dir "$build" --output-on-failure -R "^($(IFS='|' && echo "${areas[*]}"))$"

filters=()
for area in "${areas[@]}"; do
  [[ $area == examples ]] && filters+=(--filter examples/) || filters+=(--filter "include/surefoot/$area/")
done
mkdir -p "$build/html"
gcovr --root . "${filters[@]}" --gcov-ignore-parse-errors --html-details "$build/html/index.html" --txt "$build/coverage.txt" "$build"
cat "$build/coverage.txt"
