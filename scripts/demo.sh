#!/bin/sh
# The whole path on the built-in clips: pack, report, crowds that go by velocity and one that plans its footsteps.
#
#   scripts/demo.sh BUILD OUT      BUILD holds the programs, OUT is filled
set -eu
build=$1 out=$2

mkdir -p "$out"
"$build/footfall-pack" build -o "$out/builtin.ffpack"
"$build/footfall-pack" report "$out/builtin.ffpack" -o "$out/report"
for scene in circle two-way bidirectional four-way footsteps; do
    echo "== $scene"
    "$build/footfall-crowd" run "runtime/scenes/$scene.json" --pack "$out/builtin.ffpack" --out "$out/$scene" --threads "$(nproc)"
done

echo
echo "Made:"
find "$out" -type f ! -path '*.cache/*' | sort | sed 's/^/  /'
echo "Look at $out/circle/film.png, $out/footsteps/film.png and $out/report/index.html first."
