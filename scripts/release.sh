#!/usr/bin/env bash
# release.sh [FOLDER] [REVISION]: writes sluice-VERSION.tar.gz, its checksums, and a Meson wrap of it.
#
# VERSION is that of meson.build in REVISION (default: HEAD). The tarball depends on the revision alone: the same
# commands give the same bytes, also on another day, with the same git and gzip. FOLDER: default build/release.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
folder=${1:-$root/build/release} revision=${2:-HEAD}
if [ $# -gt 2 ] || [ "${folder#-}" != "$folder" ]; then
    sed -n '2s/^# //p' "$0" >&2
    exit 2
fi

git() { command git -C "$root" "$@"; }
version=$(git show "$revision:meson.build" | sed -n "s/^  version: '\(.*\)',\$/\1/p")
[ -n "$version" ] || { echo "release.sh: meson.build of $revision has no version" >&2; exit 1; }
git show "$revision:CHANGELOG.md" | grep "^## $version\b" >/dev/null ||
    { echo "release.sh: CHANGELOG.md of $revision has no section $version" >&2; exit 1; }
if [ "$revision" = HEAD ] && [ -n "$(git status --porcelain --untracked-files=no)" ]; then
    echo "release.sh: changes that are not committed are left out" >&2
fi

name=sluice-$version
mkdir -p "$folder"
cd "$folder"
# gzip -n writes neither name nor time; git takes all times from the commit.
git archive --format=tar --prefix="$name/" "$revision" | gzip -9n >"$name.tar.gz.part"
mv "$name.tar.gz.part" "$name.tar.gz"
sha256sum "$name.tar.gz" >"$name.tar.gz.sha256"
sha512sum "$name.tar.gz" >"$name.tar.gz.sha512"
cat >sluice.wrap <<END
[wrap-file]
directory = $name
source_filename = $name.tar.gz
source_hash = $(cut -d ' ' -f 1 "$name.tar.gz.sha256")
# source_url = where $name.tar.gz lies; without it, put the file into subprojects/packagecache

[provide]
$(git show "$revision:lib/meson.build" | sed -n "s/^ *libraries += {'\([a-z]*\)': .*/dependency_names = sluice-\1/p" |
    sed 's/dependency_names = //' | sort | { echo sluice; cat; } | paste -sd , | sed 's/,/, /g; s/^/dependency_names = /')
END
echo "$PWD/$name.tar.gz"
