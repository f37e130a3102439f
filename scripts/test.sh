#!/usr/bin/env bash
# Installs what is missing, then builds Sluice in every way that matters and runs all tests.
#
#   scripts/test.sh [options]
#
#   --quick        only the gcc build, its tests but for the long ones, and the style check
#   --cross        run every test of Windows, aarch64 and s390x (Wine, qemu-user), and compile all for macOS;
#                  without it only recorded decisions, files and byte order are tested there
#   --no-install   install nothing; say what is missing
#   --clean        throw away earlier test builds first
#   --help
#
# Runs on a fresh Debian 12, Debian 13 or Ubuntu 24.04, as root or with sudo (root is needed only if
# something is missing), and asks nothing. The last line is `N passed, N failed, N skipped`; the
# exit status is 0 if nothing failed.
#
# Environment: SLUICE_BUILD       folder for everything that is built (default: build)
#              SLUICE_TEST_DATA   sample files (default: ../shared/data beside the checkout, if there)
#              VK_DRIVER_FILES    the Vulkan drivers to test on (default: lavapipe alone)

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for part in common packages mesa build stages cross; do
    # shellcheck source=/dev/null
    . "$here/lib/$part.sh"
done

install=yes quick=no clean=no cross=no
while [ $# -gt 0 ]; do
    case $1 in
    --quick) quick=yes ;;
    --cross) cross=yes ;;
    --no-install) install=no ;;
    --clean) clean=yes ;;
    --help) usage_of "$0"; exit 0 ;;
    *) die "unknown option $1 (see --help)" ;;
    esac
    shift
done
trap give_back_build EXIT

ensure_packages test "$install"
forget_display
select_lavapipe
[ "$clean" = no ] || rm -rf "$SLUICE_BUILD/test"
begin_stages

suite_of_other_systems=''
if [ "$cross" = yes ]; then
    suite_of_other_systems=cross
elif [ "$quick" = no ]; then
    suite_of_other_systems='cross-quick'
fi
[ -z "$suite_of_other_systems" ] || beside cross_tools get_cross_tools "$install"

# As users get it, and everything that is not about the build: headers, packages, examples, device.
# shellcheck disable=SC2034 # read by meson_stage
test_options=(--no-suite short --no-suite rare)
if [ "$quick" = yes ]; then
    for suite in bench dense pictures samples slow twin; do
        test_options+=(--no-suite "$suite")
    done
fi
meson_stage gcc CC=gcc CXX=g++ -- -Dbuildtype=debugoptimized -Ddefault_library=both
if [ "$quick" = yes ]; then
    tap_stage style scripts/dev/check-style.sh
else
    # Both run on one processor for most of their time, so the next stage has the other one.
    style_and_consumer() { tap_stage style scripts/dev/check-style.sh && tap_stage consumer tests/consumer/run.sh; }
    beside style_and_consumer style_and_consumer
    # The library, its tools and its tests; CONTRIBUTING.md says how samples are looked at.
    sanitizer_stage clang-sanitizers sanitize address,undefined -Dbuildtype=debugoptimized -Ddefault_library=static -Dsamples=disabled -Dviewer=disabled
    await_stages style_and_consumer
    sanitizer_stage clang-threads tsan thread -Dbuildtype=debugoptimized -Ddefault_library=static -Dsamples=disabled -Dviewer=disabled -Dpbrt=disabled -Dneural=disabled

    # Every feature off, as a static library; replays must decide the same as with -O2 of gcc and of
    # clang. What is slow has run twice by now and depends on none of this, nor do scripts and reports.
    # shellcheck disable=SC2034 # read by meson_stage
    test_options=(--no-suite slow --no-suite short --no-suite rare --no-suite samples --no-suite scripts --no-suite tradeoff)
    off='-Dexr=disabled -Dcontainer=disabled -Dzstd=disabled -Dstore=disabled -Dbake=disabled -Dvulkan=disabled -Dsamples=disabled -Dviewer=disabled -Dhttp=disabled -Dneural=disabled -Dpbrt=disabled'
    # shellcheck disable=SC2086 # a list of words
    meson_stage gcc-O3-static CC=gcc -- $off -Doptimization=3 -Ddefault_library=static
fi

if [ -n "$suite_of_other_systems" ]; then
    await_stages cross_tools
    cross_stages "$suite_of_other_systems"
fi
print_extremes gcc
end_stages
