# The stages of scripts/test.sh: each builds or checks something and adds its facts to one list.
# shellcheck shell=bash disable=SC2030,SC2031 # stages that run beside others have facts of their own

tests_folder=$SLUICE_BUILD/test
facts=$tests_folder/facts.tsv
collect() { python3 "$SLUICE_ROOT/scripts/lib/collect.py" "$@"; }

begin_stages() {
    mkdir -p "$tests_folder"
    : >"$facts"
    SECONDS=0
}

end_stages() {
    title "Result after $((SECONDS / 60)) min $((SECONDS % 60)) s"
    collect summary "$facts"
}

# print_extremes STAGE: how near the tests of extremes came to the bounds that they check.
print_extremes() {
    title "Extremes: the worst that was found, and its bound"
    collect extremes "$tests_folder/$1"
}

# fact STATUS STAGE TEST NAME REASON
fact() { (IFS=$'\t' && printf '%s\n' "$*") >>"$facts"; }

stage_title() { title "$1 ($((SECONDS / 60)):$(printf '%02d' $((SECONDS % 60))))"; }

# Empties the stage's own logs first, so that nothing of an earlier run is counted.
run_meson_tests() {
    local stage=$1 folder=$tests_folder/$1 before
    shift
    rm -rf "$folder/meson-logs/"testlog*
    before=$(wc -l <"$facts")
    # Huge pages: lavapipe's device memory is fresh memory, and page faults take a third of some tests.
    local -x GLIBC_TUNABLES=${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1}
    # Most device tests compile shaders for longer than they run them. Four lanes without LLVM's
    # optimizations halve that: decision 151.
    local -x LP_NATIVE_VECTOR_WIDTH=${LP_NATIVE_VECTOR_WIDTH:-128} GALLIVM_PERF=${GALLIVM_PERF:-nopt}
    # Lavapipe's cache does not tell widths apart, and code for eight lanes crashes beside code for four.
    local -x MESA_SHADER_CACHE_DIR=${MESA_SHADER_CACHE_DIR:-$SLUICE_BUILD/shaders-$LP_NATIVE_VECTOR_WIDTH}
    # It builds what Meson from 1.7 on leaves to it: what only tests need. Its exit status says nothing
    # that the facts do not say.
    ${disable_aslr:-} meson test -C "$folder" --num-processes "$(nproc)" "$@" \
        >"$folder.test.log" 2>&1 </dev/null || true
    collect meson "$stage" "$folder" >>"$facts"
    if [ "$(wc -l <"$facts")" -eq "$before" ]; then
        tail -n 30 "$folder.test.log"
        fact failed "$stage" tests "no test ran" "see $folder.test.log"
    fi
    tail -n +"$((before + 1))" "$facts" | cut -f 1 | sort | uniq -c
}

# test_options go to `meson test`. only_tests=yes builds what these tests need alone.
test_options=() only_tests=no

# build_stage STAGE NAME=VALUE... -- OPTIONS...: fails, with a fact, if it cannot be built.
build_stage() {
    local stage=$1 folder=$tests_folder/$1
    local -a settings=() targets=()
    shift
    while [ "$1" != -- ]; do
        settings+=("$1")
        shift
    done
    shift
    if ! (
        [ ${#settings[@]} -eq 0 ] || export "${settings[@]}"
        ! command -v ld.lld >/dev/null || export CC_LD=lld CXX_LD=lld
        # Stacks need lines; the rest of the debug information takes a fifth of the compiler's time.
        configure "$folder" --wrap-mode="$(wrap_mode test)" --werror -Dc_args=-g1 -Dcpp_args=-g1 "$@"
    ); then
        fact failed "$stage" configure "meson setup" "see $folder.setup.log"
        return 1
    fi
    if [ "$only_tests" = yes ]; then
        mapfile -t targets < <(python3 "$SLUICE_ROOT/scripts/lib/test_targets.py" "$folder" "${test_options[@]}")
    fi
    if ! compile "$folder" "${targets[@]}"; then
        fact failed "$stage" build "compiles without a warning" "see $folder.build.log"
        return 1
    fi
    fact passed "$stage" build "compiles without a warning" ""
}

# meson_stage STAGE NAME=VALUE... -- OPTIONS...
meson_stage() {
    stage_title "$1"
    if build_stage "$@"; then
        run_meson_tests "$1" "${test_options[@]}"
    fi
}

# Whether a program made with this sanitizer runs at all: leak checking needs ptrace, and some
# kernels place memory where an older runtime does not expect it.
sanitizer_works() {
    local program=$tests_folder/probe-$1
    printf '%s\n' 'int main(void) { return 0; }' >"$program.c"
    clang -fsanitize="$1" "$program.c" -o "$program" >"$program.log" 2>&1 || return 1
    ${disable_aslr:-} "$program" >>"$program.log" 2>&1
}

# sanitizer_stage STAGE SETUP SANITIZERS OPTIONS...
sanitizer_stage() {
    local stage=$1 sanitizers=$3 disable_aslr='' only_tests=yes
    local -a test_options=(--setup "$2")
    shift 3
    stage_title "$stage"
    if ! sanitizer_works "$sanitizers"; then
        if disable_aslr='setarch -R' && sanitizer_works "$sanitizers"; then
            say "This kernel's address layout does not suit the sanitizer; running without randomization."
        elif disable_aslr='' && ASAN_OPTIONS=detect_leaks=0 sanitizer_works "$sanitizers"; then
            say "Leaks cannot be looked for here (no ptrace); everything else is checked."
            local -x ASAN_OPTIONS=detect_leaks=0
        else
            cat "$tests_folder/probe-$sanitizers.log"
            fact skipped "$stage" "$sanitizers" "all of it" "no program made with this sanitizer runs here"
            return 0
        fi
    fi
    if build_stage "$stage" CC=clang CXX=clang++ -- "-Db_sanitize=$sanitizers" -Db_lundef=false "$@"; then
        run_meson_tests "$stage" --no-rebuild "${test_options[@]}"
    fi
}

# beside NAME COMMAND...: runs stages of one processor beside the next stage, until await_stages NAME prints
# their output and adds their facts.
beside() {
    local name=$1
    shift
    : >"$facts.$name"
    (facts=$facts.$name && "$@") >"$tests_folder/$name.out" 2>&1 </dev/null &
    declare -g "job_$name=$!"
}

await_stages() {
    local job=job_$1
    wait "${!job}" || fact failed "$1" "$1" "ended with an error"
    cat "$tests_folder/$1.out"
    cat "$facts.$1" >>"$facts"
}

# tap_stage STAGE PROGRAM: the program prints TAP, and finds the gcc build in $SLUICE_BUILD/test/gcc.
tap_stage() {
    local log=$tests_folder/$1.log status=0
    stage_title "$1"
    SLUICE_BUILD=$SLUICE_BUILD "$SLUICE_ROOT/$2" >"$log" 2>&1 </dev/null || status=$?
    collect tap "$1" "$2" "$log" "$status" >>"$facts"
    grep -v '^ok ' "$log" || true
}
