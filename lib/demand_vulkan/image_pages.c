/* Pages of an image. Pages of levels are taken per image, the page of the tail per slot. */
#include "demand_vulkan/pages.h"

#include "base/alloc.h"
#include "demand/tail_place.h"
#include "demand_vulkan/opening.h"

#include <sluice/shared/demand.h>

#include <assert.h>

SluiceResult slc_image_find_tail(SluiceDemandLoader *loader, uint32_t slot, uint32_t *page)
{
    uint32_t block = slot / SLUICE_DEMAND_BLOCK_PAGES;
    if (block == loader->tail_block_capacity) {
        uint32_t capacity = block ? 2 * block : 16;
        uint32_t *blocks = slc_regrow(&loader->cb, loader->tail_blocks, block, capacity,
                                      sizeof *loader->tail_blocks);
        if (!blocks)
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        loader->tail_blocks = blocks;
        loader->tail_block_capacity = capacity;
    }
    if (block == loader->tail_block_count) {
        SluiceResult result = slc_pages_take(loader, 0, SLUICE_DEMAND_BLOCK_PAGES, SLC_OWNER_TAIL,
                                             block, &loader->tail_blocks[block]);
        if (result != SLUICE_SUCCESS)
            return result;
        loader->tail_block_count++;
    }
    *page = loader->tail_blocks[block] + slot % SLUICE_DEMAND_BLOCK_PAGES;
    return SLUICE_SUCCESS;
}

static uint64_t level_tile_count(const struct slc_demand_image *image, uint32_t level)
{
    return (uint64_t)slc_image_level_width(image, level) * slc_image_level_height(image, level);
}

uint32_t slc_image_level_rank(const struct slc_demand_image *image, uint32_t level)
{
    uint32_t rank = 1;
    uint64_t tiles = level_tile_count(image, level);
    for (uint64_t n = 1; n < tiles && rank < SLUICE_DEMAND_RANKS - 1; n *= 4)
        rank++;
    return rank;
}

void slc_image_give_levels(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    for (uint32_t l = 0; l < image->regular_count; l++)
        slc_pages_give(loader, image->first_pages[l], level_tile_count(image, l));
    image->regular_count = 0;
}

SluiceResult slc_image_take_levels(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    uint32_t count = slc_demand_regular_count(image->info.width, image->info.height,
                                              image->tile_width, image->tile_height);
    assert(count <= SLC_MAX_REGULAR_LEVELS);
    for (uint32_t l = 0; l < count; l++) {
        uint64_t tiles = level_tile_count(image, l);
        SluiceResult result = slc_pages_take(loader, slc_image_level_rank(image, l), tiles,
                                             SLC_OWNER_LEVEL, image->slot, &image->first_pages[l]);
        if (result != SLUICE_SUCCESS) {
            slc_image_give_levels(loader, image);
            return result;
        }
        image->regular_count = l + 1;
    }
    return SLUICE_SUCCESS;
}

void slc_image_forget(SluiceDemandLoader *loader, const struct slc_demand_image *image)
{
    for (uint32_t l = 0; l < image->regular_count; l++)
        slc_residency_forget(loader->residency, image->first_pages[l], level_tile_count(image, l));
    slc_residency_forget(loader->residency, image->tail_page, 1);
    for (uint32_t l = 0; l < image->regular_count; l++)
        slc_remakes_forget(loader, image->first_pages[l], level_tile_count(image, l));
    slc_remakes_forget(loader, image->tail_page, 1);
}

void slc_image_forget_requests(SluiceDemandLoader *loader, const struct slc_demand_image *image)
{
    for (uint32_t l = 0; l < image->regular_count; l++)
        slc_pages_forget_requests(loader, image->first_pages[l], level_tile_count(image, l));
    slc_pages_forget_requests(loader, image->tail_page, 1);
}
