# A run that is saved and gone on with ends as one that was never stopped; what does not belong together is refused.
. tests/e2e/lib.sh
builtin=$FF_BUILD/builtin.ffpack

# hash_of FOLDER: the state at the end of its run
hash_of() {
    sed -n 's/.*"state_hash": "\([0-9a-f]*\)".*/\1/p' "$work/$1/metrics.json"
}

goes_on_as_if_never_stopped() { # SCENE SECONDS SAVE-AT
    file=runtime/scenes/$1.json
    run 0 "$crowd" run "$file" --pack "$builtin" --out "$work/whole" --seconds "$2" --quiet || return 1
    run 0 "$crowd" run "$file" --pack "$builtin" --out "$work/first" --seconds "$2" --quiet \
        --save "$work/$1.crowd" --save-at "$3" || return 1
    run 0 "$crowd" run "$file" --pack "$builtin" --out "$work/rest" --seconds "$2" --quiet \
        --load "$work/$1.crowd" --threads 2 || return 1
    [ -n "$(hash_of whole)" ] && [ "$(hash_of whole)" = "$(hash_of rest)" ] && [ "$(hash_of whole)" = "$(hash_of first)" ] ||
        { echo "$(hash_of whole), $(hash_of first) and $(hash_of rest)" && return 1; }
    # the rest begins where it was saved
    awk -F, -v at="$3" 'NR == 2 { exit !($1 > at - 0.02 && $1 < at + 0.02) }' "$work/rest/crowd.csv" ||
        { sed -n 2p "$work/rest/crowd.csv" && return 1; }
}
the_same_state_gives_the_same_file() {
    run 0 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/a" --seconds 1 --quiet \
        --save "$work/one.crowd" || return 1
    run 0 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/b" --seconds 1 --quiet \
        --save "$work/two.crowd" --threads 2 || return 1
    cmp "$work/one.crowd" "$work/two.crowd"
}
another_scene_or_a_damaged_file_is_refused() {
    run 0 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/a" --seconds 1 --quiet \
        --save "$work/circle.crowd" || return 1
    run 1 "$crowd" run runtime/scenes/two-way.json --pack "$builtin" --out "$work/x" --load "$work/circle.crowd" --quiet &&
        says err "circle.crowd: the crowd was saved from another scene" || return 1
    run 1 "$crowd" run runtime/scenes/circle.json --seed 9 --pack "$builtin" --out "$work/x" --load "$work/circle.crowd" --quiet &&
        says err "another scene" || return 1
    head -c 5000 "$work/circle.crowd" >"$work/cut.crowd"
    run 1 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/x" --load "$work/cut.crowd" --quiet &&
        says err "cut.crowd" && says err "it was cut or grew" || return 1
    run 1 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/x" --load "$builtin" --quiet &&
        says err "this is not a saved crowd"
}
options_that_miss_their_partner_are_a_usage_error() {
    run 2 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/x" --save-at 1 && says err "--save FILE"
}

test_that "a circle goes on as if never stopped" goes_on_as_if_never_stopped circle 4 1.7
test_that "a trade show goes on as if never stopped, with its visitors and booths" goes_on_as_if_never_stopped tradeshow 14 8.5
plain_test_that "a crossing goes on as if never stopped, with its light" goes_on_as_if_never_stopped crossing 12 6.5
test_that "the same state gives the same file on any threads" the_same_state_gives_the_same_file
test_that "another scene or a damaged file is refused" another_scene_or_a_damaged_file_is_refused
test_that "options that miss their partner are a usage error" options_that_miss_their_partner_are_a_usage_error
finish
