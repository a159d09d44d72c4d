# footfall-pack day after day: only what changed is worked out again, the bytes never depend on it, bad clips and full
# disks and kills leave the old pack whole.
. tests/e2e/lib.sh

"$pack" generate -o "$work/made" --quiet >/dev/null || exit 1
clips=$work/clips
mkdir "$clips"
for name in $(ls "$work/made" | grep '\.bvh$' | grep -E '^(walk-normal|turn-left-90|idle)\.bvh'); do
    cp "$work/made/$name" "$clips"
done
one=$(ls "$clips" | head -1)

build() { # STATUS OPTIONS...: of the clips
    want=$1
    shift
    run "$want" "$pack" build "$clips" --quiet "$@"
}
reused() { # COUNT COMPUTED: of a build with --json
    says out "\"reused\": $1," && says out "\"computed\": $2,"
}
same() { # two files
    cmp "$1" "$2" || { echo "$1 and $2 differ" && return 1; }
}

a_second_build_reuses_everything_and_gives_the_same_bytes() {
    build 0 -o "$work/cold.ffpack" --no-cache && [ ! -e "$work/cold.ffpack.cache" ] || return 1
    build 0 -o "$work/x.ffpack" --json && reused 0 $((2 * $(ls "$clips" | wc -l))) && same "$work/cold.ffpack" "$work/x.ffpack" || return 1
    rm "$work/x.ffpack"
    build 0 -o "$work/x.ffpack" --json && reused $((2 * $(ls "$clips" | wc -l))) 0 && same "$work/cold.ffpack" "$work/x.ffpack"
}
threads_change_nothing() {
    for threads in 1 3; do
        build 0 -o "$work/t.ffpack" --no-cache --threads $threads && same "$work/cold.ffpack" "$work/t.ffpack" || return 1
        build 0 -o "$work/t.ffpack" --cache "$work/x.ffpack.cache" --threads $threads && same "$work/cold.ffpack" "$work/t.ffpack" || return 1
    done
}
a_changed_clip_alone_is_worked_out_again() {
    count=$(ls "$clips" | wc -l)
    cp "$clips/$one" "$work/kept.bvh"
    # One byte of the last frame: another clip on the same skeleton.
    sed '$s/[0-9]\([^0-9]*\)$/1\1/' "$work/kept.bvh" >"$clips/$one"
    cmp -s "$work/kept.bvh" "$clips/$one" && sed '$s/[0-9]\([^0-9]*\)$/2\1/' "$work/kept.bvh" >"$clips/$one"
    build 0 -o "$work/x.ffpack" --json && reused $((2 * count - 2)) 2 || return 1
    build 0 -o "$work/cold2.ffpack" --no-cache && same "$work/cold2.ffpack" "$work/x.ffpack" || return 1
    cmp -s "$work/cold.ffpack" "$work/x.ffpack" && echo "another clip gave the same pack" && return 1
    [ "$(ls "$work/x.ffpack.cache" | wc -l)" -eq $((2 * count)) ] || { echo "old entries stay" && return 1; }
    cp "$work/kept.bvh" "$clips/$one"
    build 0 -o "$work/x.ffpack" && same "$work/cold.ffpack" "$work/x.ffpack"
}
a_clip_that_is_only_touched_is_not() {
    touch "$clips"/*
    build 0 -o "$work/x.ffpack" --json && says out '"computed": 0,'
}
a_damaged_cache_is_not_believed() {
    for entry in "$work/x.ffpack.cache"/*; do
        printf 'x' | dd of="$entry" bs=1 seek=200 conv=notrunc 2>/dev/null
    done
    build 0 -o "$work/x.ffpack" --json && says out '"reused": 0,' && same "$work/cold.ffpack" "$work/x.ffpack" || return 1
    for entry in "$work/x.ffpack.cache"/*; do
        : >"$entry"
    done
    build 0 -o "$work/x.ffpack" && same "$work/cold.ffpack" "$work/x.ffpack"
}
a_cache_that_cannot_be_written_is_told_and_no_more() {
    build 0 -o "$work/y.ffpack" --cache /dev/null/cache && says err "/dev/null/cache could not be written to" &&
        same "$work/cold.ffpack" "$work/y.ffpack"
}
settings_that_come_late_keep_the_cache() {
    build 0 -o "$work/x.ffpack" --rate 30 --json && says out '"computed": 0,' || return 1
    build 0 -o "$work/cold30.ffpack" --rate 30 --no-cache && same "$work/x.ffpack" "$work/cold30.ffpack"
}

the_reference_is_a_configuration_that_changes_nothing() {
    run 0 "$pack" config && silent err && cp "$work/out" "$work/reference.json" || return 1
    build 0 -o "$work/z.ffpack" --no-cache --config "$work/reference.json" && same "$work/cold.ffpack" "$work/z.ffpack" || return 1
    # Every setting stands in the reference with a comment, and in the provenance of a pack.
    "$pack" inspect --json "$work/z.ffpack" >"$work/provenance.json" || return 1
    for key in $(sed -n 's/^    "\([a-z_0-9]*\)": .*/\1/p' "$work/reference.json"); do
        grep -q "^    \"// $key\": \".* to .*: \|^    \"// $key\": \"true or false: \|^    \"// $key\": \"a file, " "$work/reference.json" || { echo "$key has no comment" && return 1; }
        grep -q "\"$key\": " "$work/provenance.json" || { echo "$key is not in the provenance" && return 1; }
    done
}
the_printed_reference_is_the_one_in_the_house() {
    same "$work/reference.json" preprocess/reference.json
}
a_configuration_counts_and_options_count_more() {
    echo '{"poses": {"rate": 30}}' >"$work/mine.json"
    build 0 -o "$work/z.ffpack" --config "$work/mine.json" && same "$work/cold30.ffpack" "$work/z.ffpack" || return 1
    build 0 -o "$work/z.ffpack" --config "$work/mine.json" --rate 60 && same "$work/cold.ffpack" "$work/z.ffpack"
}
a_wrong_configuration_is_refused_at_its_place() {
    printf '{\n  "poses": {"rte": 30}\n}\n' >"$work/bad.json"
    build 1 -o "$work/never.ffpack" --config "$work/bad.json" && says err "$work/bad.json:2:13: unknown key 'rte'; did you mean 'rate'?" &&
        [ ! -e "$work/never.ffpack" ]
}

