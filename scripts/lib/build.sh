# Configuring and compiling with Meson.
# shellcheck shell=bash

# The system's own packages are used; without them Meson may fetch what subprojects/ names.
wrap_mode() {
    if command -v dpkg-query >/dev/null && [ -z "$(missing_packages "$1")" ]; then
        say nofallback
    else
        say default
    fi
}

# configure FOLDER OPTIONS...: sets a build folder up, or brings its options up to date.
configure() {
    local folder=$1
    shift
    if [ -f "$folder/build.ninja" ]; then
        set -- --reconfigure "$@"
    else
        rm -rf "$folder"
    fi
    logged "$folder.setup.log" meson setup "$folder" "$SLUICE_ROOT" "$@"
}

# compile FOLDER TARGETS...
compile() {
    local folder=$1
    shift
    logged "$folder.build.log" ninja -C "$folder" "$@"
}
