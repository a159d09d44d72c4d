#!/bin/sh
# Fill a manual page: @VERSION@, and @COMMANDS@ with what every command of the program says of itself under --help.
#
#   scripts/manual.sh PROGRAM PAGE.1 VERSION
set -eu
program=$1 page=$2 version=$3

commands() { # WORDS...: of the program or of a group of commands
    "$program" "$@" --help | sed -n '/^commands:/,/^$/s/^  \([a-z0-9-]*\) .*/\1/p'
}

describe() { # WORDS...: one command
    "$program" "$@" --help | awk -v words="$*" '
        function plain(text) { # what roff would take for a sign of its own
            gsub(/\\/, "\\e", text)
            gsub(/-/, "\\-", text)
            sub(/^[.'\'']/, "\\\\\\&&", text)
            return text
        }
        NR == 1 { print ".SS " plain(words); sub(/^.* - /, ""); print plain($0) "."; next }
        /^usage: / { print ".PP"; print ".B " plain(substr($0, 8)); next }
        /^options:/ { options = 1; next }
        options && /^$/ { options = 0; print ".PP"; next }
        options && match($0, /[^ ]  +[^ ]/) {
            print ".TP"; print ".B " plain(substr($0, 3, RSTART - 2)); print plain(substr($0, RSTART + RLENGTH - 1)); next
        }
        /^$/ { next }
        { print plain($0); print ".br" }'
}

sed "s|@VERSION@|$version|g" "$page" | while IFS= read -r line; do
    if [ "$line" != @COMMANDS@ ]; then
        printf '%s\n' "$line"
        continue
    fi
    for command in $(commands); do
        inner=$(commands "$command")
        [ -n "$inner" ] || describe "$command"
        for name in $inner; do describe "$command" "$name"; done
    done
done
