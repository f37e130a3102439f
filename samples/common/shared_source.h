/**
 * An image source that several loaders use: opened for the first of them, destroyed after the last.
 * All loaders get one pointer, so a SluiceReadPool reads each tile of it once.
 */
#ifndef SAMPLES_COMMON_SHARED_SOURCE_H
#define SAMPLES_COMMON_SHARED_SOURCE_H

#include <pthread.h>
#include <sluice/image.h>

#include <stdbool.h>

struct shared_source {
    pthread_mutex_t mutex; ///< Guards `source` and `user_count`. Held while `open` runs.
    SluiceImageSource *source;
    uint32_t user_count;
    SluiceResult (*open)(void *user_data, SluiceImageSource **source);
    void *user_data; ///< Argument of `open`.
};

/** Returns false when out of memory. */
bool shared_source_init(struct shared_source *shared,
                        SluiceResult (*open)(void *user_data, SluiceImageSource **source),
                        void *user_data);
/** Call after all loaders that use it are destroyed. */
void shared_source_finish(struct shared_source *shared);

/** pfnOpen of a SluiceDemandImage whose pUserData is a struct shared_source. Any thread. */
SluiceResult shared_source_open(void *shared, SluiceImageSource **source);
/** pfnClose of the same image. Any thread. */
void shared_source_close(void *shared, SluiceImageSource *source);

#endif /* SAMPLES_COMMON_SHARED_SOURCE_H */
