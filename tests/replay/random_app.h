/**
 * An application that makes random calls: sensible, careless and wrong ones. Its heap allocator
 * sometimes refuses, and host memory sometimes runs out.
 */
#ifndef TESTS_REPLAY_RANDOM_APP_H
#define TESTS_REPLAY_RANDOM_APP_H

#include "support/failing_allocator.h"

#include <sluice/replay.h>

#define RANDOM_APP_TEXTURES 12
#define RANDOM_APP_LOADS 4096
#define RANDOM_APP_HEAPS 8

struct random_app {
    uint64_t seed;
    bool starved; ///< true: host memory sometimes runs out
    struct failing_allocator memory;
    SluiceStreamedTextureManager *manager;
    SluiceTextureId ids[RANDOM_APP_TEXTURES]; ///< living and removed textures
    uint32_t id_count;
    struct {
        SluiceTextureId id;
        uint32_t tile;
    } loads[RANDOM_APP_LOADS]; ///< handed-out loads
    uint32_t load_count;
    bool heap_lives[RANDOM_APP_HEAPS];
    uint64_t time, retire, completed;
    uint64_t kinds_made; ///< a bit per kind of call
    uint64_t kinds_good; ///< a bit per kind that has succeeded
    uint32_t out_of_memory_count, refused_heap_count;
};

/** Initializes with small heaps, so that budgets matter. The app owns the manager. */
void random_app_init(struct random_app *app, uint64_t seed, bool starved);
void random_app_finish(struct random_app *app);

void random_app_run(struct random_app *app, uint32_t steps);

uint32_t random_app_below(struct random_app *app, uint32_t limit);

/** Compares all counts and totals, but not the bytes of host memory. */
void check_same_statistics(const SluiceStreamedTextureManager *manager,
                           const SluiceStreamedTextureStatistics *expected);

/** Bytes in memory, for a SluiceRecordWriter. */
struct trace_buffer {
    uint8_t *data; ///< owned
    size_t size, capacity;
    size_t full_at; ///< writes beyond this size fail with IO
};

SluiceRecordWriter trace_buffer_writer(struct trace_buffer *buffer);
void trace_buffer_free(struct trace_buffer *buffer);

/** Records `steps` random steps. */
void record_random_run(struct trace_buffer *buffer, uint64_t seed, uint32_t steps, bool starved);

/** Records `steps` random steps after `before` others. */
void record_late_run(struct trace_buffer *buffer, uint64_t seed, uint32_t before, uint32_t steps);

#endif /* TESTS_REPLAY_RANDOM_APP_H */
