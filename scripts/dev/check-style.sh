#!/usr/bin/env bash
# What a reader should never stumble over, checked on every tracked file. Prints TAP.
#
#   scripts/dev/check-style.sh
#
# Formatting is checked with clang-format 14 alone, because versions differ in what they write.

set -uo pipefail
shopt -s lastpipe # report counts, at the end of pipes
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1

# Without git (an unpacked archive) everything outside the build folders counts.
files() {
    if git rev-parse --git-dir >/dev/null 2>&1; then
        git ls-files -- "$@"
    else
        local pattern
        local -a names=()
        for pattern; do names+=(-o -path "./$pattern"); done
        find . -name '.git' -prune -o -path './build*' -prune -o -path './subprojects/*-[0-9]*' -prune -o -type f \( "${names[@]:1}" \) -print
    fi
}

text=('*.c' '*.h' '*.cpp' '*.hpp' '*.glsl' '*.comp' '*.vert' '*.frag' '*.build' '*.txt' '*.md' '*.sh' '*.py'
    '*.awk' '*.wrap' '*.supp' '*.ci/run' '*.csv')
code=('*.c' '*.h' '*.cpp' '*.hpp' '*.glsl' '*.comp' '*.vert' '*.frag' '*.build' '*.sh' '*.py' '*.awk' '*.ci/run')
number=0 status=0

# report FACT: what is wrong, one line each, is on stdin
report() {
    local found
    number=$((number + 1))
    found=$(head -n 40)
    if [ -z "$found" ]; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        printf '%s\n' "$found" | sed 's/^/# /'
        status=1
    fi
}

skipped() {
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}

# search PATTERN FILES...: where an extended regular expression occurs
search() {
    local pattern=$1
    shift
    files "$@" | tr '\n' '\0' | xargs -0 -r grep -n -I -E -e "$pattern" --
}

# A process per file takes ten minutes on a busy machine.
no_final_newline() {
    files "${text[@]}" | while IFS= read -r file; do
        [ ! -s "$file" ] || printf '%s\0' "$file"
    done | xargs -0 -r grep -L -z -P '\n\z' --
}

# A file imports another one of its folder if its source or its header includes that one's header.
import_circles() {
    local folder
    for folder; do
        files "lib/$folder/*.c" "lib/$folder/*.h" |
            xargs grep -H -o -E "#include \"$folder/[a-z0-9_]+" |
            sed -E "s,lib/$folder/([a-z0-9_]+)\.[ch]:#include \"$folder/,\\1 ," |
            awk '$1 != $2' | tsort 2>&1 >/dev/null | sed "s,^tsort:,lib/$folder:,"
    done
}

# Names with the prefix are unique in lib, and so are names of files. Other names belong to one file.
names_in_two_places() {
    files 'lib/*.c' 'lib/*.h' |
        xargs grep -H -o -E '^((struct|enum|union) slc_[a-z0-9_]+ \{|#define SLC_[A-Za-z0-9_]+)' |
        sed -E 's/ \{$//; s/^([^:]*):(.*)/\2 in \1/' | sort -u |
        awk '{ name = $1 " " $2 } name == last { print last_line; print } { last = name; last_line = $0 }' | sort -u
    files 'lib/*.c' 'lib/*.h' | sed 's,.*/,,' | sort | uniq -d
}

