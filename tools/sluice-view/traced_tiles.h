/** Tiles of a demand loader: slots, load times and numbers of loads. */
#ifndef SLUICE_VIEW_TRACED_TILES_H
#define SLUICE_VIEW_TRACED_TILES_H

#include <sluice/demand_query.h>

#include <stdbool.h>
#include <stdint.h>

#define TRACED_TILE_MOST 262144u ///< tiles that are listed: 16 GiB
#define TRACED_TILE_THRASHES 3u  ///< loads within TRACED_TILE_WINDOW
#define TRACED_TILE_WINDOW 10000000u

struct traced_tile {
    SluiceDemandSlot slot; ///< slot at the last look; page UINT32_MAX: the entry has no tile
    bool here;             ///< the tile has a slot
    uint64_t
        loaded[TRACED_TILE_THRASHES]; ///< last load times in microseconds, newest first; 0: never
    uint32_t loads;
};

/** Zeroed is empty. */
struct traced_tiles {
    struct traced_tile *entries; ///< owned; hash map by page
    uint32_t capacity;           ///< a power of two, at least twice the entries; 0: no look so far
    SluiceDemandSlot *slots;     ///< owned; slots at the last look
    uint32_t slot_count, slot_room;
    SluiceDemandSlotImage *images; ///< owned, as the next two
    uint32_t *first_slots;         ///< first slot of each image, in `by_slot`
    uint32_t *by_slot;             ///< 1 + index into `slots`; 0: free, or not listed
    uint32_t image_count;
    uint64_t next_look; ///< frame of the next look
    uint64_t seen[4];   ///< figures of the loader at the last look
    bool is_cut;        ///< more tiles exist than are listed
};

void traced_tiles_finish(struct traced_tiles *tiles);
/** Reads the loader's slots if its figures have changed. Reads many slots less often. `now`:
 *  microseconds. Without memory the last look stays. */
void traced_tiles_look(struct traced_tiles *tiles, const SluiceDemandLoader *loader,
                       const SluiceDemandStatistics *statistics, uint64_t frame, uint64_t now);
/** Finds a page. NULL: no recent look has seen it. */
const struct traced_tile *traced_tiles_find(const struct traced_tiles *tiles, uint32_t page);
bool traced_tile_thrashes(const struct traced_tile *tile, uint64_t now);
/** Returns the tile in a slot of an image; NULL: free, or not listed. */
const SluiceDemandSlot *traced_tiles_at(const struct traced_tiles *tiles, uint32_t image,
                                        uint32_t layer);
struct traced_tile_sums {
    uint32_t slots, used, standby, spare; ///< spare: slots of images that compaction would free
    double fragmentation;                 ///< spare over slots, 0 to 1
};
struct traced_tile_sums traced_tiles_sums(const struct traced_tiles *tiles);

#endif /* SLUICE_VIEW_TRACED_TILES_H */
