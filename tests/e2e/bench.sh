# The benches of footfall-crowd, as small as they get: tables, files, and what is refused.
. tests/e2e/lib.sh
builtin=$FF_BUILD/builtin.ffpack

has() { # FILE WORD...
    file=$1
    shift
    for word in "$@"; do
        grep -q -- "$word" "$file" || { echo "$file lacks '$word'" && return 1; }
    done
}

fig7_writes_table_files_and_pictures() {
    run 0 "$crowd" bench fig7 --pack "$builtin" --agents 4 --seeds 1 --step 0.1 --mcn --quiet --out "$work/fig7" \
        --json "$work/fig7.json" && silent err || return 1
    has "$work/out" "MCN" "4/4" && has "$work/fig7.json" unhindered_s last_worst_s body_deepest_m update_ms &&
        cmp "$work/fig7.json" "$work/fig7/fig7.json" && [ "$(wc -l <"$work/fig7/fig7.csv")" -eq 2 ] &&
        [ -s "$work/fig7/fig7-4-mcn.png" ]
}
table1_compares_the_methods() {
    run 0 "$crowd" bench table1 --pack "$builtin" --scene x2 --seeds 1 --quiet --out "$work/table1" \
        --json "$work/table1.json" && silent err || return 1
    # Two steps, five methods, and the paper's figures.
    [ "$(grep -c '^x2' "$work/out")" -eq 10 ] && has "$work/out" 0.0566 0.1440 "ORCA aided" &&
        [ "$(wc -l <"$work/table1/table1.csv")" -eq 11 ] && [ -s "$work/table1/table1.png" ] &&
        has "$work/table1.json" '"name": "x2"' '"mcn"' '"orca"' '"sf"' A_route A_raw deepest_m '"arrived": 30' last_s
}
fig6_shares_out_what_whole_people_cost() {
    run 0 "$crowd" bench fig6 --pack "$builtin" --agents 50 --quiet --out "$work/fig6" --json "$work/fig6.json" &&
        silent err || return 1
    has "$work/out" MCN ORCA SF "at 30 updates" && cmp "$work/fig6.json" "$work/fig6/fig6.json" &&
        [ "$(wc -l <"$work/fig6/fig6.csv")" -ge 4 ] && [ -s "$work/fig6/fig6.png" ] &&
        has "$work/fig6.json" '"agents": 50' us_per_agent us_navigation us_synthesis us_coupling '"orca"' '"sf"'
}
synthesis_measures_poses_with_simd_and_without() {
    run 0 "$crowd" bench synthesis --pack "$builtin" --characters 20 --repeats 2 --quiet --out "$work/synthesis" \
        --json "$work/synthesis.json" && silent err || return 1
    has "$work/out" "plain C" SIMD && cmp "$work/synthesis.json" "$work/synthesis/synthesis.json" &&
        [ "$(wc -l <"$work/synthesis/synthesis.csv")" -eq 5 ] && [ -s "$work/synthesis/synthesis.png" ] &&
        has "$work/synthesis.json" '"characters": 20' '"simd": true' '"simd": false' us_blend us_ik '"joints": 31'
}
walks_keep_their_bars() {
    # Runs too, but for their knees.
    run 0 "$crowd" bench walk --pack "$builtin" --seconds 20 --check --json "$work/walk.json" && silent err || return 1
    [ "$(grep -c '"broken"' "$work/walk.json")" -ge 30 ] && has "$work/out" "hasty commands" crowd "run 3.0" &&
        has "$work/walk.json" '"synthesis": "blending"' skate_median_m knee_deg_per_s2 joint_ratio clear_m ankles_m
}
every_example_is_walked_and_filmed() {
    run 0 "$crowd" bench walk --pack "$builtin" --examples --course walk-slow --seconds 6 --out "$work/films" || return 1
    [ "$(ls "$work/films")" = walk-slow-12.png ] && has "$work/out" "walk-slow@12" &&
        run 0 "$crowd" bench walk --pack "$builtin" --course "tight curve" --seconds 6 --synthesis hybrid &&
        run 1 "$crowd" bench walk --pack "$builtin" --course nothing && says err "nothing" &&
        run 2 "$crowd" bench walk && run 2 "$crowd" bench walk --pack "$builtin" --synthesis hybird && says err hybird
}
straight_walks_are_people_s() {
    run 0 "$crowd" bench facts --pack "$builtin" --json "$work/facts.json" && silent err || return 1
    ! grep -q '"holds": false' "$work/facts.json" && has "$work/out" cadence "knee most in swing" &&
        run 2 "$crowd" bench facts && says err "--pack"
}
hybrid_walks_an_obstacle_course_in_three_ways() {
    run 0 "$crowd" bench hybrid --pack "$builtin" --agents 3 --seeds 1 --step 0.1 --quiet --out "$work/hybrid" \
        --json "$work/hybrid.json" && silent err || return 1
    has "$work/out" "blending" "semi-procedural" "hybrid" "3/3" && cmp "$work/hybrid.json" "$work/hybrid/hybrid.json" &&
        [ "$(wc -l <"$work/hybrid/hybrid.csv")" -eq 4 ] && [ -s "$work/hybrid/hybrid.png" ] &&
        [ -s "$work/hybrid/hybrid-hybrid.png" ] && [ -s "$work/hybrid/hybrid-blending-film.png" ] &&
        has "$work/hybrid.json" nn_open_m wall_share changes_per_minute '"arrived": 3'
}
astar_sets_the_search_beside_the_paper_s() {
    run 0 "$crowd" bench astar --pack "$builtin" --problems 2 --quiet --out "$work/astar" --json "$work/astar.json" &&
        silent err || return 1
    has "$work/out" "reach table" "straight line" paper && cmp "$work/astar.json" "$work/astar/astar.json" &&
        [ "$(wc -l <"$work/astar/astar.csv")" -ge 39 ] && [ -s "$work/astar/astar.png" ] &&
        has "$work/astar.json" children_per_s ms_p99 cost_p95 '"formulation": "paper"'
}
mixed_tells_who_meets_whom() {
    run 0 "$crowd" bench mixed --pack "$builtin" --scene circle --mixed --seeds 1 --step 0.1 --quiet --out "$work/mixed" \
        --json "$work/mixed.json" && silent err || return 1
    has "$work/out" "circle" "/40" && cmp "$work/mixed.json" "$work/mixed/mixed.json" &&
        [ "$(wc -l <"$work/mixed/mixed.csv")" -eq 4 ] && [ -s "$work/mixed/mixed.png" ] && [ -s "$work/mixed/mixed-crowd.png" ] &&
        has "$work/mixed.json" deepest_m discs_m speed_velocity '"footsteps": {' &&
        run 2 "$crowd" bench mixed --pack "$builtin" --scene square && says err square
}
mistakes_leave_with_2_and_name_the_way_on() {
    run 2 "$crowd" bench && run 2 "$crowd" bench fig77 && says err "fig7" &&
        run 2 "$crowd" bench table1 && says err "--pack" && run 2 "$crowd" bench fig7 && says err "--pack" &&
        run 2 "$crowd" bench table1 --pack "$builtin" --scene x3 && says err "x3" &&
        run 1 "$crowd" bench fig7 --pack /dev/null --quiet
}

test_that "fig7 writes its table, files and pictures" fig7_writes_table_files_and_pictures
test_that "table1 compares the methods" table1_compares_the_methods
test_that "fig6 shares out what whole people cost" fig6_shares_out_what_whole_people_cost
test_that "synthesis measures poses with SIMD and without" synthesis_measures_poses_with_simd_and_without
test_that "walks keep their bars" walks_keep_their_bars
test_that "every example is walked and filmed" every_example_is_walked_and_filmed
test_that "straight walks are people's" straight_walks_are_people_s
test_that "hybrid walks an obstacle course in three ways" hybrid_walks_an_obstacle_course_in_three_ways
test_that "astar sets the search beside the paper's" astar_sets_the_search_beside_the_paper_s
test_that "mixed tells who meets whom" mixed_tells_who_meets_whom
test_that "mistakes leave with 2 and name the way on" mistakes_leave_with_2_and_name_the_way_on
finish
