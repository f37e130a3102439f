/** Whose page an id is. */
#ifndef SLC_DEMAND_VULKAN_PAGES_H
#define SLC_DEMAND_VULKAN_PAGES_H

#include "demand_vulkan/loader.h"

enum slc_page_owner {
    SLC_OWNER_NOBODY = 0,
    SLC_OWNER_LEVEL,    ///< a regular level of the image in the slot `index`
    SLC_OWNER_TAIL,     ///< page i of the block is the tail of the image slot 32 * `index` + i
    SLC_OWNER_RESOURCE, ///< `index`
    SLC_OWNER_OPENING   ///< not in the table: pages below texture_page_count
};

/** Ids of one rank, all of one owner. Errors: LIMIT_EXCEEDED, OUT_OF_HOST_MEMORY; nothing changed.
 */
SluiceResult slc_pages_take(SluiceDemandLoader *loader, uint32_t rank, uint64_t count,
                            enum slc_page_owner owner, uint32_t index, uint32_t *first);
/** No launch after the last one prepared names them. */
void slc_pages_give(SluiceDemandLoader *loader, uint32_t first, uint64_t count);
enum slc_page_owner slc_pages_find(const SluiceDemandLoader *loader, uint32_t page,
                                   uint32_t *index);
/** Requests of them that launches so far left behind are cleared by the next one. */
void slc_pages_forget_requests(SluiceDemandLoader *loader, uint32_t first, uint64_t count);
/** The page for all coarse levels of whatever image has the slot, which it keeps for good. Errors:
 *  as slc_pages_take. */
SluiceResult slc_image_find_tail(SluiceDemandLoader *loader, uint32_t slot, uint32_t *page);
/** Pages of all regular levels of an image whose info and tile size are known. Errors: the same. */
SluiceResult slc_image_take_levels(SluiceDemandLoader *loader, struct slc_demand_image *image);
void slc_image_give_levels(SluiceDemandLoader *loader, struct slc_demand_image *image);
/** None of its tiles is resident any more; and what shaders asked of them. */
void slc_image_forget(SluiceDemandLoader *loader, const struct slc_demand_image *image);
void slc_image_forget_requests(SluiceDemandLoader *loader, const struct slc_demand_image *image);

#endif /* SLC_DEMAND_VULKAN_PAGES_H */
