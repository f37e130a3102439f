/** Which texels a page of an image is. */
#ifndef SLC_DEMAND_VULKAN_TILES_H
#define SLC_DEMAND_VULKAN_TILES_H

#include "demand_vulkan/loader.h"

#include <sluice/shared/demand.h>

/** Levels of a tail, at most. */
#define SLC_TILE_MAX_PARTS 24u
static_assert(SLC_TILE_MAX_PARTS <= SLUICE_MAX_READ_REGIONS, "a tail is one read");

/** A tile, or one level of a tail. */
struct slc_tile_part {
    SluiceImageRegion region;
    uint32_t offset; ///< bytes in staging memory
    uint32_t x, y;   ///< texels in the page's layer
};

/** Returns how many parts: 1 but for tails. `place`: of the page. */
uint32_t slc_tile_parts(const struct slc_demand_image *image, uint32_t page, uint32_t place,
                        struct slc_tile_part parts[SLC_TILE_MAX_PARTS]);

/** Returns the level whose tile the page is, `*index` of it row by row; regular_count for the tail,
 *  and for ids that are no tile's. */
uint32_t slc_tile_level(const struct slc_demand_image *image, uint32_t page, uint32_t *index);
/** Ends a job of a tile or mip tail that is not there. `failed`: by its source or producer. */
void slc_tile_fail(SluiceDemandLoader *loader, struct slc_demand_job *job, SluiceResult result,
                   bool failed);
/** A tile or mip tail of the image came. */
void slc_tile_note_success(SluiceDemandLoader *loader, struct slc_demand_image *image,
                           uint32_t page);

#endif /* SLC_DEMAND_VULKAN_TILES_H */
