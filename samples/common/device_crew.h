/** Devices of a sample that trace the pictures of a run together. */
#ifndef SAMPLES_COMMON_DEVICE_CREW_H
#define SAMPLES_COMMON_DEVICE_CREW_H

#include <stdatomic.h>

#include "../../tools/common/device_list.h"
#include "film.h"
#include "picture_ring.h"
#include "split.h"

/** Callbacks of a sample. Each reports its errors on stderr. */
struct device_crew_calls {
    /** Creates a device. `name`: as in --device. `*exists`: the device must be destroyed, even if
     * the call returns false. Device 0 is created first. */
    bool (*create)(void *user_data, uint32_t device, const char *name, bool *exists);
    /** Traces the device's share of picture `index` into `picture`. On a thread of the device. */
    bool (*trace)(void *user_data, uint32_t device, uint32_t index, struct picture *picture);
    /** Writes a picture, on a thread of the picture. */
    picture_writer write;
};

/** Set the fields up to the first empty line, and zero the rest. */
struct device_crew {
    const struct device_crew_calls *calls;
    void *user_data;
    enum split split;
    uint32_t first_picture, end_of_pictures; ///< range; the end is exclusive
    uint32_t size[2];                        ///< size of each picture in pixels
    bool plain;                              ///< `plain` of each struct picture

    uint32_t device_count;    ///< number of created devices
    struct picture_ring ring; ///< pictures that all devices trace together
    struct picture *picture;  ///< the one being traced, or traced last
    uint32_t index;           ///< index of `picture`
    atomic_uint next_picture; ///< next picture for any device to take
    atomic_bool ends;         ///< true: a device failed; the others may stop early
};

/** Creates `device` (as in --device), or the devices of the list if it is not empty. `first`: GPU
 * of device 0, zeroed before. `*none`: no device matches the list. */
bool device_crew_create(struct device_crew *crew, const struct device_list *list,
                        const char *device, const struct gpu *first, bool *none);
/** Returns the share of each picture that a device traces. */
struct film_share device_crew_share(const struct device_crew *crew, uint32_t device);
/** Creates the pictures that all devices trace. Reports errors on stderr. */
bool device_crew_create_pictures(struct device_crew *crew);
/** Waits for pictures that are being written, and frees them. Accepts a zeroed struct. */
void device_crew_finish(struct device_crew *crew);

/** Traces all pictures, and waits until they are written. */
bool device_crew_trace(struct device_crew *crew);

#endif /* SAMPLES_COMMON_DEVICE_CREW_H */
