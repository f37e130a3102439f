# What the build and the tests need, by package name (the same on Debian 12, 13 and Ubuntu 24.04),
# what of it is missing, and how it is installed. Nothing here asks anything.
# shellcheck shell=bash

packages_to_build=(gcc libc6-dev meson ninja-build pkg-config glslang-tools spirv-tools
    libvulkan-dev mesa-vulkan-drivers libopenexr-dev libimath-dev libpng-dev zlib1g-dev libzstd-dev
    libxxhash-dev libvips-dev libsquish-dev libastcenc-dev g++
    libcurl4-openssl-dev libglfw3-dev libimgui-dev libassimp-dev libcjson-dev fonts-dejavu-core)
# lld: a build links 500 programs, and it takes half as long for each as the default.
# llvm: the leak sanitizer needs its symbolizer to know which leaks are a driver's.
packages_to_test=(binutils clang cmake lld llvm libcmocka-dev libembree-dev vulkan-validationlayers xvfb xdotool
    xclip nginx-light iproute2)

package_is_installed() {
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# clang recommends its sanitizer runtimes, and they are named after its version.
clang_runtime_package() {
    local version
    version=$({
        dpkg-query -W -f='Depends: ${Depends}\n' clang 2>/dev/null || apt-cache show clang 2>/dev/null
    } | sed -n 's/^Depends:.*\bclang-\([0-9][0-9]*\)\b.*/\1/p' | head -n 1)
    [ -n "$version" ] && say "libclang-rt-$version-dev"
}

# needed_packages build|test
needed_packages() {
    printf '%s\n' "${packages_to_build[@]}"
    if [ "$1" = test ]; then
        printf '%s\n' "${packages_to_test[@]}"
        clang_runtime_package || true
    fi
}

missing_packages() {
    local name
    for name in $(needed_packages "$1"); do
        package_is_installed "$name" || printf '%s ' "$name"
    done
}

# become_root finds out once how: directly, or through sudo, which may ask for the password where
# there is a terminal. as_root then asks nothing.
root_command=unknown
become_root() {
    [ "$root_command" = unknown ] || return 0
    if [ "$(id -u)" -eq 0 ]; then
        root_command=''
    elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [ -t 0 ] && sudo -v; }; }; then
        root_command=sudo
    else
        return 1
    fi
}

as_root() { ${root_command:+"$root_command"} "$@"; }

apt_get() {
    as_root env DEBIAN_FRONTEND=noninteractive NEEDRESTART_MODE=a apt-get \
        -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 "$@"
}

# A third party's broken source must not stop us, so failure here is left to the installation.
apt_update() {
    logged "$SLUICE_BUILD/logs/apt-update.log" apt_get update || warn "not every package list could be read"
}

# apt_install LOG ARGUMENTS...
apt_install() {
    local log=$SLUICE_BUILD/logs/$1.log
    shift
    logged "$log" apt_get install -y --no-install-recommends "$@"
}

# One line per package list of the distribution itself: URI, suite, component.
distribution_targets() {
    # shellcheck disable=SC2016 # apt fills in the names
    apt-get indextargets --format '$(ORIGIN)|$(REPO_URI)|$(RELEASE)|$(COMPONENT)' \
        'Created-By: Packages' 2>/dev/null | sed -n 's/^\(Debian\|Debian Backports\|Ubuntu\)|//p'
}

# add_suite NAME FROM TO COMPONENTS: derives a source from the machine's own ones (see sources.awk)
# and writes it to a file of its own. Fails if there is nothing to derive it from.
add_suite() {
    local file=/etc/apt/sources.list.d/sluice-$1.sources official text
    local -a inputs=()
    official=$(distribution_targets | cut -d '|' -f 1 | sort -u | tr '\n' ' ')
    for f in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
        [ -f "$f" ] && [ "$f" != "$file" ] && inputs+=("$f")
    done
    [ ${#inputs[@]} -gt 0 ] || return 1
    text=$(awk -v from="$2" -v to="$3" -v components="$4" -v official="$official" \
        -f "$SLUICE_ROOT/scripts/lib/sources.awk" "${inputs[@]}")
    [ -n "$text" ] || return 1
    printf '%s\n' "$text" | as_root tee "$file" >/dev/null || return 1
    say "added to the package sources: ${3:-the same suites} ${4:+($4) }in $file"
}

remove_suite() { as_root rm -f "/etc/apt/sources.list.d/sluice-$1.sources"; }

# Ubuntu keeps several of the packages in its universe component.
ensure_universe() {
    [ "$distribution" = ubuntu ] || return 0
    if ! distribution_targets | grep -q '|universe$'; then
        say "The universe component is not enabled; taking it from the machine's own sources."
        add_suite universe "$codename" "" universe && apt_update
    fi
}

read_distribution() {
    distribution=unknown codename=unknown
    if [ -r /etc/os-release ]; then
        # shellcheck disable=SC1091
        distribution=$(. /etc/os-release && say "${ID:-unknown}")
        # shellcheck disable=SC1091
        codename=$(. /etc/os-release && say "${VERSION_CODENAME:-unknown}")
    fi
}

# ensure_packages build|test INSTALL: INSTALL is yes or no.
ensure_packages() {
    local missing
    read_distribution
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        warn "no apt here; these Debian packages (or their like) are needed: $(needed_packages "$1" | tr '\n' ' ')"
        return 0
    fi
    missing=$(missing_packages "$1")
    if [ -n "$missing" ] && [ "$2" = no ]; then
        warn "not installed: $missing"
    elif [ -n "$missing" ]; then
        title "Installing what is missing"
        become_root || die "run this as root or with sudo; not installed: $missing"
        apt_update
        ensure_universe || warn "universe cannot be had from the machine's own sources"
        missing=$(missing_packages "$1")
        say "$missing"
        # shellcheck disable=SC2086 # a list of words
        apt_install apt-install $missing || die "the packages could not be installed"
    else
        say "Everything needed is installed."
    fi
    ensure_mesa "$2"
}
