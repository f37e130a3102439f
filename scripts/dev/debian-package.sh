#!/usr/bin/env bash
# debian-package.sh [FOLDER]: builds Debian's source and binary packages of HEAD, without a network.
#
# Needs debhelper, dpkg-dev and what packaging/debian/control names. lintian looks at them if it is installed. FOLDER:
# default build/debian. DEB_BUILD_OPTIONS is as for dpkg-buildpackage: parallel=4.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
folder=${1:-$root/build/debian}
mkdir -p "$folder"
folder=$(cd "$folder" && pwd)
tarball=$("$root/scripts/release.sh" "$folder" | tail -n 1)
name=$(basename "$tarball" .tar.gz)
rm -rf "${folder:?}/$name"
mv "$tarball" "$folder/sluice_${name#sluice-}.orig.tar.gz"
tar -xzf "$folder/sluice_${name#sluice-}.orig.tar.gz" -C "$folder"
cp -r "$folder/$name/packaging/debian" "$folder/$name/debian"
(cd "$folder/$name" && dpkg-buildpackage -us -uc)
if command -v lintian >/dev/null; then
    # Whoever uploads the package gives an address and the number of a bug.
    lintian --tag-display-limit 0 --fail-on error,warning --suppress-tags \
        bogus-mail-host,bogus-mail-host-in-debian-changelog,initial-upload-closes-no-bugs "$folder"/sluice_*.changes
fi
