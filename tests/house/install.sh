# The installed tree: what is in it, and that programs can be built on it through pkg-config and through CMake.
. tests/e2e/lib.sh
unset DESTDIR
version=$(sed -n 's/^#define FF_VERSION "\(.*\)"/\1/p' runtime/footfall.h)
tree=$work/stage
prefix=/opt/foot

install_into_the_stage() {
    make install B="$FF_BUILD" DESTDIR="$tree" PREFIX="$prefix" 2>&1
}
holds() { # FILE...: all are in the installed tree and not empty
    for file in "$@"; do
        [ -s "$tree$prefix/$file" ] || { echo "$file is missing or empty" && return 1; }
    done
}
every_part_is_there() {
    holds bin/footfall-pack bin/footfall-crowd include/footfall.h lib/libfootfall.a "lib/libfootfall.so.$version" \
        lib/libfootfall.so lib/pkgconfig/footfall.pc lib/cmake/footfall/footfall-config.cmake \
        share/man/man1/footfall-pack.1 share/man/man1/footfall-crowd.1 &&
        run 0 "$tree$prefix/bin/footfall-pack" --version && says out "footfall-pack $version" &&
        run 0 "$tree$prefix/bin/footfall-crowd" --version && says out "footfall-crowd $version"
}
no_place_holder_and_no_stage_path_is_left() {
    ! grep -rnE "@[A-Z]+@|$work" "$tree$prefix/lib/pkgconfig" "$tree$prefix/lib/cmake" "$tree$prefix/share"
}

# What the library shows is what the header declares.
the_shared_library_shows_the_public_header_alone() {
    nm -D --defined-only "$tree$prefix/lib/libfootfall.so" | awk '{ print $3 }' | sort >"$work/shown"
    grep -oE '\bff_[a-z0-9_]+\(' "$tree$prefix/include/footfall.h" | tr -d '(' | sort -u |
        grep -vE '^ff_(plane|ground|parallel_for|waypoint)$' >"$work/declared" # inline functions and function types
    diff "$work/declared" "$work/shown"
}
the_shared_library_needs_only_the_c_library() {
    needed=$(objdump -p "$tree$prefix/lib/libfootfall.so" | sed -n 's/^ *NEEDED *//p' | grep -vE '^(libc|libm|ld-linux.*)\.so')
    [ -z "$needed" ] || { echo "it also needs: $needed" && return 1; }
    objdump -p "$tree$prefix/lib/libfootfall.so" | grep -q "SONAME *libfootfall.so.${version%%.*}$"
}

cat >"$work/user.c" <<'EOF'
#include <footfall.h>
#include <stdio.h>
int main(void)
{
    ff_pack *pack = 0;
    ff_error error;
    char text[512];
    if (ff_pack_open("none.ffpack", &pack, &error) == FF_OK) return 1;
    puts(ff_error_text(&error, text, sizeof text));
    return 0;
}
EOF
works() { # PROGRAM: the program above runs and says what it should
    run 0 env LD_LIBRARY_PATH="$tree$prefix/lib" "$1" && says out "none.ffpack: cannot open this file"
}
pc() {
    PKG_CONFIG_SYSROOT_DIR=$tree PKG_CONFIG_PATH=$tree$prefix/lib/pkgconfig pkg-config "$@" footfall
}
pkg_config_builds_against_the_shared_library() {
    [ "$(pc --modversion)" = "$version" ] && cc -o "$work/shared" "$work/user.c" $(pc --cflags --libs) && works "$work/shared"
}
pkg_config_builds_against_the_static_library() {
    cc -o "$work/static" "$work/user.c" $(pc --cflags) "$tree$prefix/lib/libfootfall.a" -lm -pthread && works "$work/static"
}
cpp_programs_build_too() {
    cp "$work/user.c" "$work/user.cpp"
    c++ -o "$work/cpp" "$work/user.cpp" $(pc --cflags --libs) && works "$work/cpp"
}
cmake_finds_it_and_builds_both_ways() {
    mkdir -p "$work/cm"
    cat >"$work/cm/CMakeLists.txt" <<EOF
cmake_minimum_required(VERSION 3.13)
project(user C)
find_package(footfall $version REQUIRED)
add_executable(with_shared ../user.c)
target_link_libraries(with_shared footfall::footfall)
add_executable(with_static ../user.c)
target_link_libraries(with_static footfall::static)
EOF
    cmake -S "$work/cm" -B "$work/cm/build" -DCMAKE_PREFIX_PATH="$tree$prefix" && cmake --build "$work/cm/build" &&
        works "$work/cm/build/with_shared" && works "$work/cm/build/with_static"
}
cmake_refuses_a_newer_version() {
    mkdir -p "$work/newer"
    printf 'cmake_minimum_required(VERSION 3.13)\nproject(user C)\nfind_package(footfall 99.0 REQUIRED)\n' \
        >"$work/newer/CMakeLists.txt"
    run 1 cmake -S "$work/newer" -B "$work/newer/build" -DCMAKE_PREFIX_PATH="$tree$prefix" && says err "99.0"
}
every_option_is_in_the_man_page() {
    result=0
    for program in footfall-pack footfall-crowd; do
        page=$tree$prefix/share/man/man1/$program.1
        for path in $(commands_of "$FF_BUILD/$program"); do
            command=$(echo "$path" | tr / ' ')
            grep -q "$command" "$page" || { echo "$page does not name the command $command" && result=1; }
            for option in $("$FF_BUILD/$program" $command --help | sed -n 's/^  \(-.*\)/\1/p' | grep -oE -- '--[a-z-]+' | sort -u); do
                sed 's/\\-/-/g' "$page" | grep -q -- "$option" ||
                    { echo "$page does not name $command $option" && result=1; }
            done
        done
    done
    return "$result"
}

test_that "make install fills a staged tree" install_into_the_stage
test_that "every part is there" every_part_is_there
test_that "no place holder and no stage path is left" no_place_holder_and_no_stage_path_is_left
test_that "the shared library shows the public header alone" the_shared_library_shows_the_public_header_alone
test_that "the shared library needs only the C library" the_shared_library_needs_only_the_c_library
test_that "pkg-config builds against the shared library" pkg_config_builds_against_the_shared_library
test_that "pkg-config builds against the static library" pkg_config_builds_against_the_static_library
test_that "C++ programs build too" cpp_programs_build_too
test_that "every option is in the man page" every_option_is_in_the_man_page
if command -v cmake >/dev/null; then
    test_that "CMake finds it and builds both ways" cmake_finds_it_and_builds_both_ways
    test_that "CMake refuses a newer version" cmake_refuses_a_newer_version
else
    skip "CMake finds it and builds both ways" "cmake is not installed"
    skip "CMake refuses a newer version" "cmake is not installed"
fi
finish
