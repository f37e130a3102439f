/*
 * Fuzz target for replays. The first byte says whether checksums are made right first, so that what
 * they protect is reached too; the rest is the trace. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/replay/fuzz_replay_libfuzzer
 *     BUILD/tests/replay/fuzz_replay_libfuzzer tests/fuzz/corpus/replay
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#include "replay/damage.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 1)
        return 0;
    uint8_t *copy = malloc(size); /* exactly sized, so that sanitizers see a read beyond the end */
    if (!copy)
        return 0;
    memcpy(copy, data + 1, size - 1);
    if (data[0] & 1)
        reseal_trace(copy, size - 1);
    SluiceReplayResult result = {.structSize = sizeof result};
    SluiceResult status = play_damaged(copy, size - 1, &result);
    if (status == SLUICE_ERROR_CORRUPT_DATA && result.errorOffset > size - 1)
        abort();
    /* Recordings of managers are played call by call, too, with the same outcome. */
    SluiceTracePlayerState state = {.structSize = sizeof state};
    SluiceResult by_calls = play_damaged_by_calls(copy, size - 1, &state);
    if (size > 8 && memcmp(copy, "SLUICERT", 8) == 0 && status != SLUICE_ERROR_OUT_OF_HOST_MEMORY &&
        by_calls != SLUICE_ERROR_OUT_OF_HOST_MEMORY &&
        (by_calls != status ||
         (state.eventCount > 0 &&
          (state.eventCount != result.eventCount || state.decisionHash != result.decisionHash))))
        abort();
    free(copy);
    return 0;
}
