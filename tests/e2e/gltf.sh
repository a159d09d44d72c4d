# glTF clips against three.js: sampled joints of every animation of the outside data agree to 0.1 mm. And a pack is built
# from them. three comes from npm into a temporary folder; without node, npm, a network or the data these are skipped.
. tests/e2e/lib.sh

joints=$FF_BUILD/tests/e2e/joints
data=${FF_SHARED:-}/data/gltf
three=0.160.0

get_three() {
    (cd "$work" && npm install --no-audit --no-fund --ignore-scripts "three@$three") >"$work/npm.log" 2>&1
}

agrees_with_three() { # FILE
    run 0 "$joints" "$1" && cp "$work/out" "$work/table" && node tests/e2e/three_joints.mjs "$work/node_modules" "$1" "$work/table"
}

claim="joints of glTF clips are where three.js has them"
if [ ! -d "$data" ]; then
    skip "$claim" "the outside data is not here"
elif ! command -v node >/dev/null || ! command -v npm >/dev/null; then
    skip "$claim" "node and npm are not here"
elif ! get_three; then
    skip "$claim" "npm cannot get three"
else
    for file in "$data"/*.gl*; do
        plain_test_that "$claim: $(basename "$file")" agrees_with_three "$file"
        [ -s "$work/test.log" ] && grep 'compared' "$work/test.log"
    done
fi

# What the crowd writes is a glTF file as others write them: its people can be read back and worn.
a_pack_with_a_skin_is_drawn_with_it() {
    echo '{"kind": "custom", "seconds": 1.5, "agents": [{"position": [0, 0], "goal": [0, 5]}]}' >"$work/one.json"
    run 0 "$crowd" run "$work/one.json" --pack "$FF_BUILD/builtin.ffpack" --out "$work/plain" --quiet &&
        run 0 "$pack" generate walk-normal idle --out "$work/clips" --quiet &&
        run 0 "$pack" build "$work/clips" --skin "$work/plain/crowd.glb" --no-cache --quiet --out "$work/worn.ffpack" &&
        run 0 "$pack" inspect "$work/worn.ffpack" && says out "character:" &&
        run 0 "$crowd" run "$work/one.json" --pack "$work/worn.ffpack" --out "$work/worn" --quiet &&
        same_size_within "$work/plain/crowd.glb" "$work/worn/crowd.glb"
}
# One body of as many triangles: not the same bytes (normals are new), but nearly as many.
same_size_within() {
    a=$(wc -c <"$1") b=$(wc -c <"$2")
    [ "$b" -gt $((a / 2)) ] && [ "$b" -lt $((a * 2)) ] || { echo "$a bytes became $b"; return 1; }
}
test_that "a pack built with a skin is drawn with it" a_pack_with_a_skin_is_drawn_with_it

a_skin_that_is_none_is_refused() {
    run 1 "$pack" build "$work/clips" --skin README.md --no-cache --quiet --out "$work/none.ffpack" && says err "README.md" &&
        [ ! -e "$work/none.ffpack" ]
}
test_that "a skin that is none is refused and no pack is written" a_skin_that_is_none_is_refused

finish
