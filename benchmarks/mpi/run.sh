#!/usr/bin/env bash
# How much faster two processes train than one, one thread each, and whether they find the same policy.
#   benchmarks/mpi/run.sh [--budget SECONDS] [--rounds N] [--processes N]
# Each round trains with one process and with several, one after the other; the medians count. For a quiet machine with
# a core per process. Results go to $SUREFOOT_RESULTS_DIR/mpi, by default under results; the build to
# $SUREFOOT_BUILD_DIR, by default build/release.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

budget=60 rounds=3 processes=2
while (($#)); do
  case $1 in
    --budget | --rounds | --processes)
      (($# > 1)) || { echo "run.sh: $1 needs a value" >&2; exit 2; }
      [[ $2 =~ ^[1-9][0-9]*$ ]] || { echo "run.sh: $1 needs a positive whole number, not '$2'" >&2; exit 2; }
      declare "${1#--}=$2"
      shift 2 ;;
    *) echo "run.sh: unknown option $1; known: --budget SECONDS, --rounds N, --processes N" >&2; exit 2 ;;
  esac
done

source cmake/packages.sh
require_packages "${build_packages[@]}" libopenmpi-dev openmpi-bin
build=${SUREFOOT_BUILD_DIR:-build/release}
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON -D SUREFOOT_MPI=ON
cmake --build "$build" --target sigmaban_approach sigmaban_approach_mpi mpi_benchmark

# As root too, as in a container.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
((processes <= $(nproc))) || export OMPI_MCA_rmaps_base_oversubscribe=1
out=${SUREFOOT_RESULTS_DIR:-results}/mpi
mkdir -p "$out"
: >"$out/seconds.txt"
echo "load of the machine before: $(cut -d' ' -f1-3 /proc/loadavg), $(nproc) cores"

# train N: trains with N processes and notes the seconds.
train() {
  local began=$EPOCHREALTIME
  mpirun -n "$1" "$build/bin/sigmaban_approach_mpi" train --problem ha --budget "$budget" --seed 1 \
    --out "$out/$1.policy" >"$out/$1.txt"
  awk -v n="$1" -v a="$began" -v b="$EPOCHREALTIME" 'BEGIN { printf "%d %.2f\n", n, b - a }' | tee -a "$out/seconds.txt"
}
"$build/bin/sigmaban_approach" train --problem ha --budget "$budget" --seed 1 --threads 1 --out "$out/0.policy" >"$out/0.txt"
for ((i = 0; i < rounds; ++i)); do
  train 1
  train "$processes"
  cmp "$out/0.policy" "$out/1.policy"
  cmp "$out/0.policy" "$out/$processes.policy"
done
sort -k1,1n -k2,2n "$out/seconds.txt" | awk -v p="$processes" '
  { seconds[$1] = seconds[$1] " " $2 }
  function median(list, items, n) { n = split(list, items, " "); return (items[int((n + 1) / 2)] + items[int(n / 2) + 1]) / 2 }
  END { one = median(seconds[1]); many = median(seconds[p])
        printf "median: %.2f s with 1 process, %.2f s with %d: %.2f times the throughput, the same policy file\n",
               one, many, p, one / many }' | tee "$out/ratio.txt"

for n in 1 "$processes"; do
  mpirun -n "$n" "$build/bin/mpi_benchmark" rfpi "$budget" >"$out/rfpi_$n.csv"
  mpirun -n "$n" "$build/bin/mpi_benchmark" curve 40 >"$out/curve_$n.csv"
done
tail -n 1 "$out/rfpi_1.csv" "$out/rfpi_$processes.csv" "$out/curve_1.csv" "$out/curve_$processes.csv"
