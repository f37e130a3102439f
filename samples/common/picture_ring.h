/** Ring of pictures: other threads write them while the next ones are traced. */
#ifndef SAMPLES_COMMON_PICTURE_RING_H
#define SAMPLES_COMMON_PICTURE_RING_H

#include <pthread.h>

#include "picture.h"

/** Writes a picture of a sequence. Reports errors on stderr and returns false. */
typedef bool (*picture_writer)(void *user_data, const struct picture *picture, uint32_t index);

/** A picture, and the thread that writes it. */
struct picture_slot {
    struct picture picture;
    uint32_t index; ///< in the sequence
    bool has_thread, done;
    pthread_t thread;
    picture_writer write;
    void *user_data;
};

/** Zeroed is empty. */
struct picture_ring {
    struct picture_slot *slots; ///< owned
    uint32_t count, next;
    bool failed;
};

/** Creates `count` pictures of a size. `plain`: see struct picture. Reports errors on stderr. */
bool picture_ring_create(uint32_t count, const uint32_t size[2], bool plain, picture_writer write,
                         void *user_data, struct picture_ring *ring);
/** Waits for all writers, then frees the pictures. */
void picture_ring_destroy(struct picture_ring *ring);

/** Returns the next picture to fill. Waits until its earlier contents are written. */
struct picture *picture_ring_next(struct picture_ring *ring);
/** Writes the picture that picture_ring_next returned. Returns false if an earlier one was not
 * written. */
bool picture_ring_write(struct picture_ring *ring, uint32_t index);
/** Waits for all writers. Returns false if a picture was not written. */
bool picture_ring_wait(struct picture_ring *ring);

#endif /* SAMPLES_COMMON_PICTURE_RING_H */
