/** Owners of page ids: levels and tails of images, resources, openings. */
#ifndef SLC_DEMAND_VULKAN_PAGES_H
#define SLC_DEMAND_VULKAN_PAGES_H

#include "demand_vulkan/loader.h"

enum slc_page_owner {
    SLC_OWNER_NOBODY = 0,
    SLC_OWNER_LEVEL,    ///< a regular level of the image in slot `index`
    SLC_OWNER_TAIL,     ///< page i of the block is the tail of image slot 32 * `index` + i
    SLC_OWNER_RESOURCE, ///< resource `index`
    SLC_OWNER_OPENING   ///< pages below texture_page_count, which are not in `owners`
};

/** Takes ids of one rank for one owner. Errors, with nothing changed: LIMIT_EXCEEDED,
 * OUT_OF_HOST_MEMORY. */
SluiceResult slc_pages_take(SluiceDemandLoader *loader, uint32_t rank, uint64_t count,
                            enum slc_page_owner owner, uint32_t index, uint32_t *first);
/** Gives ids back. No launch after the last prepared one may name them. */
void slc_pages_give(SluiceDemandLoader *loader, uint32_t first, uint64_t count);
enum slc_page_owner slc_pages_find(const SluiceDemandLoader *loader, uint32_t page,
                                   uint32_t *index);
/** Clears, with the next launch, requests of these ids that earlier launches left behind. */
void slc_pages_forget_requests(SluiceDemandLoader *loader, uint32_t first, uint64_t count);
/** Finds or takes the page for the mip tail of an image slot. The slot keeps it for all later
 * images. Errors: as slc_pages_take. */
SluiceResult slc_image_find_tail(SluiceDemandLoader *loader, uint32_t slot, uint32_t *page);
/** Takes pages for all regular levels of an image with known info and tile size. Errors: as above.
 */
SluiceResult slc_image_take_levels(SluiceDemandLoader *loader, struct slc_demand_image *image);
void slc_image_give_levels(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** Forgets all tiles of an image, and the requests of shaders for them. */
void slc_image_forget(SluiceDemandLoader *loader, const struct slc_demand_image *image);
void slc_image_forget_requests(SluiceDemandLoader *loader, const struct slc_demand_image *image);

#endif /* SLC_DEMAND_VULKAN_PAGES_H */
