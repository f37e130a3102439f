#include "core_time.h"

#include <sluice/replay.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "../common/clock.h"
#include "../sluice-replay/file.h"

#define PLAYS 5
#define LONG_ENOUGH 1.0 ///< seconds after which no further play begins

/** Counts of calls that a frame makes at most once. */
struct calls {
    double retire, map;
};

/* Counts lines like "17 get-tiles-to-map ...". */
static void count_call(void *user, const char *line)
{
    static const char retire[] = " complete-retire", map[] = " get-tiles-to-map";
    struct calls *calls = user;
    const char *word = strchr(line, ' ');
    if (word && strncmp(word, retire, sizeof retire - 1) == 0)
        calls->retire++;
    if (word && strncmp(word, map, sizeof map - 1) == 0)
        calls->map++;
}

static bool play(const SluiceReplayInfo *info, double *seconds)
{
    SluiceReplayResult result = {.structSize = sizeof result};
    double began = clock_seconds();
    if (sluiceReplay(info, &result) != SLUICE_SUCCESS || result.divergedEvent != 0)
        return false;
    *seconds = fmin(*seconds, clock_seconds() - began);
    return true;
}

double core_time_count_frames(const char *data, size_t size)
{
    struct calls calls = {0};
    double seconds = NAN;
    const SluiceReplayInfo info = {.structSize = sizeof info,
                                   .pData = data,
                                   .size = size,
                                   .pUserData = &calls,
                                   .pfnLine = count_call};
    return play(&info, &seconds) ? fmax(calls.retire, calls.map) : 0.0;
}

double core_time_per_frame(const char *trace_path)
{
    char *data;
    size_t size;
    double start = clock_seconds(), best = NAN;
    if (!read_file(trace_path, &data, &size))
        return NAN;
    const SluiceReplayInfo info = {.structSize = sizeof info, .pData = data, .size = size};
    double frame_count = core_time_count_frames(data, size);
    bool played = frame_count > 0.0;
    for (int i = 0; i < PLAYS && played && clock_seconds() - start < LONG_ENOUGH; i++)
        played = play(&info, &best);
    free(data);
    return played ? 1e6 * best / frame_count : NAN;
}
