#!/usr/bin/env bash
# What including surefoot costs a user: seconds, peak memory and object size of one small program per area at -O2, both
# ways (headers alone; with surefoot::compiled), as a ratio to a program that solves one dense system with Eigen.
#   benchmarks/compile/run.sh [--repetitions N] [--files]     (--help says more; $CXX is the compiler, by default g++)
# Prints a Markdown table and writes <build>/compile.json; the build is $SUREFOOT_BUILD_DIR, by default build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
exec python3 -B benchmarks/compile/compile_cost.py --build "${SUREFOOT_BUILD_DIR:-build/release}" "$@"
