/**
 * A user of a demand residency that makes each of its calls at random: memory in chunks, resources
 * without places, reads that fail, and host memory that runs out now and then.
 */
#ifndef TESTS_REPLAY_DEMAND_APP_H
#define TESTS_REPLAY_DEMAND_APP_H

#include "demand/fake_memory.h"
#include "random_app.h"

enum { DEMAND_APP_PAGES = 64, DEMAND_APP_CLASSES = 3 };

struct demand_app {
    struct slc_demand_residency *residency;
    struct fake_memory memory[DEMAND_APP_CLASSES]; ///< class 1 has none
    struct failing_allocator allocator;
    uint64_t random, launch, prepared, value;
    bool starved, loading[DEMAND_APP_PAGES];
    uint32_t out_of_memory_count;
};

/** `starved`: host memory runs out now and then. */
void demand_app_init(struct demand_app *app, uint64_t seed, bool starved);
void demand_app_finish(struct demand_app *app);
void demand_app_run(struct demand_app *app, uint32_t steps);

/** Records `steps` random steps. */
void record_demand_run(struct trace_buffer *buffer, uint64_t seed, uint32_t steps, bool starved);

#endif /* TESTS_REPLAY_DEMAND_APP_H */
