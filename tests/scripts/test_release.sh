#!/usr/bin/env bash
# test_release.sh RELEASE FACTS: the tarball of a small project. Prints TAP.
release=$(realpath "$1") facts=$(realpath "$2")
command -v git >/dev/null || { echo "1..0 # SKIP there is no git"; exit 0; }
# shellcheck source=/dev/null
. "$facts"
export GIT_CONFIG_GLOBAL=/dev/null GIT_CONFIG_SYSTEM=/dev/null
unset GIT_DIR GIT_WORK_TREE

commit() { git add -A && git -c user.name=a -c user.email=b@c -c commit.gpgsign=false commit -qm "$1" >out 2>err; }
make() { tool=./scripts/release.sh run "$@"; }
# A version that a later line repeats, and more text than a pipe holds.
mkdir -p project/scripts project/lib && cd project && git init -q . && cp "$release" scripts/release.sh &&
    printf "project('sluice', 'c',\n  version: '7.8.9',\n)\n" >meson.build &&
    { printf '# Changes\n\n## 7.8.9, unreleased\n' && yes -- '- A line.' | head -n 12000; } >CHANGELOG.md &&
    printf "libraries = {}\n  libraries += {'store': {}}\n" >lib/meson.build && commit first
fact a_project_can_be_made

make 0 "$PWD/../one" && touch -d 2001-01-01 meson.build && make 0 "$PWD/../two" &&
    cmp ../one/sluice-7.8.9.tar.gz ../two/sluice-7.8.9.tar.gz
fact the_same_revision_gives_the_same_bytes

# The second may be the same in both: so no time is in gzip's header, and those in the archive are the commit's.
[ "$(wc -c <CHANGELOG.md)" -gt 100000 ] && [ "$(od -An -tu4 -j4 -N4 ../one/sluice-7.8.9.tar.gz | tr -d ' ')" = 0 ] &&
    [ "$(TZ=UTC tar -tvf ../one/sluice-7.8.9.tar.gz --full-time | awk '{ print $4, $5 }' | sort -u)" = \
        "$(TZ=UTC git log -1 --date=format-local:'%F %T' --format=%cd)" ]
fact all_times_are_those_of_the_commit

(cd ../one && sha256sum --quiet -c sluice-7.8.9.tar.gz.sha256 && sha512sum --quiet -c sluice-7.8.9.tar.gz.sha512) &&
    grep -q "source_hash = $(sha256sum <../one/sluice-7.8.9.tar.gz | cut -d ' ' -f 1)" ../one/sluice.wrap &&
    grep -q '^dependency_names = sluice, sluice-store$' ../one/sluice.wrap
fact checksums_and_the_wrap_fit_the_tarball

echo changed >>meson.build && echo new >untracked && make 0 "$PWD/../three" && grep -q 'not committed' err &&
    cmp ../one/sluice-7.8.9.tar.gz ../three/sluice-7.8.9.tar.gz
fact what_is_not_committed_is_left_out

sed -i 's/7.8.9/7.9.0/' meson.build && commit second && make 1 "$PWD/../four" && grep -q 'no section 7.9.0' err &&
    make 0 "$PWD/../four" HEAD~1 && cmp ../one/sluice-7.8.9.tar.gz ../four/sluice-7.8.9.tar.gz
fact a_version_without_changes_is_refused_and_older_revisions_can_be_made

make 2 --help && make 2 a b c
fact wrong_words_are_refused
end_facts
