#include "core_time.h"

#include <sluice/replay.h>

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "../../samples/common/clock.h"
#include "../sluice-replay/file.h"

#define PLAYS 5
#define LONG_ENOUGH 1.0 ///< seconds; no further play begins after them

/* "17 get-tiles-to-map ..." */
static void count_frame(void *user, const char *line)
{
    static const char call[] = " get-tiles-to-map";
    const char *word = strchr(line, ' ');
    if (word && strncmp(word, call, sizeof call - 1) == 0)
        ++*(double *)user;
}

static bool play(const SluiceReplayInfo *info, double *seconds)
{
    SluiceReplayResult result;
    double began = clock_seconds();
    if (sluiceReplay(info, &result) != SLUICE_SUCCESS || result.divergedEvent != 0)
        return false;
    *seconds = fmin(*seconds, clock_seconds() - began);
    return true;
}

double core_time_per_frame(const char *trace_path)
{
    char *data;
    size_t size;
    double start = clock_seconds(), best = NAN, counting = NAN, frame_count = 0.0;
    if (!read_file(trace_path, &data, &size))
        return NAN;
    SluiceReplayInfo info = {
        .pData = data, .size = size, .pUserData = &frame_count, .pfnLine = count_frame};
    bool played = play(&info, &counting);
    info.pfnLine = NULL;
    for (int i = 0; i < PLAYS && played && clock_seconds() - start < LONG_ENOUGH; i++)
        played = play(&info, &best);
    free(data);
    return played && frame_count > 0.0 ? 1e6 * best / frame_count : NAN;
}
