#!/bin/sh
# gimdec and giminfo on the golden and the malformed files: what they print, write and exit with.
# usage: tools_test.sh GIMDEC GIMINFO TESTS_FOLDER
. "${0%/*}/expect.sh"
gimdec=$1 giminfo=$2 tests=$3

golden=$tests/golden/v1-wavelet-boundary.gim
expect "seam word" "seam       a B c a' c' D" "$("$giminfo" "$golden" | grep '^seam')"
expect "lengths" "lengths    a=12 B=10 c=8 D=14" "$("$giminfo" "$golden" | grep '^lengths')"
expect "surface" "surface    genus 1, 1 boundary loop" "$("$giminfo" "$golden" | grep '^surface')"
expect "json word" '    "word": "a B c a'"'"' c'"'"' D",' "$("$giminfo" --json "$golden" | grep '"word"')"
expect "json total" "    \"total\": $(wc -c < "$golden" | tr -d ' ')," "$("$giminfo" --json "$golden" | grep -m 1 '"total"')"

# A torus of 33 x 33 samples has 32 * 32 vertices; the next level 16 * 16.
torus=$tests/golden/v1-wavelet-torus-normals.gim
"$gimdec" "$torus" "$work/fine.obj" || failures=$((failures + 1))
expect "fine vertices" 1024 "$(grep -c '^v ' "$work/fine.obj")"
expect "fine normals" 1024 "$(grep -c '^vn ' "$work/fine.obj")"
expect "fine faces" 2048 "$(grep -c '^f ' "$work/fine.obj")"
"$gimdec" --level 1 --json "$work/report.json" "$torus" "$work/coarse.obj" || failures=$((failures + 1))
expect "coarse vertices" 256 "$(grep -c '^v ' "$work/coarse.obj")"
expect "report" '  "vertices": 256,' "$(grep '"vertices"' "$work/report.json")"
"$gimdec" --no-fuse "$torus" "$work/open.obj" || failures=$((failures + 1))
expect "unfused vertices" 1089 "$(grep -c '^v ' "$work/open.obj")"
for extension in ply off stl; do
    "$gimdec" "$torus" "$work/mesh.$extension" && [ -s "$work/mesh.$extension" ] || failures=$((failures + 1))
done
"$gimdec" --image "$work/image.png" --normal-map "$work/normals.png" "$torus" "$work/mesh.ply" || failures=$((failures + 1))
for picture in image normals; do
    expect "$picture.png" PNG "$(dd if="$work/$picture.png" bs=1 skip=1 count=3 2>/dev/null)"
done
"$gimdec" --image "$work/image.exr" "$torus" "$work/mesh.ply" && [ -s "$work/image.exr" ] || failures=$((failures + 1))

# The first third of a file gives the whole surface, coarser, and a warning.
fine=$tests/golden/v1-surface-fine-step.gim
dd if="$fine" of="$work/prefix.gim" bs=1 count=5000 2>/dev/null
"$gimdec" --json "$work/report.json" "$work/prefix.gim" "$work/prefix.obj" 2>"$work/warning" || failures=$((failures + 1))
"$gimdec" "$fine" "$work/fine.obj" || failures=$((failures + 1))
expect "prefix faces" "$(grep -c '^f ' "$work/fine.obj")" "$(grep -c '^f ' "$work/prefix.obj")"
expect "prefix vertices" "$(grep -c '^v ' "$work/fine.obj")" "$(grep -c '^v ' "$work/prefix.obj")"
expect "prefix report" '  "cut_short": true,' "$(grep '"cut_short"' "$work/report.json")"
expect "prefix warning" 1 "$(grep -c 'is cut short: [0-9]* of [0-9]* bytes of the surface are missing' "$work/warning")"
refused 1 "$gimdec" --whole "$work/prefix.gim" "$work/prefix.ply"
refused 1 "$giminfo" "$work/prefix.gim"

# Exit codes, with one line on standard error each.
for file in "$tests"/malformed/*.gim; do
    case $file in
    */limit-*) continue ;; # within the limits the tools set
    esac
    refused 1 "$gimdec" "$file" "$work/mesh.ply"
    case $file in
    */corrupt-12bit-step-* | */corrupt-least-* | */corrupt-step-* | */corrupt-lowest-* | */corrupt-geometry-* | */unsupported-* | */more-input-*)
        refused 1 "$giminfo" "$file"
        ;;
    esac
done
refused 1 "$gimdec" "$work/absent.gim" "$work/mesh.ply"
refused 1 "$giminfo" "$work/absent.gim"
refused 1 "$gimdec" --level 3 "$torus" "$work/mesh.ply"
refused 1 "$gimdec" --normal-map "$work/normals.png" "$golden" "$work/mesh.ply"
refused 1 "$gimdec" "$torus" "$work/absent/mesh.ply"
refused 2 "$gimdec" "$torus" "$work/mesh.xyz"
refused 2 "$gimdec" --image "$work/image.bmp" "$torus" "$work/mesh.ply"
refused 2 "$gimdec" --colour "$torus" "$work/mesh.ply"
refused 2 "$gimdec" "$torus"
refused 2 "$giminfo"

finish
