#!/bin/sh
# gimparam, each of its subcommands: what it writes, reports and exits with.
# usage: gimparam_test.sh GIMPARAM GIMSHAPE
. "${0%/*}/expect.sh"
gimparam=$1 gimshape=$2
reported() { sed -n 's/^ *"'"$1"'": \([^,]*\),*$/\1/p' "$work/report.json"; }
within() { # what, lowest, highest, found
    expect "$1" yes "$(awk -v x="$4" -v l="$2" -v h="$3" 'BEGIN { print (x != "" && x >= l && x <= h) ? "yes" : x }')"
}
# The numbers of a list in the report, in order, one line: those after the key up to the next key.
numbers() { sed -n '/"'"$1"'": \[/,/"[a-z_]*":/p' "$work/report.json" | sed '$d' | sed -n 's/^ *\(-*[0-9][-+.e0-9]*\),*$/\1/p' | tr '\n' ' '; }
run() { "$gimparam" "$@" || failures=$((failures + 1)); }

"$gimshape" torus "$work/torus.ply" --resolution 6 > "$work/out" || exit 1
"$gimshape" genus "$work/two.ply" --genus 2 --resolution 6 > "$work/out" || exit 1
"$gimshape" cylinder "$work/cylinder.ply" --resolution 6 > "$work/out" || exit 1
"$gimshape" disk "$work/disk.ply" --resolution 6 > "$work/out" || exit 1
"$gimshape" sphere "$work/sphere.ply" --resolution 6 > "$work/out" || exit 1
# A Moebius band of six quads.
awk 'BEGIN { for (i = 0; i < 6; ++i) { t = i * 3.14159265 / 3
        for (s = -1; s <= 1; s += 2) { r = 3 + s * cos(t / 2); print "v", r * cos(t), r * sin(t), s * sin(t / 2) } }
    for (i = 0; i < 6; ++i) { a = 2 * i + 1; b = a + 1; c = i < 5 ? a + 2 : 2; d = i < 5 ? a + 3 : 1
        print "f", a, c, b; print "f", b, c, d } }' > "$work/moebius.obj"

# square, with its name and without
for square in "" square; do
    # shellcheck disable=SC2086 # no word at all where it is empty
    run $square --extrema 0 --param stretch --json "$work/report.json" "$work/torus.ply" "$work/map.obj"
    expect faces 144 "$(reported faces)"
    expect genus 1 "$(reported genus)"
    expect layout '"cut"' "$(reported layout)"
    expect param '"stretch"' "$(reported param)"
    expect extrema 0 "$(reported extrema)"
    expect flipped 0 "$(reported flipped)"
    expect lines "$(reported paths)" "$(grep -c '^l ' "$work/map.obj")"
    within efficiency 0.5 1 "$(reported stretch_efficiency)"
done
run --param tutte "$work/torus.ply" "$work/map.ply"
expect header 1 "$(grep -a -c 'property double quality' "$work/map.ply")"

# homology: four loops of a surface of genus 2, each a line
run homology --json "$work/report.json" "$work/two.ply" "$work/loops.obj"
expect "loops" 4 "$(grep -c '"name"' "$work/report.json")"
expect "lines" 4 "$(grep -c '^l ' "$work/loops.obj")"
expect "closed lines" 4 "$(awk '/^l/ && $2 == $NF' "$work/loops.obj" | wc -l | tr -d ' ')"
expect "intersections" "0 0 1 0 0 0 0 1 -1 0 0 0 0 -1 0 0 " "$(numbers intersections)"
run homology "$work/torus.ply" "$work/loops.ply"
expect "edges of loops" 1 "$(grep -c '^element edge [1-9]' "$work/loops.ply")"

# periods: the torus is symmetric, so its parallelogram is a rectangle; the file on standard output
"$gimparam" periods "$work/torus.ply" --json - > "$work/report.json" || failures=$((failures + 1))
expect genus 1 "$(reported genus)"
expect "branch points of a torus" 0 "$(reported branch_points)"
within angle 89.99 90.000001 "$(reported angle_degrees)"
within ratio 1 3 "$(reported length_ratio)"
expect "numbers of tau" 2 "$(numbers tau | wc -w | tr -d ' ')"
run periods --quiet --json "$work/report.json" "$work/two.ply"
expect genus 2 "$(reported genus)"
expect "numbers of the period matrix" 8 "$(numbers period_matrix | wc -w | tr -d ' ')"
expect "branch points" 2 "$(reported branch_points)"
within asymmetry 0 0.01 "$(reported asymmetry)"
expect "text" 1 "$("$gimparam" periods "$work/two.ply" | grep -c '^branch points    2$')"

