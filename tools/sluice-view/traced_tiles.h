/** Tiles of a demand loader: in which slots of memory they are, since when, and how often loaded.
 */
#ifndef SLUICE_VIEW_TRACED_TILES_H
#define SLUICE_VIEW_TRACED_TILES_H

#include <sluice/demand_query.h>

#include <stdbool.h>
#include <stdint.h>

#define TRACED_TILE_MOST 262144u ///< tiles that are listed: 16 GiB
#define TRACED_TILE_THRASHES 3u  ///< loads within TRACED_TILE_WINDOW
#define TRACED_TILE_WINDOW 10000000u

struct traced_tile {
    SluiceDemandSlot slot; ///< as of the last look; its page is UINT32_MAX in entries without tile
    bool here;             ///< it has a slot
    uint64_t loaded[TRACED_TILE_THRASHES]; ///< last times, newest first; 0: never
    uint32_t loads;
};

/** Zeroed is empty. */
struct traced_tiles {
    struct traced_tile *entries; ///< owned; hash map by page
    uint32_t capacity, count;    ///< a power of two, at least twice the count; 0: nothing is known
    SluiceDemandSlot *slots;     ///< owned; of the last look
    uint32_t slot_count, slot_room;
    SluiceDemandSlotImage *images; ///< owned, as the next two
    uint32_t *first_slots;         ///< of each image, in `by_slot`
    uint32_t *by_slot;             ///< 1 + element of `slots`; 0: free, or of others
    uint32_t image_count, by_slot_count;
    uint64_t next_look; ///< frame
    uint64_t seen[4];   ///< figures of the loader at the last look
    bool is_cut;        ///< there are more tiles than are listed
};

void traced_tiles_finish(struct traced_tiles *tiles);
/** Looks at the loader's slots if something has changed; rarely if there are many. `now`:
 *  microseconds. Without memory the last look stays. */
void traced_tiles_look(struct traced_tiles *tiles, const SluiceDemandLoader *loader,
                       const SluiceDemandStatistics *statistics, uint64_t frame, uint64_t now);
/** NULL: no look has seen the page, or long ago. */
const struct traced_tile *traced_tiles_find(const struct traced_tiles *tiles, uint32_t page);
bool traced_tile_thrashes(const struct traced_tile *tile, uint64_t now);
/** The tile of a slot of an image; NULL: it is free, or of others. */
const SluiceDemandSlot *traced_tiles_at(const struct traced_tiles *tiles, uint32_t image,
                                        uint32_t layer);
struct traced_tile_sums {
    uint32_t slots, used, standby, spare; ///< spare: in images that would be empty if tiles moved
    double fragmentation;                 ///< spare over slots, 0 to 1
};
struct traced_tile_sums traced_tiles_sums(const struct traced_tiles *tiles);

#endif /* SLUICE_VIEW_TRACED_TILES_H */
