/** A loader over a source that tests can break, its failures noted. */
#ifndef TESTS_IMAGE_LOADER_FIXTURE_H
#define TESTS_IMAGE_LOADER_FIXTURE_H

#include <sluice/loader.h>

#include "support/fault_source.h"

/** The source's image has 64 x 64 texels of R32_SFLOAT: 100000 level + width y + x. */
enum { FIXTURE_SIZE = 64, MAX_FAILURES = 16 };

struct loader_fixture {
    SluiceImageSource *inner;
    struct fault_source source; ///< named "fault test"
    SluiceTileLoader *loader;
    pthread_mutex_t mutex; ///< around what follows
    uint32_t failure_count;
    SluiceTileReadFailure failures[MAX_FAILURES];
    bool cancels;
    uint64_t ticket; ///< what is canceled then
};

/** One thread and delays that are no delays, unless `create` says otherwise. */
void fixture_init(struct loader_fixture *f, SluiceTileLoaderCreateInfo create);
void fixture_finish(struct loader_fixture *f);

/** Another loader instead of the one there is. */
void fixture_replace_loader(struct loader_fixture *f, const SluiceTileLoaderCreateInfo *create);

/** A read of the texel (x, 0) of level 0, whose value it gets; the ticket. */
uint64_t fixture_submit(struct loader_fixture *f, struct fault_source *source, uint32_t x,
                        float *texel, uint32_t priority);

/** Waits for the next result. */
SluiceTileReadResult fixture_collect(struct loader_fixture *f);

/** Of a source, NULL: of all. */
SluiceTileLoaderStatistics fixture_statistics(struct loader_fixture *f,
                                              const struct fault_source *source);

#endif /* TESTS_IMAGE_LOADER_FIXTURE_H */
