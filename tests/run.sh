#!/usr/bin/env bash
# Builds and runs every test; works on a bare Debian 12. Arguments go to ctest, for example: tests/run.sh -R forest
# The build is kept in $SUREFOOT_BUILD_DIR, by default build/dev.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source cmake/packages.sh
require_packages "${build_packages[@]}" doctest-dev gnuplot-nox libmujoco-dev pkg-config python3 \
  libopenmpi-dev openmpi-bin dpkg-dev file mkdocs mkdocs-material python3-pymdownx doxygen

build=${SUREFOOT_BUILD_DIR:-build/dev}
# Line numbers are for debuggers, and tests wait for servos and processes now and then: one more at a time than cores.
cmake --preset dev -B "$build" -D CMAKE_CXX_FLAGS_RELWITHDEBINFO=-Og -D SUREFOOT_TESTS=ON -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=OFF
cmake --build "$build"
ctest --test-dir "$build" --output-on-failure -j $(($(nproc) + 1)) "$@"
