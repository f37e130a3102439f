#!/usr/bin/env bash
# Builds projects from outside against an installed copy, and as a subproject. Prints TAP.
#
#   tests/consumer/run.sh
#
# Environment: SLUICE_BUILD   folder with the build to install, test/gcc (default: build)
#              SLUICE_INSTALL the build to install itself, instead
#              CC, CXX        compilers of the outside projects (default: cc, c++)

# shellcheck disable=SC2317 # the functions are called by check
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${SLUICE_INSTALL:-${SLUICE_BUILD:-$root/build}/test/gcc}
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
    for name in sluice sluice-exr sluice-container sluice-store sluice-bake sluice-neural sluice-pbrt sluice-http sluice-open sluice-vulkan; do
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

# For shared and for static programs; the prefix is nowhere that a compiler or pkg-config looks by itself.
pkg_config_answers() {
    local name what
    for name in $(installed_modules); do
        for what in --cflags --libs '--static --libs' '--static --cflags' --variable=prefix; do
            # shellcheck disable=SC2086 # a list of words
            pkg-config --print-errors $what "$name" || return 1
        done
        pkg-config --cflags "$name" | grep -q -e "-I$prefix/include" || return 1
        pkg-config --libs "$name" | grep -q -e "-L$(dirname "$PKG_CONFIG_PATH")" || return 1
    done
}

# The Vulkan library links no loader, so the loader's package may be missing.
vulkan_module_stands_alone() {
    local name=sluice-vulkan
    [ -f "$PKG_CONFIG_PATH/$name.pc" ] || name=sluice
    env PKG_CONFIG_LIBDIR="$PKG_CONFIG_PATH" PKG_CONFIG_PATH= pkg-config --print-errors --cflags --static --libs "$name"
}

every_public_header_is_installed() {
    local header name
    for header in "$root"/include/sluice/*.h; do
        name=$(basename "$header" .h)
        case $name in
        dds | ktx2) [ -f "$PKG_CONFIG_PATH/sluice-container.pc" ] || continue ;;
        exr | store | bake | vulkan | pbrt) [ -f "$PKG_CONFIG_PATH/sluice-$name.pc" ] || continue ;;
        esac
        [ -f "$prefix/include/sluice/$name.h" ] || { echo "$name.h is missing"; return 1; }
    done
    [ -f "$prefix/include/sluice/sluice.hpp" ]
}

meson_project() {
    meson setup "$work/meson" "$root/tests/consumer" --wrap-mode=nofallback &&
        meson test -C "$work/meson"
}

# Of what is installed, shared; the folder may lie anywhere.
cmake_project() {
    local components
    components=$(installed_modules | sed -n 's/^sluice-//p' | paste -sd ';')
    cmake -S "$root/tests/consumer" -B "$work/cmake" -DCMAKE_PREFIX_PATH="$1" -DCOMPONENTS="$components" &&
        cmake --build "$work/cmake" && "$work/cmake/from_c" && "$work/cmake/from_cpp"
}

# -DWITH_EXR and so on
with_modules() { installed_modules | sed -n 's/sluice-\(.*\)/-DWITH_\1/p' | tr '[:lower:]' '[:upper:]'; }

# plain SOURCE COMPILER FLAGS...
plain() {
    local source=$1 flags
    shift
    # shellcheck disable=SC2046 # lists of words
    flags="$(with_modules) $(pkg-config --cflags --libs $(installed_modules))"
    # shellcheck disable=SC2086
    "$@" "$root/tests/consumer/$source" $flags -o "$work/plain" && "$work/plain"
}

plain_static() {
    # shellcheck disable=SC2046 # lists of words
    "${CC:-cc}" "$root/tests/consumer/main.c" -static $(pkg-config --static --cflags --libs sluice) \
        -o "$work/static" && "$work/static"
}

# All libraries in one program, with everything in them, so that no two define the same name. What they
# need of the system may stay shared.
all_static() {
    local name archives='' needs='' packages
    for name in $(installed_modules | tac); do # those that use others first
        archives="$archives -l:lib$name.a"
        needs="$needs $(sed -n 's/^Libs.private: //p' "$PKG_CONFIG_PATH/$name.pc")"
        packages=$(pkg-config --print-requires-private "$name" | sed 's/ .*//' | grep -v '^sluice')
        # shellcheck disable=SC2086 # lists of words
        [ -z "$packages" ] || needs="$needs $(pkg-config --libs $packages)" || return 1
    done
    # shellcheck disable=SC2046,SC2086
    "${CC:-cc}" "$root/tests/consumer/main.c" $(with_modules) $(pkg-config --cflags sluice) \
        -L"$(dirname "$PKG_CONFIG_PATH")" "$@" $archives -Wl,--no-whole-archive $needs -o "$work/all_static" &&
        "$work/all_static" && ! ldd "$work/all_static" | grep libsluice
}

