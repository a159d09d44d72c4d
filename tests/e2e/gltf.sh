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
        test_that "$claim: $(basename "$file")" agrees_with_three "$file"
        [ -s "$work/test.log" ] && grep 'compared' "$work/test.log"
    done
fi

finish
