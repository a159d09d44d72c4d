#!/bin/sh
# Fetch clips of the CMU Graphics Lab Motion Capture Database (needs the internet and curl or wget).
#
#   scripts/get-cmu.sh [-o FOLDER] SUBJECT|TRIAL...
#
#   scripts/get-cmu.sh 2 16            every clip of subjects 02 and 16 into clips/cmu/02 and clips/cmu/16
#   scripts/get-cmu.sh 35_01 35_17     these two clips and the skeleton of subject 35
#
# What is there already is not fetched again. The database asks not to be crawled: name the subjects you want, and for
# all of it take the one archive that its FAQ page links (allasfamc.zip).
set -eu

site=${CMU_SITE:-http://mocap.cs.cmu.edu}
folder=clips/cmu

fail() {
    echo "get-cmu: $1" >&2
    exit "${2:-1}"
}
usage() { sed -n '2,/^set/ s/^#$//; 2,/^set/ s/^# //p' "$0"; }

case ${1:-} in
-h | --help) usage && exit 0 ;;
-o)
    [ $# -ge 2 ] || fail "-o needs a folder" 2
    folder=$2
    shift 2
    ;;
esac
[ $# -gt 0 ] || fail "name a subject or a trial, as in: scripts/get-cmu.sh 2 35_01" 2

if command -v curl >/dev/null; then
    fetch() { curl -fsSL --retry 3 -o "$2" "$1"; }
elif command -v wget >/dev/null; then
    fetch() { wget -q -O "$2" "$1"; }
else
    fail "neither curl nor wget is here"
fi

# get URL FILE: fetch it unless it is there; never leaves half a file
get() {
    [ ! -s "$2" ] || return 0
    mkdir -p "$(dirname "$2")"
    echo "$2" >&2
    fetch "$1" "$2.part" || { rm -f "$2.part" && fail "cannot fetch $1"; }
    # The site answers with a page, not with an error, when it has no such file.
    if head -c 300 "$2.part" | grep -qi '<html\|<!doctype'; then
        rm -f "$2.part"
        fail "there is no $1"
    fi
    mv "$2.part" "$2"
}

# two_digits N: subjects and trials are written with at least two digits
two_digits() { printf '%02d' "$(echo "$1" | sed 's/^0*\(.\)/\1/')"; }

page=$(mktemp)
trap 'rm -f "$page"' EXIT
for wanted in "$@"; do
    echo "$wanted" | grep -qE '^[0-9]{1,3}(_[0-9]{1,3})?$' || fail "'$wanted' is neither a subject (35) nor a trial (35_01)" 2
done
for wanted in "$@"; do
    subject=$(two_digits "${wanted%%_*}")
    case $wanted in
    *_*) trials=${subject}_$(two_digits "${wanted#*_}") ;;
    *)
        fetch "$site/search.php?subjectnumber=${subject#0}" "$page" || fail "cannot fetch the list of subject $subject from $site"
        trials=$(grep -oiE "subjects/$subject/${subject}_[0-9]+\.amc" "$page" | sed 's|.*/||; s|\.[^.]*$||' | sort -u)
        [ -n "$trials" ] || fail "the database lists no clip of subject $subject"
        ;;
    esac
    get "$site/subjects/$subject/$subject.asf" "$folder/$subject/$subject.asf"
    for trial in $trials; do
        get "$site/subjects/$subject/$trial.amc" "$folder/$subject/$trial.amc"
    done
done
echo "Clips are below $folder. Please put this into what you publish with them:" >&2
echo "The data used in this project was obtained from mocap.cs.cmu.edu." >&2
echo "The database was created with funding from NSF EIA-0196217." >&2
