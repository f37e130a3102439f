#include "core_time.h"

#include <sluice/replay.h>

#include <math.h>
#include <stdlib.h>

#include "../../samples/common/clock.h"
#include "../sluice-replay/file.h"

#define PLAYS 5
#define LONG_ENOUGH 1.0 ///< seconds; no further play begins after them

double core_time_per_frame(const char *trace_path, double frame_count)
{
    char *data;
    size_t size;
    double start = clock_seconds(), best = NAN;
    if (!(frame_count >= 1.0) || !read_file(trace_path, &data, &size))
        return NAN;
    for (int i = 0; i < PLAYS && clock_seconds() - start < LONG_ENOUGH; i++) {
        const SluiceReplayInfo info = {.pData = data, .size = size};
        SluiceReplayResult result;
        double began = clock_seconds();
        if (sluiceReplay(&info, &result) != SLUICE_SUCCESS || result.divergedEvent != 0) {
            best = NAN;
            break;
        }
        best = fmin(best, clock_seconds() - began);
    }
    free(data);
    return 1e6 * best / frame_count;
}
