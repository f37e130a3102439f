/** A loader for a source with injected faults. Records the failures. */
#ifndef TESTS_IMAGE_LOADER_FIXTURE_H
#define TESTS_IMAGE_LOADER_FIXTURE_H

#include <sluice/loader.h>

#include "support/fault_source.h"

/** The source's image has 64 x 64 texels of R32_SFLOAT with the value 100000 level + width y +
 * x. */
enum { FIXTURE_SIZE = 64, MAX_FAILURES = 16 };

struct loader_fixture {
    SluiceImageSource *inner;
    struct fault_source source; ///< named "fault test"
    SluiceTileLoader *loader;
    pthread_mutex_t mutex; ///< guards all fields below
    uint32_t failure_count;
    SluiceTileReadFailure failures[MAX_FAILURES];
    bool cancels;
    uint64_t ticket; ///< ticket to cancel if `cancels`
};

/** Initializes with one thread and minimal delays, unless `create` sets others. */
void fixture_init(struct loader_fixture *f, SluiceTileLoaderCreateInfo create);
void fixture_finish(struct loader_fixture *f);

/** Replaces the loader. */
void fixture_replace_loader(struct loader_fixture *f, const SluiceTileLoaderCreateInfo *create);

/** Reads the texel (x, 0) of level 0 into a float. Returns the ticket. */
uint64_t fixture_submit(struct loader_fixture *f, struct fault_source *source, uint32_t x,
                        float *texel, uint32_t priority);

/** Waits for the next result and returns it. */
SluiceTileReadResult fixture_collect(struct loader_fixture *f);

/** Returns the statistics of a source. NULL: of all sources. */
SluiceTileLoaderStatistics fixture_statistics(struct loader_fixture *f,
                                              const struct fault_source *source);

#endif /* TESTS_IMAGE_LOADER_FIXTURE_H */
