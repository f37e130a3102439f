# Mesa's lavapipe is the Vulkan device that every machine has. Sparse residency came to it late, so
# an older Mesa is replaced from the distribution's own later suite.
# shellcheck shell=bash

mesa_wanted=25.0 # 25.0.7 is the oldest version whose sparse residency was measured

mesa_version() { dpkg-query -W -f='${source:Upstream-Version}' mesa-vulkan-drivers 2>/dev/null; }

mesa_is_recent() {
    local version
    version=$(mesa_version)
    [ -n "$version" ] && dpkg --compare-versions "$version" ge "$mesa_wanted"
}

mesa_give_up() {
    warn "Mesa $(mesa_version) has no sparse residency and a later one cannot be had ($1):" \
        "tests that need it are skipped, the demo needs another device"
}

# The suite of this distribution that has a later Mesa, and which of its components are needed: the
# machine's own, or what fits together with a later libllvm, which Mesa brings and clang shares.
mesa_later_suite() {
    # shellcheck disable=SC2154 # both from read_distribution
    case $distribution in
    debian) suite=$codename-backports components='' ;;
    ubuntu) suite=$codename-updates components='main universe' ;;
    *) return 1 ;;
    esac
}

# ensure_mesa INSTALL
ensure_mesa() {
    local suite components
    mesa_is_recent && return 0
    [ "$1" = no ] && { mesa_give_up "nothing may be installed"; return 0; }
    mesa_later_suite || { mesa_give_up "no later suite known for $distribution"; return 0; }
    become_root || { mesa_give_up "run as root or with sudo to install it"; return 0; }

    title "Mesa $(mesa_version) has no sparse residency: taking a later one from $suite"
    if ! distribution_targets | grep -q "|$suite|"; then
        add_suite "$suite" "$codename" "$suite" "$components" || { mesa_give_up "no source to derive $suite from"; return 0; }
        apt_update
    fi
    if ! distribution_targets | grep -q "|$suite|"; then
        remove_suite "$suite"
        mesa_give_up "the mirror has no $suite"
        return 0
    fi
    apt_install apt-mesa -t "$suite" mesa-vulkan-drivers || true
    mesa_is_recent || { mesa_give_up "installing from $suite failed"; return 0; }
    say "Mesa is $(mesa_version) now."
}

# Joined by colons: there may be one per architecture, and the loader passes over the foreign ones.
lavapipe_icds() {
    local file list=''
    for file in /usr/share/vulkan/icd.d/lvp_icd*.json /etc/vulkan/icd.d/lvp_icd*.json; do
        [ -f "$file" ] && list=$list${list:+:}$file
    done
    [ -n "$list" ] && say "$list"
}

has_gpu() {
    local node
    for node in /dev/dri/renderD* /dev/nvidia[0-9]* /dev/dxg; do
        [ -e "$node" ] && return 0
    done
    return 1
}

# Both names, because loaders before 1.3.207 know only the old one. The user's choice comes first.
select_lavapipe() {
    local icd
    [ -z "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] || return 0
    icd=$(lavapipe_icds) || { warn "no lavapipe here"; return 0; }
    export VK_DRIVER_FILES=$icd VK_ICD_FILENAMES=$icd
}

# Nothing is shown on a display; without these Mesa's layers do not even look for one.
forget_display() { unset DISPLAY WAYLAND_DISPLAY; }