subproject() {
    mkdir -p "$work/outside/subprojects" &&
        cp "$root"/tests/consumer/{meson.build,main.c,main.cpp} "$work/outside" &&
        ln -s "$root" "$work/outside/subprojects/sluice" &&
        meson setup "$work/sub" "$work/outside" --force-fallback-for=sluice --wrap-mode=nodownload \
            -Dsluice:exr=disabled -Dsluice:container=disabled -Dsluice:store=disabled \
            -Dsluice:bake=disabled -Dsluice:vulkan=disabled -Dsluice:samples=disabled \
            -Dsluice:neural=disabled -Dsluice:pbrt=disabled -Dsluice:http=disabled &&
        meson test -C "$work/sub"
}

# The archive of `meson dist` has every tracked file, configures, and has what each step of its build reads.
# Nothing is compiled: the checkout, which has the same files, has been compiled by now.
release_archive() {
    local archive
    meson dist -C "$build" --no-tests --allow-dirty --formats=gztar || return 1
    archive=$(find "$build/meson-dist" -name '*.tar.gz' | head -n 1)
    [ -n "$archive" ] && mkdir "$work/unpacked" &&
        tar -xzf "$archive" -C "$work/unpacked" --strip-components=1 &&
        diff <(git -C "$root" ls-tree -r --name-only HEAD | sort) <(cd "$work/unpacked" && find . ! -type d | cut -c 3- | sort) &&
        meson setup "$work/dist" "$work/unpacked" -Dtests=false -Dsamples=disabled -Dbuildtype=plain -Ddefault_library=shared &&
        ninja -n -C "$work/dist"
}

# As somebody does who unpacks a release elsewhere.
move_prefix() { moved="$work/moved to another place" && mkdir "$moved" && mv "$prefix"/* "$moved"; }
installed_programs() { find "$moved/bin" "$moved/libexec" -type f -name '*' -perm -u+x 2>/dev/null; }

# The environment names no libraries, so programs find their own.
every_program_starts() {
    local program count=0
    while IFS= read -r program; do
        count=$((count + 1))
        if ! (unset LD_LIBRARY_PATH && "$program" --help >"$work/help") || [ ! -s "$work/help" ]; then
            echo "$program does not start"
            return 1
        fi
    done < <(installed_programs)
    [ "$count" -ge 3 ]
}

# runs NAME ARGUMENTS...: of an installed program, in a folder of its own; one that is not there is passed over
runs() {
    local program=$moved/$1
    shift
    [ ! -x "$program" ] || (unset LD_LIBRARY_PATH && cd "$work/runs" && "$program" "$@")
}

every_program_does_its_work() {
    mkdir -p "$work/runs" && printf 'P5\n4 4\n255\n0123456789abcdef' >"$work/runs/in.pgm"
    runs bin/sluice-replay "$root/tests/data/first_light.trace" || return 1
    if [ -x "$moved/bin/sluice-bake" ]; then
        runs bin/sluice-bake in.pgm -o out.store && runs bin/sluice-info out.store || return 1
    fi
    # Finds the gallery, which is no command of its own.
    [ ! -x "$moved/libexec/sluice/streaming" ] ||
        runs bin/sluice-tradeoff gallery --results out --sweep probability=1/4 --repeats 1 -- --cache cache \
            --generate-scale 32 --size 64x36 --frames 4 --rest-frames 1 &&
        runs libexec/sluice/demand-tracer --size 64x36 --samples 1 --texture-count 5 --texture-size 1024
}

echo 1..19
check installs install_copy
check pkg_config_file_is_installed find_installed
find_installed && relocate
check pkg_config_modules_are_complete modules_are_complete
check pkg_config_answers_for_shared_and_static_programs pkg_config_answers
check vulkan_module_needs_no_package_of_the_loader vulkan_module_stands_alone
check every_public_header_is_installed every_public_header_is_installed
check meson_project_builds_against_the_installed_copy meson_project
if command -v cmake >/dev/null; then
    check cmake_project_builds_against_the_installed_copy cmake_project "$prefix"
else
    number=$((number + 1))
    echo "ok $number - cmake_project_builds_against_the_installed_copy # SKIP there is no CMake"
fi
check compiler_builds_against_the_installed_copy plain main.c "${CC:-cc}" -std=c11 -Wall -Wextra -Werror
check cpp_compiler_builds_against_the_installed_copy plain main.cpp "${CXX:-c++}" -std=c++11 -Wall -Wextra -Werror
check owners_of_cpp17_build_against_the_installed_copy plain main.cpp "${CXX:-c++}" -std=c++17 -Wall -Wextra -Werror
check static_program_needs_only_libc plain_static
check all_libraries_link_statically_into_one_program all_static
check static_libraries_define_every_name_once all_static -Wl,--whole-archive
check meson_subproject_builds subproject
if git -C "$root" rev-parse HEAD >/dev/null 2>&1; then
    check release_archive_is_complete release_archive
else
    number=$((number + 1))
    echo "ok $number - release_archive_is_complete # SKIP there is no git, or no repository"
fi
check the_prefix_can_be_moved move_prefix
check installed_programs_start_from_any_prefix every_program_starts
check installed_programs_do_their_work_from_any_prefix every_program_does_its_work
exit $status