# holomorphic: a list of numbers for each form
run holomorphic --json "$work/report.json" "$work/two.ply" "$work/forms.ply"
expect forms 2 "$(reported forms)"
expect "lists" 2 "$(grep -a -c '^property list uchar double form_[01]$' "$work/forms.ply")"
run holomorphic --form 1,-0.5+2i "$work/two.ply" "$work/forms.ply"
expect "one list" 1 "$(grep -a -c '^property list uchar double form_' "$work/forms.ply")"
run holomorphic --json "$work/report.json" "$work/cylinder.ply" "$work/forms.ply"
expect "forms of a cylinder" 1 "$(reported forms)"

# uv
run uv --handles --picture "$work/two.png" --picture-size 64 --look 0,-1,-1 --up 0,0,1 \
    --json "$work/report.json" "$work/two.ply" "$work/uv.obj"
expect "branch points" 2 "$(reported branch_points)"
expect "negative places" 0 "$(reported negative_places)"
within "median angle error" 0 6 "$(reported median_degrees)"
within "jump error" 0 1e-9 "$(reported jump_error)"
expect "handles" 2 "$(grep -c '"period_a"' "$work/report.json")"
expect "faces with texture" "$(reported faces)" "$(grep -c '^f [0-9]*/[0-9]* [0-9]*/[0-9]* [0-9]*/[0-9]*$' "$work/uv.obj")"
expect "picture" 1 "$(head -c 4 "$work/two.png" | grep -a -c PNG)"
run uv --modular "$work/two.ply" "$work/uv.ply"
expect "texture of faces" 1 "$(grep -a -c '^property list uchar float texcoord$' "$work/uv.ply")"
run uv --form 2i --json "$work/report.json" "$work/torus.ply" "$work/uv.obj"
expect "coefficients" "0.0 2.0 " "$(numbers coefficients)"
run uv --puncture 5,60 --json "$work/report.json" "$work/torus.ply" "$work/uv.obj"
expect "genus of the covering" 3 "$(reported covering_genus)"
expect "branch points of the covering" 4 "$(reported branch_points)"
run uv --puncture-tips 2 --json "$work/report.json" "$work/sphere.ply" "$work/uv.ply"
expect "genus of the covering" 1 "$(reported covering_genus)"
expect "flipped" 0 "$(reported flipped)"

# sphere
run sphere --json "$work/report.json" "$work/sphere.ply" "$work/ball.ply"
expect flipped 0 "$(reported flipped)"
within "mass centre" 0 1e-6 "$(reported mass_centre)"
run sphere --close-holes 300% --json "$work/report.json" "$work/cylinder.ply" "$work/ball.ply"
expect "holes closed" 2 "$(reported holes_closed)"
expect flipped 0 "$(reported flipped)"
refused 1 "$gimparam" sphere --close-holes 1% "$work/cylinder.ply" "$work/ball.ply"
refused 2 "$gimparam" sphere --close-holes 0 "$work/cylinder.ply" "$work/ball.ply"

# Exit codes, with one line on standard error each.
refused 1 "$gimparam" "$work/absent.ply" "$work/map.ply"
refused 1 "$gimparam" --param tutte "$work/torus.ply" "$work/absent/map.ply"
refused 2 "$gimparam" --param tutte "$work/torus.ply" "$work/map.stl"
refused 2 "$gimparam" --extrema -1 "$work/torus.ply" "$work/map.ply"
refused 2 "$gimparam" --layout octahedral "$work/torus.ply" "$work/map.ply"
refused 2 "$gimparam" "$work/torus.ply"
refused 2 "$gimparam" uv "$work/torus.ply"
refused 2 "$gimparam" uv --form 1,2 "$work/torus.ply" "$work/uv.obj"
refused 2 "$gimparam" uv --form 0 "$work/torus.ply" "$work/uv.obj"
refused 2 "$gimparam" uv --form 1+ "$work/torus.ply" "$work/uv.obj"
refused 2 "$gimparam" uv --form i "$work/cylinder.ply" "$work/uv.obj"
refused 2 "$gimparam" uv --puncture 999999 "$work/torus.ply" "$work/uv.obj"
refused 2 "$gimparam" uv "$work/torus.ply" "$work/uv.off"
refused 2 "$gimparam" uv --picture "$work/x.jpg" "$work/torus.ply" "$work/uv.obj"
refused 1 "$gimparam" uv "$work/torus.ply" "$work/absent/uv.obj"
refused 2 "$gimparam" holomorphic "$work/torus.ply" "$work/forms.obj"
refused 2 "$gimparam" homology "$work/torus.ply" "$work/loops.off"
for command in homology holomorphic uv; do
    refused 1 "$gimparam" $command "$work/disk.ply" "$work/out.ply"
    refused 1 "$gimparam" $command "$work/sphere.ply" "$work/out.ply"
    refused 1 "$gimparam" $command "$work/moebius.obj" "$work/out.ply"
done
for mesh in disk.ply cylinder.ply sphere.ply moebius.obj; do
    refused 1 "$gimparam" periods "$work/$mesh"
done
refused 1 "$gimparam" sphere "$work/torus.ply" "$work/ball.ply"
refused 1 "$gimparam" sphere "$work/disk.ply" "$work/ball.ply"

finish
