#!/usr/bin/env bash
# Runs the two commands on a fresh system: makes a minimal one in a folder, clones this repository
# into it and runs scripts/demo.sh and scripts/test.sh there as root.
#
#   scripts/dev/fresh-machine.sh SUITE [options]      SUITE: bookworm, trixie, noble
#
#   --folder DIR        where the system is made      (default: /tmp/sluice-fresh)
#   --mirror URI        package mirror                (default: the one this machine's apt uses)
#   --components LIST   of the fresh system           (default: main)
#   --commands LIST     separated by ;                (default: scripts/demo.sh;scripts/test.sh)
#   --revision REV      what to check out             (default: HEAD)
#   --keep              keep the system and reuse it next time
#   --help
#
# Needs root and debootstrap; for another distribution than the machine's own also its keyring and
# --mirror. Sample files in ../shared beside the checkout (or where SLUICE_SHARED says) are shown
# there, read-only.

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
for part in common packages; do
    # shellcheck source=/dev/null
    . "$here/lib/$part.sh"
done

suite='' folder=/tmp/sluice-fresh mirror='' components=main revision=HEAD keep=no
commands='scripts/demo.sh;scripts/test.sh'
while [ $# -gt 0 ]; do
    case $1 in
    --folder) folder=${2:?}; shift ;;
    --mirror) mirror=${2:?}; shift ;;
    --components) components=${2:?}; shift ;;
    --commands) commands=${2:?}; shift ;;
    --revision) revision=${2:?}; shift ;;
    --keep) keep=yes ;;
    --help) usage_of "$0"; exit 0 ;;
    -*) die "unknown option $1 (see --help)" ;;
    *) suite=$1 ;;
    esac
    shift
done
[ -n "$suite" ] || die "which suite? (see --help)"
[ "$(id -u)" -eq 0 ] || die "this needs root"
command -v debootstrap >/dev/null || die "debootstrap is not installed"
system=$folder/$suite

make_system() {
    local -a options=("--variant=minbase" "--components=$components")
    local script=/usr/share/debootstrap/scripts/$suite keyring=/usr/share/keyrings/ubuntu-archive-keyring.gpg
    if [ -z "$mirror" ]; then
        mirror=$(distribution_targets | sort -t '|' -k 2 | head -n 1 | cut -d '|' -f 1)
    fi
    [ -n "$mirror" ] || die "apt knows no mirror here; use --mirror"
    case $suite in
    noble | jammy)
        options+=("--keyring=$keyring")
        # Older versions of debootstrap do not know the newest names; all Ubuntu ones are alike.
        [ -e "$script" ] || script=/usr/share/debootstrap/scripts/jammy
        ;;
    esac
    mkdir -p "$folder"
    logged "$folder/$suite.debootstrap.log" debootstrap "${options[@]}" "$suite" "$system" "$mirror" "$script"
}

# How this machine reaches the mirror, and nothing else of it.
copy_network_settings() {
    local file
    cp /etc/resolv.conf "$system/etc/resolv.conf"
    for file in /etc/apt/apt.conf.d/*; do
        if grep -q -i -E '^ *Acquire::(http|https|Check)' "$file"; then
            cp "$file" "$system/etc/apt/apt.conf.d/"
        fi
    done
    if grep -q https: "$system/etc/apt/sources.list"; then
        mkdir -p "$system/etc/ssl" && cp -rL /etc/ssl/certs "$system/etc/ssl/"
    fi
}

clone() {
    rm -rf "$system/root/check/sluice"
    mkdir -p "$system/root/check"
    git clone --quiet --no-hardlinks "$SLUICE_ROOT" "$system/root/check/sluice"
    git -C "$system/root/check/sluice" checkout --quiet "$(git -C "$SLUICE_ROOT" rev-parse "$revision")"
}

# In mount and process namespaces of its own, so that nothing is left mounted or running.
inside() {
    # shellcheck disable=SC2016 # expanded inside
    unshare --mount --pid --fork bash -c '
        set -e
        system=$1 shared=$2
        shift 2
        mount --make-rprivate /
        mount -t proc proc "$system/proc"
        mount -t sysfs sysfs "$system/sys" 2>/dev/null || mount --rbind /sys "$system/sys"
        mount --rbind /dev "$system/dev"
        if [ -d "$shared" ]; then
            mkdir -p "$system/root/check/shared"
            mount --bind -o ro "$shared" "$system/root/check/shared"
        fi
        exec chroot "$system" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"
    ' inside "$system" "${SLUICE_SHARED:-$SLUICE_ROOT/../shared}" "$@" </dev/null
}

if [ "$keep" = no ] || [ ! -d "$system/etc" ]; then
    title "Making a fresh $suite in $system"
    rm -rf "$system"
    make_system || die "debootstrap failed"
fi
copy_network_settings
clone

status=0
IFS=';' read -r -a list <<<"$commands"
for command in "${list[@]}"; do
    title "$suite: $command"
    SECONDS=0
    # From another folder than the checkout, because that must not matter.
    if inside bash -c "cd / && /root/check/sluice/$command"; then
        result="ended well"
    else
        result="failed" status=1
    fi
    say "$suite: $command $result after $SECONDS s"
done
[ "$keep" = yes ] || rm -rf "$system"
exit $status
