#!/bin/sh
# check_macos.sh ROOT CLANG platform|all: lib compiles for macOS against tests/cross/macos. Prints TAP.
#
# The headers there declare what macOS has of C and POSIX, and nothing else, so a call that macOS lacks is
# an error. Written from public documentation; nobody has compiled or run Sluice on a Mac.
#
# `platform` compiles lib/platform, where all calls of the system are. `all` compiles every layer but
# those that use libvips or Vulkan.
root=$1 clang=$2 part=$3
packages=$(mktemp -d)
trap 'rm -rf "$packages"' EXIT
number=0 status=0

report() { # FACT LOG
    number=$((number + 1))
    if [ ! -s "$2" ]; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        sed 's/^/# /' "$2" | head -n 40
        status=1
    fi
}

# Flags as in meson.build
compile() {
    "$clang" --target=arm64-apple-macos11 -nostdlibinc -isystem "$root/tests/cross/macos" -isystem "$packages" -std=c11 \
        -fsyntax-only -Wall -Wextra -Wpedantic -Wno-missing-field-initializers -Werror -I"$root/include" \
        -I"$root/lib" -I"$root/shaders/include" "$@"
}

# refuses DECLARATIONS STATEMENT
refuses() {
    printf '%s\nvoid call(void);\nvoid call(void) { %s; }\n' "$1" "$2" >"$packages/call.c"
    if compile "$packages/call.c" 2>/dev/null; then echo "$2 compiles"; fi
}

sources() {
    find "$root/lib/$1" -name '*.c' ! -name '*_windows.c' -exec grep -L '<vips/' {} + | sort
}

if [ "$part" = all ]; then
    layers='platform base residency core demand replay image metrics proxy exr container store bake neural open pbrt'
    for header in zstd.h zstd_errors.h xxhash.h zlib.h zconf.h vulkan vk_video; do
        found=$(find /usr/include "/usr/include/$(uname -m)-linux-gnu" -maxdepth 1 -name "$header" | head -n 1)
        [ -z "$found" ] || ln -s "$found" "$packages"
    done
    [ ! -d /usr/include/OpenEXR ] || ln -s /usr/include/OpenEXR/* "$packages"
else
    layers=platform
fi
# shellcheck disable=SC2086 # a list of words
set -- $layers
echo "1..$(($# + 1))"
{
    refuses '#include <pthread.h>' 'pthread_condattr_t a; pthread_condattr_setclock(&a, CLOCK_MONOTONIC)'
    refuses '#include <fcntl.h>' 'posix_fallocate(3, 0, 1)'
    refuses '#include <math.h>' 'double s, c; sincos(1.0, &s, &c)'
} >"$packages/log"
report calls_that_macos_lacks_do_not_compile "$packages/log"
for layer; do
    # shellcheck disable=SC2046 # a list of words
    compile $(sources "$layer") >"$packages/log" 2>&1
    report "lib_${layer}_compiles_for_macos" "$packages/log"
done
exit $status
