#!/usr/bin/env bash
# fetch_test.sh FETCH: runs the script on a manifest and a package of its own, with an npm that only packs and counts.
set -euo pipefail
fetch=$1
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
unset GIMG_CORPUS_DIR
export PATH=$dir/bin:$PATH

expect() { # expect EXIT_CODE COMMAND...: output in file "out", messages in file "err"
  local wanted=$1 got=0
  shift
  "$@" >out 2>err || got=$?
  [ "$got" = "$wanted" ] || { echo "exit code $got, not $wanted: $*"; cat err; exit 1; }
}
same() { [ "$1" = "$2" ] || { echo "found '$1', expected '$2'"; exit 1; }; }

mkdir -p bin corpus package/models
cp "$fetch" corpus/fetch
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n' >package/models/plain.off
gzip -c package/models/plain.off >package/models/packed.off.gz
tar -czf package/models/nested.tar.gz package/models/plain.off
tar -czf shapes-1.0.0.tgz package
sum=$(sha256sum package/models/plain.off | cut -d ' ' -f 1)
cat >bin/npm <<END
#!/bin/sh
echo "\$*" >>$dir/calls
cp $dir/shapes-1.0.0.tgz .
END
chmod +x bin/npm
entry() { printf 'mesh: %s\norigin: npm:shapes@1.0.0\npath: %s\nsha256: %s\n\n' "$@"; }
{
  entry plain package/models/plain.off "$sum"
  entry packed package/models/packed.off.gz "$sum"
  entry nested "package/models/nested.tar.gz package/models/plain.off" "$sum"
  entry forged package/models/plain.off "${sum//[0-9]/0}"
  entry absent package/models/nothing.off "$sum"
} >corpus/manifest

# Each way of being packed; one download for all meshes of a package, none for a mesh that is there.
expect 0 corpus/fetch plain packed nested
same "$(cat out)" "$dir/corpus/cache/plain.off
$dir/corpus/cache/packed.off
$dir/corpus/cache/nested.off"
for name in plain packed nested; do cmp package/models/plain.off "corpus/cache/$name.off"; done
same "$(wc -l <calls)" 1
rm -r corpus/cache/packages
expect 0 corpus/fetch plain
same "$(wc -l <calls)" 1

# A damaged file is replaced.
echo x >>corpus/cache/plain.off
expect 0 corpus/fetch plain
cmp package/models/plain.off corpus/cache/plain.off

# What does not match its checksum is refused and not kept.
expect 1 corpus/fetch forged
grep -q 'checksum mismatch' err
same "$(find corpus/cache -name 'forged*')" ""
expect 1 corpus/fetch absent
same "$(find corpus/cache -name 'absent*' -o -name '.fetch*')" ""

# Other places for the cache, unknown names, wrong usage.
expect 0 corpus/fetch --dir elsewhere plain
same "$(cat out)" "$dir/elsewhere/plain.off"
expect 0 env GIMG_CORPUS_DIR=third corpus/fetch plain
cmp package/models/plain.off third/plain.off
expect 1 corpus/fetch unknown
expect 2 corpus/fetch
expect 2 corpus/fetch --nonsense
expect 0 corpus/fetch --list
same "$(tr '\n' ' ' <out)" "plain packed nested forged absent "
