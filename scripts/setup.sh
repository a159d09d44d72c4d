#!/bin/sh
# Install what is missing from Debian's packages. Says nothing and takes no time when nothing is.
#
#   scripts/setup.sh         what building, testing and the demo need
#   scripts/setup.sh lint    also what `make lint` and `make format` need
set -eu

packages="gcc g++ make pkg-config clang libclang-rt-14-dev
    libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev libtinygltf-dev librecast-dev
    libceres-dev libopenmesh-dev libjansson-dev libxxhash-dev libcmocka-dev"
[ "${1:-}" != lint ] || packages="$packages clang-format clang-tidy cppcheck"
# Not needed, but a test of the installed CMake file is skipped without it: cmake.

give_up() {
    echo "setup: $1" >&2
    echo "setup: needed are the development files of OpenCV (core, imgproc, imgcodecs), tinygltf, Ceres, OpenMesh, jansson, xxHash" >&2
    echo "setup: and cmocka, gcc or clang (with its sanitizer runtimes), GNU make and pkg-config." >&2
    echo "setup: Debian 12 calls them:" $missing >&2
    exit 1
}

missing=
if command -v dpkg-query >/dev/null; then
    # One call for all: a name dpkg does not know prints nothing on standard output.
    installed=$(dpkg-query -W -f '${Status} ${Package}\n' $packages 2>/dev/null | sed -n 's/^install ok installed //p' || true)
    for package in $packages; do
        case " $(echo $installed) " in *" $package "*) ;; *) missing="$missing $package" ;; esac
    done
    [ -n "$missing" ] || exit 0
else
    missing=$packages
    give_up "this is not a Debian system, so nothing can be installed here; build with 'make' once you have them."
fi

command -v apt-get >/dev/null || give_up "there is no apt-get, so these cannot be installed:$missing"
if [ "$(id -u)" -eq 0 ]; then
    as_root=
elif command -v sudo >/dev/null; then
    as_root=sudo
else
    give_up "not root and no sudo, so these cannot be installed:$missing"
fi

echo "setup: installing$missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
export DEBIAN_FRONTEND=noninteractive
install_missing() {
    $as_root apt-get install -y --no-install-recommends $missing >>"$log" 2>&1
}
# The lists on the machine may serve; fetch new ones only when they do not.
if ! install_missing; then
    if ! { $as_root apt-get update >>"$log" 2>&1 && install_missing; }; then
        tail -20 "$log" >&2
        give_up "apt-get failed (its last words are above)"
    fi
fi
