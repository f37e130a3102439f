#!/usr/bin/env bash
# Builds projects from outside against an installed copy, and as a subproject. Prints TAP.
#
#   tests/consumer/run.sh
#
# Environment: SLUICE_BUILD   folder with the build to install, test/gcc (default: build)
#              CC, CXX        compilers of the outside projects (default: cc, c++)

# shellcheck disable=SC2317 # the functions are called by check
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${SLUICE_BUILD:-$root/build}/test/gcc
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
number=0 status=0

# check FACT COMMAND...
check() {
    local fact=$1
    shift
    number=$((number + 1))
    if "$@" >"$work/log" 2>&1; then
        echo "ok $number - $fact"
    else
        echo "not ok $number - $fact"
        tail -n 40 "$work/log" | sed 's/^/# /'
        status=1
    fi
}

# Installed somewhere else than configured, as packagers do; pkg-config is told of it below.
install_copy() { DESTDIR=$work/root meson install -C "$build" --no-rebuild; }

find_installed() {
    local found
    found=$(find "$work/root" -name sluice.pc | head -n 1)
    [ -n "$found" ] || return 1
    # The prefix that pkg-config files name lies below DESTDIR.
    PKG_CONFIG_PATH=$(dirname "$found")
    prefix=$work/root$(sed -n 's/^prefix=//p' "$found")
    LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH")
    export PKG_CONFIG_PATH LD_LIBRARY_PATH
}

installed_modules() {
    local name
    for name in sluice sluice-exr sluice-container sluice-store sluice-bake sluice-vulkan; do
        [ ! -f "$PKG_CONFIG_PATH/$name.pc" ] || echo "$name"
    done
}

relocate() { sed -i "s|^prefix=.*|prefix=$prefix|" "$PKG_CONFIG_PATH"/*.pc; }

modules_are_complete() {
    local name
    for name in $(installed_modules); do
        pkg-config --exists --print-errors "$name" || return 1
        [ "$(pkg-config --modversion "$name")" = "$(sed -n "s/.*version: '\(.*\)',/\1/p" "$root/meson.build" | head -n 1)" ] || return 1
    done
}

every_public_header_is_installed() {
    local header name
    for header in "$root"/include/sluice/*.h; do
        name=$(basename "$header" .h)
        case $name in
        dds | ktx2) [ -f "$PKG_CONFIG_PATH/sluice-container.pc" ] || continue ;;
        exr | store | bake | vulkan) [ -f "$PKG_CONFIG_PATH/sluice-$name.pc" ] || continue ;;
        esac
        [ -f "$prefix/include/sluice/$name.h" ] || { echo "$name.h is missing"; return 1; }
    done
}

meson_project() {
    meson setup "$work/meson" "$root/tests/consumer" --wrap-mode=nofallback &&
        meson test -C "$work/meson"
}

# plain SOURCE COMPILER FLAGS...
plain() {
    local source=$1 modules flags
    shift
    modules=$(installed_modules)
    # shellcheck disable=SC2086 # lists of words
    flags="$(pkg-config --cflags --libs $modules)"
    for name in $modules; do
        flags="$flags $(echo "$name" | sed -n 's/sluice-\(.*\)/-DWITH_\1/p' | tr '[:lower:]' '[:upper:]')"
    done
    # shellcheck disable=SC2086
    "$@" "$root/tests/consumer/$source" $flags -o "$work/plain" && "$work/plain"
}

plain_static() {
    # shellcheck disable=SC2046 # lists of words
    "${CC:-cc}" "$root/tests/consumer/main.c" -static $(pkg-config --static --cflags --libs sluice) \
        -o "$work/static" && "$work/static"
}

subproject() {
    mkdir -p "$work/outside/subprojects" &&
        cp "$root"/tests/consumer/{meson.build,main.c,main.cpp} "$work/outside" &&
        ln -s "$root" "$work/outside/subprojects/sluice" &&
        meson setup "$work/sub" "$work/outside" --force-fallback-for=sluice --wrap-mode=nodownload \
            -Dsluice:exr=disabled -Dsluice:container=disabled -Dsluice:store=disabled \
            -Dsluice:bake=disabled -Dsluice:vulkan=disabled -Dsluice:samples=disabled &&
        meson test -C "$work/sub"
}

# What `meson dist` packs is complete: it configures and builds on its own.
release_archive() {
    local archive
    meson dist -C "$build" --no-tests --allow-dirty --formats=gztar || return 1
    archive=$(find "$build/meson-dist" -name '*.tar.gz' | head -n 1)
    [ -n "$archive" ] && mkdir "$work/unpacked" && tar -xzf "$archive" -C "$work/unpacked" &&
        meson setup "$work/dist" "$work"/unpacked/* -Dtests=false -Dsamples=disabled &&
        ninja -C "$work/dist"
}

echo 1..10
check installs install_copy
check pkg_config_file_is_installed find_installed
find_installed && relocate
check pkg_config_modules_are_complete modules_are_complete
check every_public_header_is_installed every_public_header_is_installed
check meson_project_builds_against_the_installed_copy meson_project
check compiler_builds_against_the_installed_copy plain main.c "${CC:-cc}" -std=c11 -Wall -Wextra -Werror
check cpp_compiler_builds_against_the_installed_copy plain main.cpp "${CXX:-c++}" -std=c++11 -Wall -Wextra -Werror
check static_program_needs_only_libc plain_static
check meson_subproject_builds subproject
if git -C "$root" rev-parse HEAD >/dev/null 2>&1; then
    check release_archive_is_complete release_archive
else
    number=$((number + 1))
    echo "ok $number - release_archive_is_complete # SKIP there is no git, or no repository"
fi
exit $status
