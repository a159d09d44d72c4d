# The rules of the house (README.md of each room), checked over every source file.
. tests/e2e/lib.sh

rooms="mocap preprocess runtime tests"
sources() { # FOLDER...: its C and C++ files
    find "$@" -name '*.[ch]' -o -name '*.cpp' | sort
}

# includes FOLDER: "file:line:name" of what its files include, < > and " " alike
includes() {
    sources "$1" | xargs grep -nE '^ *# *include' /dev/null | sed -E 's/^([^:]*:[0-9]*): *# *include *([<"][^>"]*[>"]).*/\1:\2/'
}

# only FOLDER PATTERN: no include of the folder's files may fall outside the pattern
only() {
    includes "$1" | grep -vE ":($2)" >"$work/strays" || return 0
    echo "$1 may include only $2, but:"
    cat "$work/strays"
    return 1
}

# none PATTERN FILES: no line of the files matches
none() {
    pattern=$1
    shift
    grep -nE -- "$pattern" /dev/null "$@" >"$work/found" || return 0
    cat "$work/found"
    return 1
}

# code FILES: "file:line:text" without comments, strings and empty lines
code() {
    awk 'FNR == 1 { comment = 0 }
        {
            line = $0
            gsub(/"([^"\\]|\\.)*"/, "\"\"", line)
            if (comment) { if (sub(/^.*\*\//, "", line)) comment = 0; else next }
            gsub(/\/\*([^*]|\*+[^*\/])*\*+\//, "", line)
            sub(/\/\/.*$/, "", line)
            if (sub(/\/\*.*$/, "", line)) comment = 1
            if (line ~ /[^ ]/) print FILENAME ":" FNR ":" line
        }' "$@"
}

# no_code PATTERN FILES: the same as none, but comments and strings may say it
no_code() {
    pattern=$1
    shift
    code "$@" | grep -E -- "^[^:]*:[0-9]*:.*$pattern" >"$work/found" || return 0
    cat "$work/found"
    return 1
}

# floors ROOT FOLDER...: lowest first; a folder includes of ROOT only its own files and those of folders below it, and
# every folder of ROOT is named
floors() {
    root=$1 below=
    shift
    for folder in "$root"/*/; do
        case " $* " in *" $(basename "$folder") "*) ;; *) echo "$folder has no floor" && return 1 ;; esac
    done
    for folder in "$@"; do
        below="$below${below:+|}$folder"
        includes "$root/$folder" | grep ":\"$root/" | grep -vE ":\"$root/($below)/" >"$work/strays" || continue
        echo "$root/$folder may include only $below of $root, but:"
        cat "$work/strays"
        return 1
    done
}

std='<(assert|ctype|errno|float|inttypes|limits|math|setjmp|stdarg|stdatomic|stdbool|stddef|stdint|stdio|stdlib|string|time)\.h>'
posix='<(dirent|fcntl|pthread|sched|strings|unistd|sys/[a-z]+)\.h>'
simd='<(emmintrin|immintrin)\.h>'

core_includes_nothing_outside_itself() {
    only runtime/core "$std|$posix|$simd|<xxhash\.h>|\"runtime/core/|\"runtime/footfall\.h\""
}
core_s_folders_stand_on_each_other() {
    floors runtime/core base pack pose nav gait play plan behave crowd
}
preprocess_s_folders_stand_on_each_other() {
    floors preprocess base plants motion pack clean examples actions skin build report commands
}
tool_knows_only_the_base() {
    only runtime/tool "$std|$posix|<jansson\.h>|\"runtime/tool/|\"runtime/core/base/|\"runtime/footfall\.h\""
}
runtime_includes_neither_mocap_nor_preprocess() {
    only runtime '<|"runtime/'
}
mocap_includes_the_base_and_the_tools() {
    only mocap '<|"mocap/|"runtime/core/base/|"runtime/tool/|"runtime/footfall\.h"'
}
preprocess_includes_mocap_and_runtime() {
    only preprocess '<|"preprocess/|"mocap/|"runtime/'
}
the_examples_use_the_public_header_alone() {
    only runtime/examples "$std|\"runtime/footfall\.h\"|<footfall\.h>"
}

only_adapters_include_cpp_libraries() {
    for folder in $rooms; do includes "$folder"; done |
        grep -E '<(opencv2/|tiny_gltf|ceres/|Eigen/|OpenMesh/|recastnavigation/)' | grep -vE '^[^:]*\.cpp:' >"$work/strays" || return 0
    cat "$work/strays"
    return 1
}
every_cpp_file_is_an_adapter_behind_a_c_header() {
    result=0
    for file in $(find $rooms -name '*.cpp'); do
        grep -qE '#include <(opencv2/|tiny_gltf|ceres/|OpenMesh/|recastnavigation/)' "$file" || { echo "$file adapts no library" && result=1; }
        # hull_opencv.cpp may stand behind hull.h
        [ -f "${file%.cpp}.h" ] || [ -f "${file%_*.cpp}.h" ] || { echo "$file has no header" && result=1; }
        grep -q 'catch (' "$file" || { echo "$file catches nothing: exceptions would escape" && result=1; }
    done
    return "$result"
}

nothing_is_left_to_do_later() {
    none '\b(TODO|FIXME|XXX|HACK)\b' $(sources mocap preprocess runtime) Makefile scripts/*.sh
}
no_path_of_one_machine_is_written_down() {
    none '(/work/|/home/|/root/)' $(sources $rooms) Makefile scripts/* README.md mocap/*.md preprocess/*.md runtime/*.md scripts/*.md
}
libraries_never_end_the_process() {
    no_code '[^_[:alnum:]](exit|_exit|abort|quick_exit) *\(' $(sources mocap preprocess runtime | grep -v '/main\.c$')
}
what_feeds_packs_and_crowds_uses_no_libm() {
    # sqrt, fabs, floor, ldexp and their like are exact everywhere; these are not (maths.h).
    no_code '[^_[:alnum:]](sin|cos|tan|asin|acos|atan|atan2|exp|exp2|log|log2|log10|pow|hypot|cbrt|sinh|cosh|tanh|sincos)f? *\(' \
        $(sources runtime/core preprocess)
}
nobody_reads_the_clock_or_a_random_device_into_a_result() {
    no_code '[^_[:alnum:]](rand|srand|random|drand48|time|gettimeofday|clock) *\(' $(sources mocap preprocess runtime)
}

files_stay_short() {
    result=0
    for file in $(sources $rooms | grep -v '_data\.c$'); do # tables of measured numbers are as long as they are
        lines=$(wc -l <"$file")
        [ "$lines" -le 700 ] || { echo "$file has $lines lines" && result=1; }
    done
    return "$result"
}

every_room_has_a_readme() {
    result=0
    for room in mocap preprocess runtime tests scripts; do
        [ -s "$room/README.md" ] || { echo "$room/README.md is missing" && result=1; }
    done
    return "$result"
}

# compiles FILE OPTIONS...: FILE compiles without a warning
compiles() {
    file=$1
    shift
    "$@" -Wall -Wextra -Wpedantic -Werror -I. -fsyntax-only "$file"
}
the_public_header_is_plain_c_and_cpp() {
    echo '#include "runtime/footfall.h"' >"$work/user.c"
    cp "$work/user.c" "$work/user.cpp"
    for c in gcc clang; do
        compiles "$work/user.c" $c -std=c99 && compiles "$work/user.c" $c -std=c17 || return 1
    done
    for c in g++ clang++; do
        compiles "$work/user.cpp" $c -std=c++11 && compiles "$work/user.cpp" $c -std=c++20 || return 1
    done
}
every_header_stands_alone() {
    result=0
    # A file that says "part of NAME.c" in its first line is included there and nowhere else.
    for header in $(find mocap preprocess runtime -name '*.h'); do
        head -1 "$header" | grep -q ' - part of [a-z_0-9]*\.c' && continue
        printf '#include "%s"\n#include "%s"\n' "$header" "$header" >"$work/alone.c"
        compiles "$work/alone.c" gcc -std=c17 || result=1
    done
    return "$result"
}

test_that "core includes nothing outside itself" core_includes_nothing_outside_itself
test_that "tool knows only the base" tool_knows_only_the_base
test_that "the folders of core stand on each other" core_s_folders_stand_on_each_other
test_that "the folders of preprocess stand on each other" preprocess_s_folders_stand_on_each_other
test_that "runtime includes neither mocap nor preprocess" runtime_includes_neither_mocap_nor_preprocess
test_that "mocap includes the base and the tools" mocap_includes_the_base_and_the_tools
test_that "preprocess includes mocap and runtime" preprocess_includes_mocap_and_runtime
test_that "the examples use the public header alone" the_examples_use_the_public_header_alone
test_that "only adapters include C++ libraries" only_adapters_include_cpp_libraries
test_that "every C++ file is an adapter behind a C header" every_cpp_file_is_an_adapter_behind_a_c_header
test_that "nothing is left to do later" nothing_is_left_to_do_later
test_that "no path of one machine is written down" no_path_of_one_machine_is_written_down
test_that "libraries never end the process" libraries_never_end_the_process
test_that "what feeds packs and crowds uses no libm" what_feeds_packs_and_crowds_uses_no_libm
test_that "nobody reads the clock or a random device into a result" nobody_reads_the_clock_or_a_random_device_into_a_result
test_that "files stay short" files_stay_short
test_that "every room has a README" every_room_has_a_readme
test_that "the public header is plain C and C++" the_public_header_is_plain_c_and_cpp
test_that "every header stands alone" every_header_stands_alone
finish
