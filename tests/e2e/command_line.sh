# Both programs: help, version, exit statuses and streams; every complaint on standard error, one line, with its place.
. tests/e2e/lib.sh

version=$(sed -n 's/^#define FF_VERSION "\(.*\)"/\1/p' runtime/footfall.h)
version_and_help_are_answered() {
    for program in "$pack" "$crowd"; do
        name=$(basename "$program")
        run 0 "$program" --version && says out "$name $version" && silent err || return 1
        run 0 "$program" --help && says out "usage: $name COMMAND" && silent err || return 1
        [ -n "$(commands_of "$program")" ] || { echo "$name lists no commands" && return 1; }
    done
}
every_command_has_help_with_aligned_options() {
    for program in "$pack" "$crowd"; do
        for path in $(commands_of "$program"); do
            command=$(echo "$path" | tr / ' ')
            run 0 "$program" $command --help && silent err && says out "usage: $(basename "$program") $command" || return 1
            # The help texts of one command begin in one column.
            columns=$(sed -n '/^options:/,/^$/s/^\(  -.*[^ ]  \)[^ -].*/\1/p' "$work/out" | awk '{ print length($0) }' | sort -u | wc -l)
            [ "$columns" -eq 1 ] || { echo "options of $command are not aligned" && cat "$work/out" && return 1; }
        done
    done
}
usage_errors_leave_with_2_and_name_the_way_on() {
    for program in "$pack" "$crowd"; do
        name=$(basename "$program")
        run 2 "$program" && silent out && says err "usage: $name" || return 1
        run 2 "$program" nonsense && silent out && says err "$name: unknown command 'nonsense'; try '$name --help'" || return 1
        for path in $(commands_of "$program"); do
            command=$(echo "$path" | tr / ' ')
            run 2 "$program" $command --no-such-option && silent out &&
                says err ": unknown option '--no-such-option'" && says err "try '$name $command --help'" || return 1
        done
        run 2 "$program" $command --helq && says err "did you mean '--help'?" || return 1
    done
}
a_near_command_is_suggested() {
    run 2 "$pack" plnats && says err "did you mean 'plants'?"
}

# refuses TEXT FILE: the plants of FILE are refused with status 1, one line on standard error that says TEXT
refuses() {
    run 1 "$pack" plants "$2" --csv && says err "footfall-pack: $2" && says err "$1" || return 1
    [ "$(wc -l <"$work/err")" -eq 1 ] || { echo "more than one line:" && cat "$work/err" && return 1; }
}
what_is_no_clip_is_refused_with_its_name() {
    : >"$work/empty.bvh"
    head -c 5000 "$pack" >"$work/binary.bvh"
    mkfifo "$work/pipe.bvh"
    refuses "cannot open this file: No such file" "$work/missing.bvh" &&
        refuses "" "$work/empty.bvh" && refuses "" "$work/binary.bvh" &&
        refuses "not a regular file" "$work/pipe.bvh"
}
bvh() { # ROW: a small hip and leg with one row of motion
    printf 'HIERARCHY\nROOT Hips\n{\n OFFSET 0 0 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n'
    printf ' End Site\n {\n  OFFSET 0 1 0\n }\n}\nMOTION\nFrames: 3\nFrame Time: 0.01\n0 0 0 0 0 0\n%s\n0 0 0 0 0 0\n' "$1"
}
a_folder_without_clips_is_refused() {
    mkdir -p "$work/bare"
    run 1 "$pack" plants "$work/bare" --csv && says err "footfall-pack: " && says err "no clip"
}
bad_motion_is_refused_at_its_line_and_column() {
    bvh "0 0 0 0 nan 0" >"$work/nan.bvh"
    bvh "0 0 0 0 0" >"$work/short.bvh"
    bvh "0 0 0 0 0 0 0" >"$work/long.bvh"
    bvh "0 0 0 1e999 0 0" >"$work/huge.bvh"
    refuses ":15:9: " "$work/nan.bvh" && refuses ":15:" "$work/short.bvh" && refuses ":15:" "$work/long.bvh" &&
        refuses ":15:7: " "$work/huge.bvh"
}

test_that "version and help are answered" version_and_help_are_answered
test_that "every command has help with aligned options" every_command_has_help_with_aligned_options
test_that "usage errors leave with 2 and name the way on" usage_errors_leave_with_2_and_name_the_way_on
test_that "a near command is suggested" a_near_command_is_suggested
test_that "what is no clip is refused with its name" what_is_no_clip_is_refused_with_its_name
test_that "a folder without clips is refused" a_folder_without_clips_is_refused
test_that "bad motion is refused at its line and column" bad_motion_is_refused_at_its_line_and_column
finish
