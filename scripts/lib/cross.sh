# Builds for other systems and runs them: Windows with MinGW-w64 and Wine, aarch64 and s390x with
# clang and qemu-user, macOS with clang alone. What is missing for that is unpacked into a folder; nothing is installed.
# shellcheck shell=bash disable=SC2154

cross_root=$SLUICE_BUILD/cross-root
packages_to_cross=(gcc-mingw-w64-x86-64-win32 wine64 qemu-user binutils-s390x-linux-gnu
    libc6-dev-arm64-cross libc6-dev-s390x-cross)

# Packages that the compiler's version names.
cross_runtime_packages() {
    local version
    version=$(apt-cache pkgnames libgcc- 2>/dev/null |
        sed -n 's/^libgcc-\([0-9]*\)-dev-arm64-cross$/\1/p' | sort -n | tail -n 1)
    [ -n "$version" ] && say "libgcc-$version-dev-arm64-cross" "libgcc-$version-dev-s390x-cross"
}

# unpack_archive FILE FOLDER: without Wine's 32-bit half and the emulators of other processors
unpack_archive() {
    case $1 in
    */lib*san*-cross_*) return 0 ;; # the runtimes of sanitizers
    esac
    dpkg-deb --fsys-tarfile "$1" | tar -x -C "$2" --exclude='*/i386-windows/*' --exclude='*/i686-w64-mingw32/*' \
        --exclude='./usr/share/doc/*' --exclude='./usr/share/man/*' --exclude='./usr/bin/qemu-[b-rt-z]*' \
        --exclude='./usr/bin/qemu-sh*' --exclude='./usr/bin/qemu-sparc*'
}

# apt resolves what this machine lacks. Decompressing takes 17 s of a processor, 8 s of that for Wine.
unpack_cross_tools() {
    local archives=$SLUICE_BUILD/cross-archives
    rm -rf "$archives" "$cross_root"
    mkdir -p "$archives/partial" "$cross_root"
    # shellcheck disable=SC2046 # lists of words
    apt-get install --download-only -y --no-install-recommends -o Debug::NoLocking=1 \
        -o APT::Sandbox::User=root -o "Dir::Cache::archives=$archives" \
        "${packages_to_cross[@]}" $(cross_runtime_packages) || return 1
    export -f unpack_archive
    # shellcheck disable=SC2016 # the other shell expands it
    find "$archives" -maxdepth 1 -name '*.deb' -print0 | xargs -0 -r -P "$(nproc)" -I {} \
        bash -o pipefail -c 'unpack_archive "$0" "$1"' {} "$cross_root" || return 1
    rm -rf "$archives"
    # Debian's script of that name looks for the server in /usr alone.
    ln -sf wineserver64 "$cross_root/usr/lib/wine/wineserver"
    touch "$cross_root/complete"
}

# with_root PATH: the folder under which it is, the unpacked one first; fails if it is nowhere
with_root() {
    local root
    for root in "$cross_root" ''; do
        if [ -e "$root/$1" ]; then
            say "$root"
            return 0
        fi
    done
    return 1
}

# cross_stage SYSTEM CONSTANTS OPTIONS...: builds and runs the programs of the suite $cross_suite of tests/cross
cross_stage() {
    local system=$1 folder=$tests_folder/$1
    local -a options=("${@:3}")
    stage_title "$system"
    printf '[constants]\n%s\n' "$2" >"$folder.ini"
    local off='-Dexr=disabled -Dzstd=disabled -Dstore=disabled -Dbake=disabled -Dsamples=disabled -Dneural=disabled -Dpbrt=disabled'
    # shellcheck disable=SC2086 # a list of words
    if configure "$folder" --cross-file "$SLUICE_ROOT/scripts/cross/$system.ini" --cross-file "$folder.ini" \
        --wrap-mode=nofallback --werror -Dbuildtype=plain -Ddefault_library=static $off "${options[@]}" &&
        compile "$folder" "$cross_suite-tests"; then
        fact passed "$system" build "compiles without a warning" ""
        run_meson_tests "$system" --no-rebuild --suite "$cross_suite"
    else
        fact failed "$system" build "compiles without a warning" "see $folder.build.log"
    fi
}

# A prefix of Wine that is complete enough for programs of the console, without Wine's own set-up,
# which copies 700 MB.
make_wine_prefix() {
    local prefix=$SLUICE_BUILD/wine libraries=$1/usr/lib/x86_64-linux-gnu/wine/x86_64-windows
    rm -rf "$prefix"
    mkdir -p "$prefix/dosdevices" "$prefix/drive_c/windows"
    ln -s "$libraries" "$prefix/drive_c/windows/system32"
    ln -s ../drive_c "$prefix/dosdevices/c:"
    ln -s / "$prefix/dosdevices/z:"
    echo disable >"$prefix/.update-timestamp"
    say "$prefix"
}

