#!/usr/bin/env bash
# The blind benchmark on many processes, one case after the other in each; then benchmarks/blind/run.sh scores them.
#   benchmarks/mpi/blind.sh --seed S [--processes N] [--cases N] [--families LIST]
# Case k is process k modulo N's. Cases that have a result are left out, so that the same command resumes. All processes
# must see the same results folder. MPI options (machines, binding) go into $SUREFOOT_MPIRUN, by default "mpirun".
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

build=${SUREFOOT_BUILD_DIR:-build/release}
results=${SUREFOOT_RESULTS_DIR:-results}

# --share OUT BUILD: what each process does.
if [[ ${1:-} == --share && $# == 3 ]]; then
  out=$2 build=$3 rank=${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-}} size=${OMPI_COMM_WORLD_SIZE:-${PMI_SIZE:-}} number=0
  [[ -n $rank && -n $size ]] || { echo "blind.sh: --share is for processes that mpirun starts" >&2; exit 2; }
  for folder in "$out"/cases/case_*; do
    result=$out/results/surefoot-diagnose/${folder##*/}
    if ((number++ % size != rank)) || [[ -e $result/diagnosis.json ]]; then continue; fi
    rm -rf "$result" "$result.part"
    mkdir -p "$result.part"
    code=0
    timeout 900 "$build/bin/surefoot-diagnose" --model "$folder/model.toml" --out "$result.part" --quiet --threads 1 \
      "$folder"/rec_*.csv >"$result.part/log.txt" 2>&1 || code=$?
    if ((code)); then
      echo "exit code $code" >>"$result.part/log.txt"
      rm -f "$result.part/diagnosis.json"
    fi
    mv "$result.part" "$result"
  done
  exit
fi

processes=$(nproc) cases=200 seed='' families=servo,carriage,tanks,walk,walk_final
while (($#)); do
  case $1 in
    --processes | --cases | --seed | --families)
      (($# > 1)) || { echo "blind.sh: $1 needs a value" >&2; exit 2; }
      declare "${1#--}=$2"
      shift 2 ;;
    *) echo "blind.sh: unknown option $1; known: --seed S, --processes N, --cases N, --families LIST" >&2; exit 2 ;;
  esac
done
for number in processes cases seed; do
  [[ ${!number} =~ ^[1-9][0-9]*$ ]] || { echo "blind.sh: --$number needs a positive whole number, not '${!number}'" >&2; exit 2; }
done

source cmake/packages.sh
require_packages "${build_packages[@]}" openmpi-bin
# As root too, as in a container.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
cmake --preset release -B "$build" -D SUREFOOT_TESTS=OFF -D SUREFOOT_EXAMPLES=ON -D SUREFOOT_BENCHMARKS=ON
cmake --build "$build" --target surefoot-diagnose concealed_programs

out=$results/concealed_$seed asked="$cases cases of $families"
if [[ ! -e $out/plants.txt || $(<"$out/plants.txt") != "$asked" ]]; then
  mkdir -p "$out"
  rm -rf "$out/cases" "$out/truth" "$out/results"
  "$build/bin/concealed_plants" --out "$out" --cases "$cases" --seed "$seed" --families "$families"
  echo "$asked" >"$out/plants.txt"
fi
mkdir -p "$out/results/surefoot-diagnose"
read -ra mpirun <<<"${SUREFOOT_MPIRUN:-mpirun}"
"${mpirun[@]}" -n "$processes" benchmarks/mpi/blind.sh --share "$out" "$build"
benchmarks/blind/run.sh --cases "$cases" --seed "$seed" --families "$families" --jobs "$processes"