bad_clips_are_listed_at_the_end_and_the_status_says_so() {
    mkdir "$work/mixed" && cp "$clips"/* "$work/mixed" && echo HIERARCHY >"$work/mixed/broken.bvh" && : >"$work/mixed/empty.bvh" || return 1
    mkfifo "$work/mixed/pipe.bvh"
    ln -s nowhere "$work/mixed/dangling.bvh"
    run 1 "$pack" build "$work/mixed" -o "$work/mixed.ffpack" --quiet && [ "$(wc -l <"$work/err")" -eq 4 ] || { cat "$work/err" && return 1; }
    for name in broken empty pipe dangling; do
        grep -q "^footfall-pack: left out: $work/mixed/$name.bvh" "$work/err" || { echo "$name is not named" && cat "$work/err" && return 1; }
    done
    run 0 "$pack" inspect "$work/mixed.ffpack" && says out "4 clips were left out" || return 1
    # the same from the cache
    run 1 "$pack" build "$work/mixed" -o "$work/mixed.ffpack" --quiet && [ "$(wc -l <"$work/err")" -eq 4 ]
}
a_strict_build_stops_at_the_first_and_writes_nothing() {
    cp "$work/cold.ffpack" "$work/strict.ffpack"
    for threads in 1 2; do
        run 1 "$pack" build "$work/mixed" -o "$work/strict.ffpack" --strict --quiet --threads $threads || return 1
        [ "$(wc -l <"$work/err")" -eq 1 ] && says err "footfall-pack: $work/mixed/broken.bvh:" && same "$work/cold.ffpack" "$work/strict.ffpack" || return 1
    done
}

a_full_disk_leaves_the_old_pack_whole() {
    mkdir "$work/full" && cp "$work/cold.ffpack" "$work/full/x.ffpack" || return 1
    for blocks in 0 1 16 100; do
        (
            ulimit -f $blocks
            exec "$pack" build "$clips" -o "$work/full/x.ffpack" --rate 30 --quiet
        ) 2>&1 | cat >"$work/full.log"
        [ -s "$work/full.log" ] || { echo "nothing was said" && return 1; }
        grep -q "cannot write this file" "$work/full.log" || { cat "$work/full.log" && return 1; }
        same "$work/cold.ffpack" "$work/full/x.ffpack" || return 1
        [ "$(ls "$work/full" | wc -l)" -eq 2 ] || { ls "$work/full" && return 1; }
    done
}
a_killed_build_leaves_the_old_pack_or_the_new_one_whole() {
    mkdir "$work/killed" && cp "$work/cold30.ffpack" "$work/killed/x.ffpack" || return 1
    killed=0 round=0
    while [ $round -lt 24 ]; do
        rm -rf "$work/killed/x.ffpack.cache"
        "$pack" build "$clips" -o "$work/killed/x.ffpack" --quiet >/dev/null 2>&1 &
        child=$!
        sleep "0.$(printf %03d $((round * 12 + 1)))"
        kill -9 $child 2>/dev/null && killed=$((killed + 1))
        wait $child 2>/dev/null
        cmp -s "$work/killed/x.ffpack" "$work/cold30.ffpack" || cmp -s "$work/killed/x.ffpack" "$work/cold.ffpack" ||
            { echo "neither the old nor the new pack after kill $round" && return 1; }
        round=$((round + 1))
    done
    echo "$killed of $round builds were killed"
    [ $killed -gt 0 ] || return 1
    # What killed builds left in the cache does no harm and goes.
    build 0 -o "$work/killed/x.ffpack" && same "$work/cold.ffpack" "$work/killed/x.ffpack" || return 1
    ! ls "$work/killed/x.ffpack.cache" | grep -E '\..*\.'
}

import_writes_clips_that_give_the_same_plants() {
    run 0 "$pack" import "$clips" -o "$work/imported" --quiet && says out "$(basename "$one" .bvh)" && silent err || return 1
    [ "$(ls "$work/imported" | wc -l)" -eq "$(ls "$clips" | wc -l)" ] || return 1
    run 0 "$pack" plants "$clips/$one" --csv && cp "$work/out" "$work/plants.csv"
    run 0 "$pack" plants "$work/imported/$one" --csv && same "$work/plants.csv" "$work/out"
}
import_only_looks_without_a_folder_and_names_what_it_cannot_read() {
    run 1 "$pack" import "$work/mixed" --json --quiet && says out '"leg": 0.8' && says out '"missing": []' &&
        says err "footfall-pack: $work/mixed/broken.bvh" && [ "$(wc -l <"$work/err")" -eq 4 ]
}

two_packs_are_told_apart_in_words() {
    run 0 "$pack" diff "$work/cold.ffpack" "$work/cold.ffpack" --exit-code && says out "the same, byte for byte" || return 1
    run 1 "$pack" diff "$work/cold.ffpack" "$work/cold30.ffpack" --exit-code && says out "poses.rate: 30.0, was 60.0" || return 1
    run 0 "$pack" diff "$work/cold.ffpack" "$work/cold2.ffpack" && says out "changed $(basename "$one" .bvh): another file" &&
        ! grep -q "added\|removed" "$work/out"
}
what_a_pack_holds_comes_back_as_files() {
    run 0 "$pack" extract "$work/cold.ffpack" 0 -o "$work/action.bvh" && says out "action 0 (" &&
        run 0 "$pack" plants "$work/action.bvh" --csv || return 1
    run 0 "$pack" extract "$work/cold.ffpack" walk-normal -o "$work/clip.bvh" && run 0 "$pack" plants "$work/clip.bvh" --csv &&
        [ "$(wc -l <"$work/out")" -gt 8 ] || return 1
    run 0 "$pack" extract "$work/cold.ffpack" example:1 --cycles 4 -o "$work/example.glb" && [ "$(head -c 4 "$work/example.glb")" = glTF ] &&
        run 0 "$pack" import "$work/example.glb" -q && says out "26/26" || return 1
    run 1 "$pack" extract "$work/cold.ffpack" walk-norml -o "$work/no.bvh" && says err "no example and no clip is called 'walk-norml'" || return 1
    run 1 "$pack" extract "$work/cold.ffpack" 99999 -o "$work/no.bvh" && says err "there is no 99999" || return 1
    run 2 "$pack" extract "$work/cold.ffpack" 0 -o "$work/no.fbx" && says err ".bvh nor .glb" && [ ! -e "$work/no.bvh" ]
}
a_pack_is_sound_and_a_changed_clip_is_seen() {
    run 0 "$pack" validate "$work/cold.ffpack" "$clips" --quiet && says out "the pack is sound" && silent err || return 1
    cp "$clips/$one" "$work/kept.bvh" && echo >>"$clips/$one"
    run 1 "$pack" validate "$work/cold.ffpack" "$clips" --quiet && says out "$one): the file has other bytes" &&
        says out "the pack is NOT as it should be" || return 1
    rm "$clips/$one"
    run 1 "$pack" validate "$work/cold.ffpack" "$clips" --quiet && says out "$one): not among the clips given" || return 1
    cp "$work/kept.bvh" "$clips/$one"
    run 0 "$pack" validate "$work/cold.ffpack" --quiet && says out "the pack is sound"
}

test_that "a second build reuses everything and gives the same bytes" a_second_build_reuses_everything_and_gives_the_same_bytes
plain_test_that "threads change nothing" threads_change_nothing
test_that "a changed clip alone is worked out again" a_changed_clip_alone_is_worked_out_again
test_that "a clip that is only touched is not" a_clip_that_is_only_touched_is_not
test_that "a damaged cache is not believed" a_damaged_cache_is_not_believed
test_that "a cache that cannot be written is told, and no more" a_cache_that_cannot_be_written_is_told_and_no_more
test_that "settings that come late keep the cache" settings_that_come_late_keep_the_cache
test_that "the reference is a configuration that changes nothing" the_reference_is_a_configuration_that_changes_nothing
test_that "the printed reference is the one in the house" the_printed_reference_is_the_one_in_the_house
plain_test_that "a configuration counts, and options count more" a_configuration_counts_and_options_count_more
test_that "a wrong configuration is refused at its place" a_wrong_configuration_is_refused_at_its_place
test_that "bad clips are listed at the end and the status says so" bad_clips_are_listed_at_the_end_and_the_status_says_so
test_that "a strict build stops at the first and writes nothing" a_strict_build_stops_at_the_first_and_writes_nothing
test_that "a full disk leaves the old pack whole" a_full_disk_leaves_the_old_pack_whole
plain_test_that "a killed build leaves the old pack or the new one whole" a_killed_build_leaves_the_old_pack_or_the_new_one_whole
test_that "import writes clips that give the same plants" import_writes_clips_that_give_the_same_plants
test_that "import only looks without a folder, and names what it cannot read" import_only_looks_without_a_folder_and_names_what_it_cannot_read
test_that "two packs are told apart in words" two_packs_are_told_apart_in_words
test_that "what a pack holds comes back as files" what_a_pack_holds_comes_back_as_files
test_that "a pack is sound, and a changed clip is seen" a_pack_is_sound_and_a_changed_clip_is_seen
finish