# Functions of lib that return INVALID_ARGUMENT themselves. slc_log_refusal says why; functions
# without a log are listed in silent_refusals.txt, with the reason.
unlisted_refusals() {
    local -a sources
    mapfile -t sources < <(files 'lib/*.c')
    diff <(awk '
        /^[A-Za-z].*\(/ { match($0, /[A-Za-z0-9_]+\(/); name = substr($0, RSTART, RLENGTH - 1) }
        /(return|[?:]|[^=!]=) SLUICE_ERROR_INVALID_ARGUMENT/ { print FILENAME, name }' "${sources[@]}" |
        sed 's,^\./,,' | sort -u) \
        <(sed -E '/^(#|$)/d; s/^([^ ]+ [^ ]+) .*/\1/' scripts/dev/silent_refusals.txt | sort -u) |
        sed -n 's/^< \(.*\)/\1: use slc_log_refusal/p; s/^> \(.*\)/\1: no longer there/p'
}

# Sources without comments and strings, which may hold anything, as FILE:NUMBER:TEXT. An attribute
# is dropped in an #if that asks for __GNUC__ and in a #define.
plain_code() {
    local -a sources
    mapfile -t sources < <(files "$@")
    awk '
        FNR == 1 { comment = 0; guarded = 0 }
        /^#if .*__GNUC__/ { guarded = 1 }
        /^#(else|endif)/ { guarded = 0 }
        {
            text = $0
            gsub(/"([^"\\]|\\.)*"/, "\"\"", text)
            gsub(/\/\*([^*]|\*[^\/])*\*\//, "", text)
            sub(/\/\/.*/, "", text)
            if (comment) { if (!sub(/^.*\*\//, "", text)) text = ""; else comment = 0 }
            if (sub(/\/\*.*/, "", text)) comment = 1
            if (guarded || text ~ /^ *# *define/) sub(/__attribute__ *\(\(.*\)\)/, "", text)
            if (text !~ /^ *$/) print FILENAME ":" FNR ":" text
        }' "${sources[@]}"
}

# What gcc and clang add to C11 and MSVC lacks. The compiler finds variable lengths (-Wvla) and
# arithmetic on void pointers (-Wpointer-arith). Vectors are used in the files that are named here.
gnu_constructs() {
    plain_code 'lib/*.c' 'lib/*.h' 'include/*.h' 'tools/*.c' 'tools/*.h' 'shaders/*.h' |
        grep -v -E '^(\./)?(lib/base/(bits|bytes)\.h|lib/bake/(block_fit|block_lanes)\.h|lib/bake/(blocks|columns)\.c|lib/metrics/window\.c|lib/neural/(strip\.h|strip_(inputs|network)\.c|decode_texels\.c)):' |
        grep -E -e ':.*(__attribute__|__builtin_|__extension__|__auto_type|__int128|__thread\b|__label__|__FUNCTION__)' \
            -e ':.*\b(typeof|__typeof__|__?asm__|alloca)\b' -e ':.*(\(\{|\?[[:blank:]]*:|#include_next|#warning|##__VA_ARGS__)' \
            -e ':.*(\[[^]]*[^].]\.\.\.[^]]*\] *=|case [^:]*\.\.\.)' -e ':.*([=,(] *\{ *\}|\)\{ *\})' \
            -e ':[[:blank:]]+(const )?((struct|unsigned|signed) )?[a-z_0-9]+ \**[a-z_0-9]+\[0\];'
}

echo 1..17
search $'\t' "${code[@]}" | report sources_hold_no_tabs
search '[[:blank:]]+$' "${text[@]}" | report lines_have_no_trailing_blanks
search $'\r' "${text[@]}" | report lines_end_with_a_newline_alone
no_final_newline | report files_end_with_a_newline
# The marks are written with a class so that this file does not find itself.
search '\b(TOD[O]|FIXM[E]|XX[X])\b' "${text[@]}" | report no_work_is_left_marked
search '(deb|archive|security|ports|snapshot|mirrors?|registry|proxy)\.[a-z0-9-]+\.(org|com|net|io|dev)\b' \
    "${text[@]}" | report no_package_mirror_is_named
search 'https?://' "${code[@]}" | grep -v -E '://(registry\.khronos\.org/|[a-z]+\.example/|[a-z:@]*127\.0\.0\.1:|([a-z:]*@)?h[:/"]|["%, ]|HOST\[)' |
    report code_names_no_host

search '\b(s?rand(om)?|rand_r|s?[delmnj]rand48|arc4random(_uniform|_buf)?)[[:blank:]]*\(|\bRAND_MAX\b' \
    '*.c' '*.cpp' '*.h' | report random_numbers_are_the_same_on_every_machine

import_circles residency core demand vulkan demand_vulkan | report files_of_a_folder_do_not_import_in_circles

# Words for which the field says retire, evict and restore. CHANGELOG.md may hold old names.
search '\b(bur[y]|burie[ds]|exhum[e]|ghos[t]s?|displac(e[ds]?|ing))\b' "${text[@]}" |
    grep -v '^CHANGELOG.md:' | report memory_is_retired_and_tiles_are_evicted

# lib/platform has one source for each operating system; what else is there is the same on all.
search '#include <(pthread|unistd|fcntl|dirent|process|io|windows|sys/[a-z]+)\.h>' 'lib/*.c' 'lib/*.h' 'lib/*.cpp' |
    grep -v '^lib/platform/' | report only_platform_calls_the_system

# The application may use the same queues on other threads: its lock is in queues.c.
search '->(QueueBindSparse|QueueSubmit2?|QueueWaitIdle|DeviceWaitIdle)[(]' 'lib/*.c' |
    grep -v '^lib/vulkan/queues.c:' | report queues_are_used_in_one_place

gnu_constructs | report sources_are_c11_without_gnu_constructs
names_in_two_places | report names_of_lib_are_unique
unlisted_refusals | report refused_arguments_are_logged

if command -v shellcheck >/dev/null; then
    files '*.sh' '*.ci/run' | tr '\n' '\0' | xargs -0 shellcheck -x 2>&1 | report scripts_pass_shellcheck
else
    skipped scripts_pass_shellcheck "shellcheck is not installed"
fi

formatter=$(command -v clang-format-14 || command -v clang-format || true)
if [ -n "$formatter" ] && "$formatter" --version | grep -q 'version 14\.'; then
    files '*.c' '*.h' '*.cpp' '*.hpp' | tr '\n' '\0' | xargs -0 "$formatter" --dry-run -Werror 2>&1 |
        sed -n 's/:.*error:.*//p' | sort | uniq -c | report sources_are_formatted
else
    skipped sources_are_formatted "clang-format 14 is not installed"
fi
exit $status
