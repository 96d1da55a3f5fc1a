#!/usr/bin/env bash
# Tries the Slurm recipe of docs/many-meshes.md for real: a dozen shapes as an array job on a Slurm of this machine
# alone, one task killed in the middle, the array submitted again, the records merged, and every file compared with
# that of a local run; then a sweep in parts, its report compared with that of a local sweep. Needs root, slurm-wlm,
# munge, gnuplot-nox and build/release. Not part of ./test.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
recipes=$PWD
PATH=$(cd ../../build/release/bin && pwd):$PATH
work=$(mktemp -d)
# shellcheck source=bench/slurm/one-machine.sh
. ./one-machine.sh

fail() {
  echo "check.sh: $*" >&2
  tail -n 5 "$work"/*.log >&2 2>/dev/null || true
  exit 1
}
status_of() { tail -n +2 "$1" | cut -d, -f4 | sort | uniq -c | xargs; } # "12 done"
# Not sbatch --wait: its exit status tells of failed tasks too, and one is to fail here.
ended() { [ -z "$(squeue --noheader --job "$1" 2>/dev/null)" ]; }

start_slurm || fail "Slurm does not start"
cd "$work"
mkdir meshes
for resolution in 8 12 16; do
  for shape in wavy-sphere torus trefoil genus; do
    gimshape $shape meshes/$shape-$resolution.ply --resolution $resolution >/dev/null
    echo "meshes/$shape-$resolution.ply out/$shape-$resolution.gim"
  done
done >list
options=(--bytes 4000 --grid 129)

echo "== local run"
sed 's: out/: local/:' list >local-list
gimenc --batch local-list "${options[@]}" --jobs 2 --threads 1 | tail -n 1

echo "== array job, task 2 of 3 killed after its first mesh"
submit() { sbatch --parsable --array=1-3 --cpus-per-task=1 "$recipes/gimenc-batch.sbatch" list "${options[@]}"; }
second=$(sed -n 2p list | cut -d ' ' -f 2) # the first line of part 2
job=$(submit)
until_true 120 "$second.json" test -e "$second.json"
scancel --signal=KILL --full "${job}_2"
until_true 300 "the array job" ended "$job"
gimenc --batch list "${options[@]}" --merge killed.csv || true
[ "$(status_of killed.csv)" != "12 done" ] || fail "the killed task had no line left"
[ -z "$(find out -type f ! -name '*.gim' ! -name '*.gim.json' ! -name '.gimenc-*')" ] || fail "unknown files in out"
for file in out/*.gim; do cmp "$file" "local/${file#out/}"; done
find out -name '*.gim' -printf '%i %f\n' | sort >finished

echo "== the array submitted again"
again=$(submit)
until_true 300 "the array job" ended "$again"
tail -qn 1 gimenc-"$again"_*.log
gimenc --batch list "${options[@]}" --merge results.csv
[ "$(status_of results.csv)" = "12 done" ] || fail "merged: $(status_of results.csv)"
for file in out/*.gim; do cmp "$file" "local/${file#out/}"; done
find out -name '*.gim' -printf '%i %f\n' | sort >all
[ -z "$(comm -23 finished all)" ] || fail "finished files were made again: $(comm -23 finished all)"
cut -d, -f 2,4-8 results.csv

some=$(sbatch --parsable --array=2-3 "$recipes/gimenc-batch.sbatch" list "${options[@]}")
until_true 60 "the array job" ended "$some"
grep -q "submit with --array=1-N" gimenc-"$some"_2.log || fail "a part of an array was not refused"
echo "== all 12 files equal those of the local run; $(wc -l <finished) were finished before the kill and left alone"

echo "== a sweep in two parts, and its report"
sweep=(meshes/torus-8.ply meshes/genus-8.ply --bytes 500,1000,2000,4000 --coders gim --peers raw-zlib --grids 65)
gimrd sweep "${sweep[@]}" --out swept-here >/dev/null 2>swept-here.log
parts=$(sbatch --parsable --array=1-2 --cpus-per-task=1 "$recipes/gimrd-sweep.sbatch" "${sweep[@]}" --out swept)
until_true 300 "the sweep" ended "$parts"
[ ! -e swept/report.html ] || fail "a part of a sweep wrote the report"
find swept/points -name '*.json' -printf '%i %f\n' | sort >points
[ "$(wc -l <points)" = 16 ] || fail "$(wc -l <points) of 16 points after both parts"
gimrd sweep "${sweep[@]}" --out swept >/dev/null 2>swept.log
[ -z "$(find swept/points -name '*.json' -printf '%i %f\n' | sort | comm -13 points -)" ] || fail "points were made again"
for file in results.csv results.json; do cmp "swept/$file" "swept-here/$file"; done
echo "== 16 points, none made twice; results.csv and results.json equal those of the local sweep"
