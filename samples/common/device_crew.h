/** Devices of a sample that trace the pictures of a run together. */
#ifndef SAMPLES_COMMON_DEVICE_CREW_H
#define SAMPLES_COMMON_DEVICE_CREW_H

#include <stdatomic.h>

#include "../../tools/common/device_list.h"
#include "film.h"
#include "picture_ring.h"
#include "split.h"

/** Parts that each sample has for itself. Each says on stderr why it failed. */
struct device_crew_calls {
    /** Creates a device. `name`: as in --device. `*exists`: it is to be destroyed, even if false is
     *  returned. The first device is created first. */
    bool (*create)(void *user_data, uint32_t device, const char *name, bool *exists);
    /** Traces the device's share of picture `index` into `picture`. On a thread of the device. */
    bool (*trace)(void *user_data, uint32_t device, uint32_t index, struct picture *picture);
    /** On a thread of the picture. */
    picture_writer write;
};

/** Set up to the first empty line; the rest is zeroed at first. */
struct device_crew {
    const struct device_crew_calls *calls;
    void *user_data;
    enum split split;
    uint32_t first_picture, end_of_pictures; ///< behind the last one
    uint32_t size[2];                        ///< of each picture
    bool plain;                              ///< as in struct picture

    uint32_t device_count;    ///< that exist
    struct picture_ring ring; ///< of pictures that all devices trace
    struct picture *picture;  ///< ... the one that they trace, or traced last
    uint32_t index;           ///< of this picture
    atomic_uint next_picture; ///< that devices take in turn
    atomic_bool ends;         ///< a device failed: the others may end early
};

/** Creates `device` (as in --device), or the devices of the list if it has some. `first`: of
 *  device 0, zeroed at first. `*none`: no device fits the list. */
bool device_crew_create(struct device_crew *crew, const struct device_list *list,
                        const char *device, const struct gpu *first, bool *none);
/** The part of each picture that a device traces. */
struct film_share device_crew_share(const struct device_crew *crew, uint32_t device);
/** Creates pictures that all devices trace. Says on stderr why it failed. */
bool device_crew_create_pictures(struct device_crew *crew);
/** Waits for pictures that are being written, and frees them. A zeroed one is fine. */
void device_crew_finish(struct device_crew *crew);

/** Traces all pictures, and waits until they are written. */
bool device_crew_trace(struct device_crew *crew);

#endif /* SAMPLES_COMMON_DEVICE_CREW_H */