# Vulkan's headers are the same for all systems, but Meson looks only for those of the system it builds for.
# Prints the lines of a cross file that name them.
vulkan_headers_for_windows() {
    local folder=$SLUICE_BUILD/vulkan-for-windows name
    mkdir -p "$folder/include" || return 1
    for name in vulkan vk_video; do
        ln -sfn "/usr/include/$name" "$folder/include/$name"
    done
    # shellcheck disable=SC2016 # pkg-config expands it
    printf '%s\n' "includedir=$folder/include" 'Name: vulkan' 'Description: headers' 'Version: 1.2' 'Cflags: -I${includedir}' >"$folder/vulkan.pc"
    printf '%s\n' '[binaries]' "pkgconfig = '$(command -v pkg-config)'" '[properties]' "pkg_config_libdir = '$folder'"
}

# start_display: an X server for Wine's Vulkan, if Xvfb is installed. Without one the device tests are skipped.
start_display() {
    local number=$tests_folder/display
    command -v Xvfb >/dev/null || return 0
    : >"$number"
    Xvfb -displayfd 3 -nolisten tcp -screen 0 640x480x24 3>"$number" >/dev/null 2>&1 &
    display_server=$!
    for _ in $(seq 100); do
        [ ! -s "$number" ] || break
        sleep 0.1
    done
    DISPLAY=:$(cat "$number")
}

# start_wine ROOT: starts a server that stays, and boots it. Otherwise the server ends whenever no program runs,
# and programs that start at that moment wait for each other's boot.
start_wine() {
    local libraries
    libraries=$(with_root usr/x86_64-w64-mingw32/lib/zlib1.dll || true)/usr/x86_64-w64-mingw32/lib
    "$1/usr/lib/wine/wineserver64" -p || true
    WINEPATH="Z:$libraries" timeout 120 "$1/usr/lib/wine/wine64" wineboot --init \
        >"$tests_folder/wine.log" 2>&1 </dev/null || true
}

windows_stage() {
    local gcc wine constants name=x86_64-w64-mingw32 vulkan=disabled display_server=''
    gcc=$(with_root "usr/bin/$name-gcc-win32") && wine=$(with_root usr/lib/wine/wine64) || return 1
    local -x WINEPREFIX DISPLAY='' WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml,winemenubuilder.exe='
    WINEPREFIX=$(make_wine_prefix "$wine")
    constants="gcc = '$gcc/usr/bin/$name-gcc-win32'
ar = '$(with_root usr/bin/$name-ar)/usr/bin/$name-ar'
wine = '$wine/usr/lib/wine/wine64'"
    if [ "$cross_suite" = cross ] && [ -f /usr/include/vulkan/vulkan.h ] && command -v glslangValidator >/dev/null; then
        vulkan=enabled
        constants="$constants
$(vulkan_headers_for_windows)"
        start_display
    fi
    start_wine "$wine"
    cross_stage $name "$constants" -Dvulkan=$vulkan
    "$wine/usr/lib/wine/wineserver64" -k || true
    [ -z "$display_server" ] || kill "$display_server" || true
}

# processor_stage PROCESSOR
processor_stage() {
    local root qemu
    root=$(with_root "usr/$1-linux-gnu/include/stdio.h") && qemu=$(with_root "usr/bin/qemu-$1") || return 1
    cross_stage "$1-linux-gnu" "root = '${root:-/}'
qemu = '$qemu/usr/bin/qemu-$1'
tools = '$(with_root usr/s390x-linux-gnu/bin/ld)/usr/s390x-linux-gnu/bin'" -Dvulkan=disabled
}

# Compiles and runs nothing: there is no macOS to run it.
macos_stage() {
    local log=$tests_folder/macos.log status=0
    command -v clang >/dev/null || return 1
    stage_title macos
    "$SLUICE_ROOT/tests/cross/check_macos.sh" "$SLUICE_ROOT" clang all >"$log" 2>&1 || status=$?
    collect tap macos tests/cross/check_macos.sh "$log" "$status" >>"$facts"
    grep -v '^ok ' "$log" || true
}

# get_cross_tools INSTALL: INSTALL is yes or no
get_cross_tools() {
    if [ ! -f "$cross_root/complete" ] && { [ "$1" = no ] || ! command -v apt-get >/dev/null ||
        ! logged "$SLUICE_BUILD/logs/cross-tools.log" unpack_cross_tools; }; then
        warn "not every package for other systems can be had: ${packages_to_cross[*]}"
    fi
}

# cross_stages SUITE: cross or cross-quick. Needs get_cross_tools.
cross_stages() {
    local system cross_suite=$1
    # Of the unpacked programs: Wine and qemu find their libraries here.
    local -x LD_LIBRARY_PATH=$cross_root/usr/lib/x86_64-linux-gnu${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
    # The gcc stage compiles lib/platform for macOS; this does so with all of lib.
    [ "$cross_suite" = cross-quick ] || macos_stage || fact skipped macos cross "all of it" "there is no clang"
    windows_stage || fact skipped windows cross "all of it" "MinGW-w64 or Wine cannot be had"
    for system in aarch64 s390x; do
        processor_stage $system || fact skipped $system cross "all of it" "a C library or qemu-user cannot be had"
    done
}
