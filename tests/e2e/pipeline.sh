# The whole path: built-in clips to a pack, the pack to crowds; the same bytes and the same bits every time.
# $FF_BUILD/builtin.ffpack was built by make from the built-in clips.
. tests/e2e/lib.sh
builtin=$FF_BUILD/builtin.ffpack

# run_scene OUT OPTIONS...: a short circle
run_scene() {
    out=$1
    shift
    run 0 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/$out" --agents 8 --quiet "$@"
}
hash_of() { # OUT
    sed -n 's/.*"state_hash": *"*\([0-9a-fx]*\).*/\1/p' "$work/$1/metrics.json"
}

the_same_clips_give_the_same_bytes() {
    run 0 "$pack" build -o "$work/again.ffpack" --threads 1 --quiet && cmp "$work/again.ffpack" "$builtin"
}
a_pack_tells_what_is_in_it() {
    run 0 "$pack" inspect "$builtin" && [ -s "$work/out" ] && silent err &&
        run 0 "$pack" inspect "$builtin" --json && says out '{' && silent err
}
a_report_is_one_page_that_needs_nothing_else() {
    run 0 "$pack" report "$builtin" -o "$work/report" && [ -s "$work/report/index.html" ] || return 1
    ! grep -nE '(src|href)="?(https?:|//)' "$work/report/index.html"
}
a_run_writes_every_file() {
    run_scene all --seconds 3 || return 1
    for file in crowd.glb crowd.csv agent-0.bvh trajectories.png film.png metrics.json; do
        [ -s "$work/all/$file" ] || { echo "$file is missing or empty" && return 1; }
    done
    for key in agents reached seconds steps collision_rate mean_acceleration overlapping_pairs max_penetration_m \
        foot_skate_cm median p95 max step_us_per_agent total state_hash; do
        grep -q "\"$key\":" "$work/all/metrics.json" || { echo "metrics.json lacks $key" && return 1; }
    done
    [ "$(ls "$work/all" | wc -l)" -eq 6 ] || { echo "besides:" && ls "$work/all" && return 1; }
}
what_a_run_wrote_is_read_back() {
    run 0 "$pack" plants "$work/all/agent-0.bvh" --csv && says out "agent-0,"
}
one_thread_and_two_give_the_same_bits() {
    run_scene one --seconds 5 --threads 1 && run_scene two --seconds 5 --threads 2 || return 1
    [ -n "$(hash_of one)" ] && [ "$(hash_of one)" = "$(hash_of two)" ] || { hash_of one && hash_of two && return 1; }
    cmp "$work/one/crowd.csv" "$work/two/crowd.csv" && cmp "$work/one/agent-0.bvh" "$work/two/agent-0.bvh" &&
        cmp "$work/one/crowd.glb" "$work/two/crowd.glb"
}
three_thousand_steps_are_the_same_on_any_threads() {
    run 0 "$FF_BUILD/tests/e2e/wander" "$builtin" 24 3000 1 && mv "$work/out" "$work/hashes" || return 1
    [ "$(sort -u -k 2 "$work/hashes" | wc -l)" -eq 30 ] || { echo "the crowd stands still" && return 1; }
    for threads in 2 3 0; do
        run 0 "$FF_BUILD/tests/e2e/wander" "$builtin" 24 3000 "$threads" && cmp "$work/hashes" "$work/out" || return 1
    done
}
another_seed_is_another_run() {
    run_scene other --seconds 5 --seed 77 && [ "$(hash_of one)" != "$(hash_of other)" ]
}
quiet_is_quiet_and_json_is_for_machines() {
    run_scene quiet --seconds 1 && silent out && silent err || return 1
    run_scene json --seconds 1 --json && says out '"state_hash"' && says out 'metrics.json' && silent err
}

