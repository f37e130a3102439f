#!/bin/sh
# Deriving package sources for another suite from sources of both formats. Prints TAP.
# test_sources.sh SOURCES.AWK
program=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
number=0 status=0

# expect FACT FILE FROM TO COMPONENTS: the input is the file, the expected output is on stdin
expect() {
    number=$((number + 1))
    cat >"$folder/expected"
    awk -v from="$3" -v to="$4" -v components="$5" \
        -v official='http://m.example/d/ mirror+file:/etc/mirrors.list/' \
        -f "$program" "$folder/$2" >"$folder/found"
    if diff -u "$folder/expected" "$folder/found" >"$folder/diff"; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        sed 's/^/# /' "$folder/diff"
        status=1
    fi
}
echo 1..7

cat >"$folder/one.list" <<'EOF'
# deb http://m.example/d bookworm main
deb [arch=amd64,arm64 signed-by=/k.gpg trusted=yes] http://m.example/d bookworm main contrib # why
deb-src http://m.example/d bookworm main
deb http://m.example/d bookworm-updates main
deb http://other.example/d bookworm main
deb http://m.example/d bookworm stable
EOF
expect one_line_source_keeps_its_options one.list bookworm bookworm-backports '' <<'EOF'
Types: deb
URIs: http://m.example/d
Suites: bookworm-backports
Components: main contrib
architectures: amd64 arm64
signed-by: /k.gpg
trusted: yes

EOF

cat >"$folder/two.sources" <<'EOF'
# a comment
Types: deb deb-src
URIs: http://other.example/d mirror+file:/etc/mirrors.list
Suites: bookworm bookworm-updates
# another
Components: main
Signed-By:
 -----BEGIN PGP PUBLIC KEY BLOCK-----
 .
 abc
 -----END PGP PUBLIC KEY BLOCK-----
Check-Valid-Until: no

Types: deb
Enabled: no
URIs: http://m.example/d
Suites: bookworm
Components: main

types: deb
uris: http://m.example/d/
suites: bookworm-security
components: main
EOF
expect stanza_keeps_an_embedded_key_and_drops_what_is_disabled two.sources bookworm bookworm-backports '' <<'EOF'
Types: deb
URIs: mirror+file:/etc/mirrors.list
Suites: bookworm-backports
Components: main
Signed-By:
 -----BEGIN PGP PUBLIC KEY BLOCK-----
 .
 abc
 -----END PGP PUBLIC KEY BLOCK-----
Check-Valid-Until: no

EOF
expect other_component_is_taken_from_every_suite_of_the_release two.sources bookworm '' universe <<'EOF'
Types: deb
URIs: mirror+file:/etc/mirrors.list
Suites: bookworm bookworm-updates
Components: universe
Signed-By:
 -----BEGIN PGP PUBLIC KEY BLOCK-----
 .
 abc
 -----END PGP PUBLIC KEY BLOCK-----
Check-Valid-Until: no

Types: deb
URIs: http://m.example/d/
Suites: bookworm-security
Components: universe

EOF

printf 'Types: deb\nURIs: http://m.example/d\nSuites: noble\nComponents: main\nEnabled: yes' >"$folder/end.sources"
expect last_stanza_needs_no_newline end.sources noble noble-updates 'main universe' <<'EOF'
Types: deb
URIs: http://m.example/d
Suites: noble-updates
Components: main universe

EOF

: >"$folder/empty.list"
expect empty_file_gives_nothing empty.list bookworm bookworm-backports '' </dev/null

printf 'deb http://m.example/d bookworm main\ndeb http://m.example/d bookworm main\n' >"$folder/twice.list"
expect source_that_stands_twice_is_derived_once twice.list bookworm bookworm-backports '' <<'EOF'
Types: deb
URIs: http://m.example/d
Suites: bookworm-backports
Components: main

EOF

printf 'deb http://third.example/d bookworm main\n' >"$folder/third.list"
expect third_party_with_the_same_suite_name_is_left_alone third.list bookworm bookworm-backports '' </dev/null
exit $status
