/**
 * Queue of tiles and pages that their producers must write again, in place
 * (docs/decisions/0079-produced-tiles-are-remade-in-place.md). A key stays from the report of a
 * change until commands that write it are recorded. So each is written once, however often it
 * changes meanwhile.
 */
#ifndef SLC_VULKAN_REMAKES_H
#define SLC_VULKAN_REMAKES_H

#include "base/log.h"
#include "base/map.h"

#include <sluice/image.h>

struct slc_remakes {
    const SluiceAllocationCallbacks *cb; ///< borrowed
    struct slc_map keys;
    uint64_t *queue; ///< owned ring
    uint32_t first, count, capacity;
    uint32_t spare; ///< keys that were taken and may come back
};

/** `spare`: most keys that are taken at a time. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_remakes_init(struct slc_remakes *remakes, const SluiceAllocationCallbacks *cb,
                              uint32_t spare);
/** Frees the queue. It may be zeroed. */
void slc_remakes_finish(struct slc_remakes *remakes);
/** Makes room for `count` calls of slc_remakes_add. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_remakes_reserve(struct slc_remakes *remakes, uint32_t count);
/** Puts a key into the queue unless it is there or taken. Needs slc_remakes_reserve. */
void slc_remakes_add(struct slc_remakes *remakes, uint64_t key);
/** Takes the first key of the queue, which must not be empty. End it with one of the next two. */
uint64_t slc_remakes_take(struct slc_remakes *remakes);
/** Puts a taken key at the end of the queue. */
void slc_remakes_put_back(struct slc_remakes *remakes, uint64_t key);
/** Removes a taken key. */
void slc_remakes_end(struct slc_remakes *remakes, uint64_t key);
/** Takes a removed key again. Returns false if the key is in the queue, or taken. */
bool slc_remakes_retake(struct slc_remakes *remakes, uint64_t key);
/** Removes keys of the queue for which `drop` returns true. */
void slc_remakes_drop(struct slc_remakes *remakes, bool (*drop)(void *user, uint64_t key),
                      void *user);

/** Texels that have changed: a rectangle of a level, and the texels over it in coarser levels.
 */
struct slc_remake_area {
    uint32_t width, height; ///< size of the texture
    SluiceImageRegion region;
    uint32_t end_level;
};

/** Reads the arguments of a call. `region`: NULL for all texels. `level_count` counts from the
 *  region's level. `name` is the function's. Errors, logged: INVALID_ARGUMENT. */
SluiceResult slc_remake_area_read(struct slc_remake_area *area, const SluiceImageInfo *info,
                                  const SluiceImageRegion *region, uint32_t level_count,
                                  const char *name, const SluiceLogCallback *log);
/** Tiles of a level from x and y on, up to end_x and end_y. None: end_x is x. */
struct slc_remake_tiles {
    uint32_t x, y, end_x, end_y;
};
struct slc_remake_tiles slc_remake_tiles(const struct slc_remake_area *area, uint32_t level,
                                         uint32_t tile_width, uint32_t tile_height);
/** True if texels of a level from `first` on changed. */
bool slc_remake_meets_tail(const struct slc_remake_area *area, uint32_t first);
/** Number of tiles of levels below `regular_count`, and the mip tail. */
uint64_t slc_remake_count(const struct slc_remake_area *area, uint32_t regular_count,
                          uint32_t tile_width, uint32_t tile_height);

#endif /* SLC_VULKAN_REMAKES_H */
