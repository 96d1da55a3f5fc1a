#!/bin/sh
# gimparam on a torus: what it writes, reports and exits with.
# usage: gimparam_test.sh GIMPARAM GIMSHAPE
. "${0%/*}/expect.sh"
gimparam=$1 gimshape=$2
reported() { sed -n 's/^ *"'"$1"'": \([^,]*\),*$/\1/p' "$work/report.json"; }

"$gimshape" torus "$work/torus.ply" --resolution 6 > "$work/out" || exit 1
"$gimparam" --extrema 0 --param stretch --json "$work/report.json" "$work/torus.ply" "$work/map.obj" ||
    failures=$((failures + 1))
expect faces 144 "$(reported faces)"
expect genus 1 "$(reported genus)"
expect layout '"cut"' "$(reported layout)"
expect param '"stretch"' "$(reported param)"
expect extrema 0 "$(reported extrema)"
expect flipped 0 "$(reported flipped)"
expect lines "$(reported paths)" "$(grep -c '^l ' "$work/map.obj")"
expect efficiency 0.5 "$(awk -v e="$(reported stretch_efficiency)" 'BEGIN { print (e > 0.5 && e < 1) ? 0.5 : e }')"
"$gimparam" --param tutte "$work/torus.ply" "$work/map.ply" || failures=$((failures + 1))
expect header 1 "$(grep -a -c 'property double quality' "$work/map.ply")"

# Exit codes, with one line on standard error each.
refused 1 "$gimparam" "$work/absent.ply" "$work/map.ply"
refused 1 "$gimparam" --param tutte "$work/torus.ply" "$work/absent/map.ply"
refused 2 "$gimparam" --param tutte "$work/torus.ply" "$work/map.stl"
refused 2 "$gimparam" --extrema -1 "$work/torus.ply" "$work/map.ply"
refused 2 "$gimparam" --layout octahedral "$work/torus.ply" "$work/map.ply"
refused 2 "$gimparam" "$work/torus.ply"

finish
