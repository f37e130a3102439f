/*
 * Bytes decide what is called; the manager and the naive one must agree after every call. With
 * clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/core/fuzz_manager_libfuzzer
 *     BUILD/tests/core/fuzz_manager_libfuzzer -max_len=1500 tests/fuzz/corpus/manager
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#include "core/differential.h"

#include <stdlib.h>

#define MAX_CALLS 400u

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t nothing = 0;
    const struct choice choice = {.bytes = size ? data : &nothing, .size = size};
    const char *message;
    struct differential *d = differential_create();
    if (differential_run(d, choice, MAX_CALLS, NULL, &message) < 0) {
        differential_run(d, choice, MAX_CALLS, stderr, &message); /* again, for the log */
        fprintf(stderr, "%s\n", message);
        abort();
    }
    differential_destroy(d);
    return 0;
}
