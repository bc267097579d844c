#!/usr/bin/env bash
# A process of a training is killed: the others must end with one sentence that names the checkpoint, and --resume must
# end in the bits of a training that was never disturbed, by one process.
#   lost_process.sh FOLDER_OF_PROGRAMS MPIRUN
set -euo pipefail
bin=$1 mpirun=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "lost_process.sh: $*" >&2; exit 1; }

options=(train --problem ha --budget 3 --seed 3 --checkpoint-every 0)
"$bin/sigmaban_approach" "${options[@]}" --threads 1 --out "$scratch/alone.policy" >"$scratch/alone.txt"

for lost in 0 1; do
  out=$scratch/lost$lost.policy
  rm -f "$scratch"/pid.rank*
  : >"$scratch/out.txt"  # else what the last run wrote is taken for this one's
  # shellcheck disable=SC2016
  "$mpirun" -n 2 bash -c 'echo $$ >"$0.rank${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-}}"; exec "$@"' "$scratch/pid" \
    "$bin/sigmaban_approach_mpi" "${options[@]}" --out "$out" >>"$scratch/out.txt" 2>"$scratch/err.txt" &
  run=$!
  for ((i = 0; i < 600; ++i)); do
    (($(grep -c iteration "$scratch/out.txt") < 4)) || break
    sleep 0.1
  done
  kill -9 "$(<"$scratch/pid.rank$lost")" || fail "the training was over before process $lost could be killed"
  code=0
  wait $run || code=$?
  ((code != 0)) || fail "mpirun ended with 0 though process $lost was killed"
  [[ ! -e $out ]] || fail "a policy was written though process $lost was killed"
  said=$(grep -c "^sigmaban_approach_mpi: " "$scratch/err.txt" || true)
  ((said == 1)) || { cat "$scratch/err.txt"; fail "$said sentences instead of one after process $lost was killed"; }
  grep "^sigmaban_approach_mpi: .* --resume goes on from $out.checkpoint" "$scratch/err.txt" ||
    { cat "$scratch/err.txt"; fail "no sentence that names the checkpoint"; }
  "$mpirun" -n 2 "$bin/sigmaban_approach_mpi" "${options[@]}" --out "$out" --resume >"$scratch/resumed.txt"
  (($(grep -c iteration "$scratch/resumed.txt") < $(grep -c iteration "$scratch/alone.txt"))) ||
    fail "the second run began anew"
  cmp "$scratch/alone.policy" "$out" || fail "the resumed policy differs from that of one process"
done

# A wrong option is told once, not by every process.
code=0
"$mpirun" -n 2 "$bin/sigmaban_approach_mpi" train --problem sideways --out "$scratch/x" >/dev/null 2>"$scratch/err.txt" ||
  code=$?
((code == 2)) || fail "exit code $code after a wrong option"
(($(grep -c "^sigmaban_approach_mpi: .*sideways" "$scratch/err.txt") == 1)) ||
  { cat "$scratch/err.txt"; fail "a wrong option must be told once"; }
echo "ended with one sentence, resumed to the same bits"