bad_scenes_are_refused_with_their_line() {
    printf '{\n  "kind": "circle",\n  "agnets": 4\n}\n' >"$work/key.json"
    printf '{\n  "kind": "circle",\n  "agents": -4\n}\n' >"$work/value.json"
    printf '{\n  "kind": "circle",,\n}\n' >"$work/syntax.json"
    for case in "key.json:3:3: unknown key 'agnets'; did you mean 'agents'?" "value.json:3:" "syntax.json:2:"; do
        run 1 "$crowd" run "$work/${case%%:*}" --pack "$builtin" --out "$work/never" --quiet && silent out &&
            says err "footfall-crowd: $work/$case" || return 1
    done
    [ ! -e "$work/never" ] || { echo "an output folder was made all the same" && return 1; }
}
bad_packs_are_refused() {
    head -c 100000 "$builtin" >"$work/short.ffpack"
    : >"$work/empty.ffpack"
    for file in short.ffpack empty.ffpack missing.ffpack; do
        run 1 "$crowd" run runtime/scenes/circle.json --pack "$work/$file" --out "$work/never" --quiet && silent out &&
            says err "footfall-crowd: $work/$file: " || return 1
        run 1 "$pack" inspect "$work/$file" && silent out && says err "footfall-pack: $work/$file: " || return 1
    done
}
missing_options_are_usage_errors() {
    run 2 "$crowd" run runtime/scenes/circle.json --out "$work/never" && says err "--pack" || return 1
    run 2 "$crowd" run runtime/scenes/circle.json --pack "$builtin" && says err "--out" || return 1
    run 2 "$pack" build && says err "-o"
}
a_bad_clip_is_named_and_left_out_or_stops_a_strict_build() {
    mkdir -p "$work/clips" && cp "$work/one/agent-0.bvh" "$work/clips/good.bvh" && echo "HIERARCHY" >"$work/clips/bad.bvh"
    echo old >"$work/kept.ffpack"
    run 1 "$pack" build "$work/clips" -o "$work/kept.ffpack" --strict --quiet && says err "$work/clips/bad.bvh:" || return 1
    [ "$(cat "$work/kept.ffpack")" = old ] || { echo "a failed build changed the old pack" && return 1; }
    "$pack" build "$work/clips" -o "$work/kept.ffpack" --quiet >"$work/out" 2>"$work/err"
    says err "left out: $work/clips/bad.bvh:" || return 1
    # Nothing left: each bad clip is named once, and an only one needs no word more than what is wrong with it.
    cp "$work/clips/bad.bvh" "$work/worse.bvh"
    run 1 "$pack" build "$work/clips/bad.bvh" "$work/worse.bvh" -o "$work/kept.ffpack" --quiet && says err "none of the 2 clips" || return 1
    [ "$(grep -c "left out: " "$work/err")" = 2 ] || { echo "not each bad clip is named once" && return 1; }
    run 1 "$pack" build "$work/worse.bvh" -o "$work/kept.ffpack" --quiet && says err "$work/worse.bvh:" || return 1
    [ "$(wc -l <"$work/err")" = 1 ] || { echo "one bad clip is complained of in more than one line" && cat "$work/err" && return 1; }
}
a_place_that_cannot_be_written_is_an_error() {
    run 1 "$pack" build "$work/clips/good.bvh" -o "$work/no/such/folder/x.ffpack" --quiet && says err "x.ffpack"
}
damaged_packs_are_refused_or_harmless() {
    run 0 "$FF_BUILD/tests/e2e/damage" "$builtin" 2000 && cat "$work/out"
}

plain_test_that "the same clips give the same bytes" the_same_clips_give_the_same_bytes
test_that "a pack tells what is in it" a_pack_tells_what_is_in_it
test_that "a report is one page that needs nothing else" a_report_is_one_page_that_needs_nothing_else
test_that "a run writes every file" a_run_writes_every_file
test_that "what a run wrote is read back" what_a_run_wrote_is_read_back
test_that "one thread and two give the same bits" one_thread_and_two_give_the_same_bits
test_that "3,000 steps are the same on any threads" three_thousand_steps_are_the_same_on_any_threads
plain_test_that "another seed is another run" another_seed_is_another_run
test_that "quiet is quiet and JSON is for machines" quiet_is_quiet_and_json_is_for_machines
test_that "bad scenes are refused with their line" bad_scenes_are_refused_with_their_line
test_that "bad packs are refused" bad_packs_are_refused
test_that "missing options are usage errors" missing_options_are_usage_errors
test_that "a bad clip is named and left out, or stops a strict build" a_bad_clip_is_named_and_left_out_or_stops_a_strict_build
test_that "a place that cannot be written is an error" a_place_that_cannot_be_written_is_an_error
test_that "2,000 damaged packs are refused or harmless" damaged_packs_are_refused_or_harmless
finish
