/* Plays a trace and prints the decisions: see --help and docs/replay.md. */
#include "expect.h"
#include "options.h"
#include "report.h"
#include "trace.h"

#include "../common/input.h"
#include "../common/output_file.h"
#include "../common/text.h"
#include "platform/host_memory.h"

#include <sluice/replay.h>

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Limits memory: a few bytes of a trace can request a texture of a billion tiles. */
struct limited_memory {
    uint64_t left;
};

static void *allocate(void *user, size_t size, size_t alignment)
{
    struct limited_memory *memory = user;
    if (size > memory->left || size > SIZE_MAX - alignment)
        return NULL;
    void *block = slc_host_allocate(size, alignment);
    if (block)
        memory->left -= size;
    return block;
}

static void release(void *user, void *block, size_t size)
{
    struct limited_memory *memory = user;
    memory->left += size;
    slc_host_free(block);
}

struct output {
    bool dump;
    struct expectation *expectation; ///< NULL: compare nothing
};

static void take_line(void *user, const char *line)
{
    const struct output *output = user;
    if (output->dump)
        puts(line);
    if (output->expectation)
        expectation_line(output->expectation, line);
}

static void log_message(void *user, SluiceLogSeverity severity, const char *message)
{
    if (severity >= SLUICE_LOG_WARNING)
        text_say("%s: %s", (const char *)user, message);
}

static SluiceResult replay(const struct options *o, const char *data, size_t size,
                           struct output *output, SluiceReplayResult *result,
                           SluiceStreamedTextureStatistics *statistics)
{
    size_t expected = output->expectation ? output->expectation->size : 0;
    struct limited_memory memory = {o->memory - expected - size};
    const SluiceAllocationCallbacks callbacks = {&memory, allocate, release};
    /* The log's user pointer is not const, but is only printed. */
    const SluiceReplayInfo info = {
        .structSize = sizeof info,
        .pData = data,
        .size = size,
        .pAllocator = &callbacks,
        .log = {(void *)(uintptr_t)o->trace, log_message},
        .pUserData = output,
        .pfnLine = output->dump || output->expectation ? take_line : NULL,
        .heapTileCapacity = o->heap_tiles,
        .maxHeapCount = o->max_heaps,
        .numExtraStandbyTiles = o->standby,
        .noStandbyTiles = o->standby == 0,
        .tilesPerFrame = o->tiles_per_frame,
        .latency = o->latency,
        .noLatency = o->latency == 0,
        .timeoutMicros = (uint64_t)(o->timeout * 1e6 + 0.5),
        .pRecordPath = o->record,
        .pStatistics = statistics,
    };
    return sluiceReplay(&info, result);
}

/* Does everything but close the expectation, which is the caller's. */
static bool run(const struct options *o, struct expectation *expectation)
{
    char *data;
    size_t size;
    size_t expected = expectation ? expectation->size : 0;
    if (!read_trace(o->trace, o->memory - expected, &data, &size))
        return false;
    struct output output = {o->dump, expectation};
    SluiceReplayResult result = {.structSize = sizeof result};
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    SluiceResult status = replay(o, data, size, &output, &result, &statistics);
    free(data);
    if (status != SLUICE_SUCCESS) {
        char where[32] = "";
        if (status == SLUICE_ERROR_CORRUPT_DATA)
            snprintf(where, sizeof where, " at byte %" PRIu64, result.errorOffset);
        text_say("sluice-replay: %s: %s%s after %" PRIu64 " events, hash %016" PRIx64, o->trace,
                 sluiceGetResultName(status), where, result.eventCount, result.decisionHash);
        if (expectation) /* the missing lines of the dump follow from this error */
            expectation->differs = true;
        return false;
    }
    if (o->json)
        print_json(&result, &statistics);
    else if (!o->dump)
        print_report(&result, &statistics);
    return result.divergedEvent == 0;
}

static bool record_spares_inputs(const struct options *o)
{
    return output_add_input(input_stream_path(o->trace)) &&
           (!o->expect || output_add_input(input_stream_path(o->expect))) &&
           (!o->record || output_spares_inputs(o->record));
}

int main(int argc, char **argv)
{
    struct options o;
    switch (parse_options(&o, argc, argv)) {
    case OPTIONS_RUN: break;
    case OPTIONS_HELP: return text_flush("sluice-replay: ") ? 0 : 1;
    case OPTIONS_ERROR: return 2;
    }
    struct expectation expectation;
    output_set_speaker("sluice-replay: ");
    if (!record_spares_inputs(&o))
        return 1;
    if (o.expect && !expectation_open(&expectation, o.expect, o.memory))
        return 1;
    bool good = run(&o, o.expect ? &expectation : NULL);
    if (o.expect && !expectation_close(&expectation))
        good = false;
    if (!text_flush("sluice-replay: "))
        good = false;
    return good ? 0 : 1;
}
