/* Queries of the memory slots of tiles. */
#include "base/checked.h"
#include "demand_vulkan/queries.h"
#include "vulkan/page_slots.h"

#include <sluice/shared/demand.h>

/* List of slots. Entries beyond its capacity are only counted. */
struct slot_list {
    const SluiceDemandLoader *loader;
    SluiceDemandSlot *slots;
    uint32_t room, count;
};

static void add(struct slot_list *list, uint32_t page, uint32_t place, SluiceDemandSlotState state)
{
    const SluiceDemandMiss about = slc_demand_miss_of(list->loader, page);
    const bool is_tail = about.kind == SLUICE_DEMAND_MISS_TAIL;
    if (!is_tail && about.kind != SLUICE_DEMAND_MISS_TILE)
        return;
    place &= SLUICE_DEMAND_PLACE_MASK;
    if (list->count < list->room)
        list->slots[list->count] = (SluiceDemandSlot){.image = place >> 16,
                                                      .layer = place & 0xFFFFu,
                                                      .state = state,
                                                      .isTail = is_tail,
                                                      .textureId = about.id,
                                                      .page = page,
                                                      .level = about.level,
                                                      .x = about.x,
                                                      .y = about.y};
    list->count++;
}

static void add_placed(void *user, const struct slc_placed_page *page)
{
    struct slot_list *list = user;
    uint32_t place;
    add(list, page->page, page->place,
        slc_residency_is_resident(list->loader->residency, page->page, &place)
            ? SLUICE_DEMAND_SLOT_RESIDENT
            : SLUICE_DEMAND_SLOT_LOADING);
}

static void add_left(void *user, uint32_t place, uint32_t page)
{
    struct slot_list *list = user;
    uint32_t now;
    if (!slc_residency_is_resident(list->loader->residency, page, &now) &&
        slc_residency_place(list->loader->residency, page) == SLC_NO_PLACE)
        add(list, page, place, SLUICE_DEMAND_SLOT_STANDBY);
}

SluiceResult sluiceGetDemandSlots(const SluiceDemandLoader *loader, uint32_t *pSlotCount,
                                  SluiceDemandSlot *pSlots)
{
    if (!loader || !pSlotCount)
        return SLUICE_ERROR_NULL_POINTER;
    struct slot_list list = {loader, pSlots, pSlots ? *pSlotCount : 0, 0};
    slc_residency_visit_placed(loader->residency, SLC_CLASS_TILES, add_placed, &list);
    slc_page_pool_visit_left(loader->pages, loader->page_user, add_left, &list);
    *pSlotCount = pSlots ? slc_min_u32(list.room, list.count) : list.count;
    return pSlots && list.room < list.count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}

SluiceResult sluiceGetDemandSlotImages(const SluiceDemandLoader *loader, uint32_t *pImageCount,
                                       SluiceDemandSlotImage *pImages)
{
    if (!loader || !pImageCount)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_page_pool *pool = loader->pages;
    const uint32_t room = pImages ? *pImageCount : 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        struct slc_page_chunk_slots slots;
        if (!slc_page_pool_count_slots(pool, loader->page_user, i, &slots))
            continue;
        if (count < room)
            pImages[count] =
                (SluiceDemandSlotImage){i, slots.format, slots.count, slots.held, slots.others};
        count++;
    }
    *pImageCount = pImages ? slc_min_u32(room, count) : count;
    return pImages && room < count ? SLUICE_INCOMPLETE : SLUICE_SUCCESS;
}
