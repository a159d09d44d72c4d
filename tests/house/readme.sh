# Every command of the READMEs' `sh` blocks works as it stands there. A block whose opening line goes on with
# `not-tested:` and a reason (it needs the internet, takes long, or calls the tests again) is only read: the make
# targets and scripts it names must exist.
. tests/e2e/lib.sh

# Commands run in a copy made of links, so what they write (out/...) does not land in the tree; build is the build
# folder under test.
top=$(pwd)
built=$(cd "$FF_BUILD" && pwd)
tree=$work/tree
mkdir "$tree"
for entry in * .ci; do
    case $entry in build | out) ;; *) ln -s "$top/$entry" "$tree/$entry" ;; esac
done
ln -s "$built" "$tree/build"
mkdir "$tree/out"

# blocks FILE run|read: the lines of its blocks of that kind
blocks() {
    awk -v kind="$2" '
        /^```/ && inside { inside = 0; next }
        /^```sh( |$)/ { inside = 1; wanted = (($0 ~ /not-tested:/) == (kind == "read")); next }
        /^```/ { inside = 1; wanted = 0; next }
        inside && wanted' "$1"
}

commands_work() { # FILE
    blocks "$1" run >"$work/commands.sh"
    (cd "$tree" && FF_BUILD=$built sh -eux "$work/commands.sh")
}
commands_exist() { # FILE
    result=0
    for target in $(blocks "$1" read | sed -n 's/.*\bmake \([a-z0-9-]*\)\([^a-z0-9=-].*\)*$/\1/p'); do
        grep -qE "^$target:" Makefile || { echo "no make target $target" && result=1; }
    done
    for script in $(blocks "$1" read | grep -oE '(scripts/[a-z-]+\.sh|\.ci/run)'); do
        [ -x "$script" ] || { echo "no script $script" && result=1; }
    done
    return "$result"
}
links_lead_somewhere() { # FILE
    result=0
    for link in $(grep -oE '\]\([^)#: ]+\)' "$1" | tr -d '](){}'); do
        [ -e "$(dirname "$1")/$link" ] || { echo "$1 links to $link, which is not there" && result=1; }
    done
    return "$result"
}
the_short_program_is_the_example() {
    awk '/^```/ && inside { exit } inside { print } /^```c$/ { inside = 1 }' README.md >"$work/program.c"
    diff "$work/program.c" runtime/examples/walk.c
}

for readme in README.md mocap/README.md preprocess/README.md runtime/README.md runtime/export/README.md runtime/scenes/README.md tests/README.md scripts/README.md; do
    test_that "the commands of $readme work" commands_work "$readme"
    test_that "the other commands of $readme exist" commands_exist "$readme"
    test_that "the links of $readme lead somewhere" links_lead_somewhere "$readme"
done
test_that "the short program of README.md is runtime/examples/walk.c" the_short_program_is_the_example
finish
