# Every scene that comes with the project, for some seconds on the built-in pack; scenes that people write; the
# Khronos validator where it is installed.
. tests/e2e/lib.sh
builtin=$FF_BUILD/builtin.ffpack
files="crowd.glb crowd.csv agent-0.bvh trajectories.png film.png metrics.json"

# number KEY: of the last run's metrics
number() {
    sed -n "s/.*\"$1\": \([0-9.e-]*\).*/\1/p" "$work/$scene/metrics.json" | head -1
}
at_most() { # KEY LIMIT
    awk -v got="$(number "$1")" -v limit="$2" 'BEGIN { exit !(got != "" && got + 0 <= limit) }' && return 0
    echo "$1 is '$(number "$1")', expected at most $2"
    return 1
}

scene_runs() { # NAME AGENTS [WORD]
    scene=$1
    run 0 "$crowd" run "runtime/scenes/$scene.json" --pack "$builtin" --out "$work/$scene" --seconds 2 && silent err || {
        # progress is on standard error where there is no terminal
        grep -v '^walking\|^writing' "$work/err" && return 1
    }
    says out "$2 ${3:-agents}" || return 1
    for file in $files; do
        [ -s "$work/$scene/$file" ] || { echo "$scene/$file is missing or empty" && return 1; }
        says out "$work/$scene/$file" || return 1
    done
    [ "$(head -c 4 "$work/$scene/crowd.glb")" = glTF ] || { echo "crowd.glb is no GLB" && return 1; }
    [ "$(head -1 "$work/$scene/agent-0.bvh")" = HIERARCHY ] || { echo "agent-0.bvh is no BVH" && return 1; }
    [ "$(number agents)" = "$2" ] && [ "$(number steps)" -eq 60 ] || { cat "$work/$scene/metrics.json" && return 1; }
    # 2 s at 10 Hz, both ends, and the header
    [ "$(wc -l <"$work/$scene/crowd.csv")" -eq $((21 * $2 + 1)) ] || { wc -l "$work/$scene/crowd.csv" && return 1; }
    ! grep -qiE 'nan|inf' "$work/$scene/crowd.csv" "$work/$scene/agent-0.bvh" "$work/$scene/metrics.json" &&
        at_most median 0.5 && at_most p95 1.5 && at_most max_penetration_m 0.04
}
a_circle_arrives_and_the_run_ends() {
    scene=circle-done
    run 0 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/$scene" --agents 6 --quiet || return 1
    [ "$(number reached)" = 6 ] && at_most seconds 20
}
people_leave_where_the_scene_says_so() {
    scene=leave
    printf '{"kind": "custom", "at_goal": "leave", "agents": [{"position": [0, 0], "goal": [0, 4]}, {"position": [3, 0], "goal": [3, 9]}]}' >"$work/leave.json"
    run 0 "$crowd" run "$work/leave.json" --pack "$builtin" --out "$work/$scene" --quiet || return 1
    [ "$(number reached)" = 2 ] || { cat "$work/$scene/metrics.json" && return 1; }
    [ "$(grep -c '^[0-9.]*,0,' "$work/$scene/crowd.csv")" -lt "$(grep -c '^[0-9.]*,1,' "$work/$scene/crowd.csv")" ] ||
        { echo "agent 0 stayed" && return 1; }
}
walls_are_walked_round() {
    scene=wall
    printf '{"kind": "custom", "seconds": 40, "agents": [{"position": [0.4, -4], "goal": [0.4, 4]}], "walls": [[-1, 0, 1, 0]]}' >"$work/wall.json"
    run 0 "$crowd" run "$work/wall.json" --pack "$builtin" --out "$work/$scene" --quiet || return 1
    # nobody's root within the wall's reach: |x| < 1 where z is close to 0
    awk -F, 'NR > 1 && $4 < 0.2 && $4 > -0.2 && $3 < 1 && $3 > -1 { print; bad = 1 } END { exit bad }' "$work/$scene/crowd.csv"
}
the_example_of_the_readme_runs() {
    awk '/^```/ && inside { exit } inside { print } /^```json$/ { inside = 1 }' runtime/scenes/README.md >"$work/readme.json"
    run 0 "$crowd" run "$work/readme.json" --pack "$builtin" --out "$work/readme" --seconds 1 --quiet && silent err
}
the_behaviour_of_the_readme_runs() {
    # The block that says all its keys, without comments.
    awk '/^### Behaviour/ { wanted = 1 } /^```$/ && inside { exit } inside { sub(/ *\/\/.*$/, ""); print }
        wanted && /^```jsonc$/ { inside = 1 }' runtime/scenes/README.md | sed '1s/{/{"kind": "custom", "seconds": 1,/' >"$work/behaviour.json"
    run 0 "$crowd" run "$work/behaviour.json" --pack "$builtin" --out "$work/behaviour" --quiet && silent err
}
states_that_lead_round_without_time_end_the_run() {
    printf '{"kind": "circle", "agents": 2, "behaviour": "b", "behaviours": {"b": {"start": "Here", "states": {\n"Here": {"next": [{"when": "always", "to": "There"}]},\n"There": {"next": [{"when": {"timer": 0}, "to": "Here"}]}}}}}' >"$work/round.json"
    run 1 "$crowd" run "$work/round.json" --pack "$builtin" --out "$work/round" --quiet &&
        says err "agent 0 went through more than 8 states at 0.00 s" && says err "without any time passing"
}
a_scene_of_kilometres_is_drawn() {
    printf '{"kind": "custom", "agents": [{"position": [0, 0], "goal": [0, 4000]}, {"position": [9000, 0], "goal": [0, 0]}]}' >"$work/far.json"
    run 0 "$crowd" run "$work/far.json" --pack "$builtin" --out "$work/far" --seconds 1 --quiet && silent err
}
another_number_of_agents_needs_a_scene_that_makes_them() {
    run 1 "$crowd" run "$work/wall.json" --pack "$builtin" --out "$work/never" --agents 5 --quiet && silent out &&
        says err "$work/wall.json: --agents" && [ "$(wc -l <"$work/err")" -eq 1 ] && [ ! -e "$work/never" ]
}
a_crowd_that_does_not_fit_is_refused() {
    printf '{"kind": "circle", "radius": 2, "agents": 60}' >"$work/tight.json"
    run 1 "$crowd" run "$work/tight.json" --pack "$builtin" --out "$work/never" --quiet && silent out &&
        says err "$work/tight.json: agents 0 and 1 would start" && [ ! -e "$work/never" ]
}
an_output_folder_that_cannot_be_made_is_an_error() {
    : >"$work/file"
    run 1 "$crowd" run runtime/scenes/circle.json --pack "$builtin" --out "$work/file/out" --agents 4 --quiet && silent out &&
        says err "$work/file"
}
the_khronos_validator_finds_no_error() {
    scripts/validate-glb.sh --installed "$work"/circle/crowd.glb "$work"/bidirectional/crowd.glb "$work"/leave/crowd.glb
}

a_run_to_which_nobody_comes_says_so() {
    run 1 "$crowd" run runtime/scenes/course.json --pack "$builtin" --out "$work/nobody" --seconds 0.2 --quiet &&
        says err "nobody has come into the scene within 0.2 s" || return 1
    [ -z "$(ls "$work/nobody")" ] || { echo "files were left:" && ls "$work/nobody" && return 1; }
}

test_that "the circle runs" scene_runs circle 17
test_that "the two-way crossflow runs" scene_runs two-way 30
test_that "the bidirectional flow runs" scene_runs bidirectional 53
test_that "the four-way crossflow runs" scene_runs four-way 100
test_that "the crossing runs" scene_runs crossing 32 people
test_that "the behaviour of the README runs" the_behaviour_of_the_readme_runs
test_that "states that lead round without time end the run, with the agent and the state" states_that_lead_round_without_time_end_the_run
test_that "a circle arrives and the run ends" a_circle_arrives_and_the_run_ends
test_that "people leave where the scene says so" people_leave_where_the_scene_says_so
test_that "walls are walked round" walls_are_walked_round
test_that "the example of runtime/scenes/README.md runs" the_example_of_the_readme_runs
test_that "a scene of kilometres is drawn" a_scene_of_kilometres_is_drawn
test_that "another number of agents needs a scene that makes them" another_number_of_agents_needs_a_scene_that_makes_them
test_that "a crowd that does not fit is refused" a_crowd_that_does_not_fit_is_refused
test_that "a run to which nobody comes says so" a_run_to_which_nobody_comes_says_so
test_that "an output folder that cannot be made is an error" an_output_folder_that_cannot_be_made_is_an_error
scripts/validate-glb.sh --installed /dev/null >"$work/validator" 2>&1
if [ $? -eq 3 ]; then
    skip "the Khronos validator finds no error" "$(cat "$work/validator")"
else
    test_that "the Khronos validator finds no error" the_khronos_validator_finds_no_error
fi
finish
