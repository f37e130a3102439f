/** Texels of an image's pages: tiles, and levels of the tail. */
#ifndef SLC_DEMAND_VULKAN_TILES_H
#define SLC_DEMAND_VULKAN_TILES_H

#include "demand_vulkan/loader.h"

#include <sluice/shared/demand.h>

/** Most levels of a tail. */
#define SLC_TILE_MAX_PARTS 24u
static_assert(SLC_TILE_MAX_PARTS <= SLUICE_MAX_READ_REGIONS, "a tail is one read");

/** A tile, or one level of a tail. */
struct slc_tile_part {
    SluiceImageRegion region;
    uint32_t offset; ///< bytes in staging memory
    uint32_t x, y;   ///< texels in the page's layer
};

/** Gets the parts of a page. Returns their number, 1 except for tails. `place`: place of the page.
 */
uint32_t slc_tile_parts(const struct slc_demand_image *image, uint32_t page, uint32_t place,
                        struct slc_tile_part parts[SLC_TILE_MAX_PARTS]);

/** Returns the level of a tile, and its index in the level, row by row. regular_count for the tail,
 *  and for ids without a tile. */
uint32_t slc_tile_level(const struct slc_demand_image *image, uint32_t page, uint32_t *index);
/** Ends a job of a tile or mip tail without texels. `failed`: its source or producer failed. */
void slc_tile_fail(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result,
                   bool failed);
/** Notes that a tile or mip tail of the image was loaded. */
void slc_tile_note_success(SluiceDemandLoader *loader, struct slc_demand_image *image,
                           uint32_t page);

#endif /* SLC_DEMAND_VULKAN_TILES_H */
