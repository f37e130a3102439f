/*
 * Textures that nobody samples are forgotten: their pages are evicted and their images closed, as
 * if they had never been opened. docs/decisions/0067-textures-without-use-are-forgotten.md.
 *
 * Open images are in the order of their last use. Only launches that told what they used change it.
 */
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"

#include <sluice/shared/demand.h>

/* Images that are forgotten for one page, and after one launch, at most. */
#define MOST_PER_PAGE 64u
#define MOST_PER_LAUNCH 4096u

static void append(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    image->older = loader->newest_image;
    image->newer = SLC_NONE;
    if (image->older == SLC_NONE)
        loader->oldest_image = image->slot;
    else
        loader->images[image->older]->newer = image->slot;
    loader->newest_image = image->slot;
}

void slc_image_enter_order(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    image->last_use = loader->launch + loader->info.launchesInFlight; /* it is to be used yet */
    append(loader, image);
}

void slc_image_leave_order(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    if (image->older == SLC_NONE)
        loader->oldest_image = image->newer;
    else
        loader->images[image->older]->newer = image->newer;
    if (image->newer == SLC_NONE)
        loader->newest_image = image->older;
    else
        loader->images[image->newer]->older = image->older;
}

void slc_image_touch(SluiceDemandLoader *loader, struct slc_demand_image *image, uint64_t launch)
{
    if (image->state != SLC_IMAGE_OPEN || image->last_use >= launch)
        return;
    image->last_use = launch;
    if (image->newer == SLC_NONE)
        return;
    slc_image_leave_order(loader, image);
    append(loader, image);
}

void slc_image_touch_page(SluiceDemandLoader *loader, uint32_t page, uint64_t launch)
{
    uint32_t index;
    switch (slc_pages_find(loader, page, &index)) {
    case SLC_OWNER_TAIL:
        index = SLUICE_DEMAND_BLOCK_PAGES * index + page % SLUICE_DEMAND_BLOCK_PAGES;
        break;
    case SLC_OWNER_LEVEL: break;
    case SLC_OWNER_OPENING:
    case SLC_OWNER_RESOURCE:
    case SLC_OWNER_NOBODY: return;
    }
    if (index < loader->image_high)
        slc_image_touch(loader, loader->images[index], launch);
}

/* The image that was used longest ago, if it is idle. Images that are being read are in use. */
static struct slc_demand_image *find_oldest(SluiceDemandLoader *loader)
{
    while (loader->oldest_image != SLC_NONE) {
        struct slc_demand_image *image = loader->images[loader->oldest_image];
        if (slc_image_is_idle(loader, image))
            return image;
        if (image->last_use >= loader->processed)
            return NULL;
        slc_image_touch(loader, image, loader->processed);
    }
    return NULL;
}

static bool has_place(const SluiceDemandLoader *loader)
{
    struct slc_residency_counts counts;
    slc_residency_get_counts(loader->residency, SLC_CLASS_TILES, &counts);
    return counts.resident + counts.loading < loader->tile_limit;
}

void slc_images_make_room(SluiceDemandLoader *loader, uint32_t page)
{
    if (!loader->knows_use || loader->info.noEviction || has_place(loader) ||
        !slc_residency_is_absent(loader->residency, page))
        return;
    uint64_t oldest_tile = slc_residency_oldest_use(loader->residency, SLC_CLASS_TILES);
    for (uint32_t i = 0; i < MOST_PER_PAGE && !has_place(loader); i++) {
        struct slc_demand_image *image = find_oldest(loader);
        if (!image || image->last_use > oldest_tile)
            return;
        slc_image_forget_texture(loader, image);
        slc_tiles_limit(loader);
    }
}

void slc_images_forget_old(SluiceDemandLoader *loader)
{
    uint64_t most = loader->info.forgetAfterLaunches;
    if (most == 0 || !loader->knows_use || loader->info.noEviction)
        return;
    for (uint32_t i = 0; i < MOST_PER_LAUNCH; i++) {
        struct slc_demand_image *image = find_oldest(loader);
        if (!image || loader->processed - image->last_use < most ||
            loader->processed - loader->known_since < most)
            return;
        slc_image_forget_texture(loader, image);
    }
    slc_tiles_limit(loader);
}
