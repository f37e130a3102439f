/*
 * Unsampled textures are forgotten: their pages are evicted and their images closed, as
 * if they had never been opened. docs/decisions/0067-textures-without-use-are-forgotten.md.
 *
 * Open images are sorted by last use: images whose mip tail has a place in one order, all others in
 * another. Only launches that reported their uses change the orders. A sample that needs only the
 * color of the last level, and no page, marks the tail as used. So the tail's block of the page
 * table stays while the image is open.
 */
#include "demand_vulkan/loader.h"
#include "demand_vulkan/pages.h"

#include <sluice/shared/demand.h>

/* Most images that are forgotten for one page, and after one launch. */
#define MOST_PER_PAGE 64u
#define MOST_PER_LAUNCH 4096u

static struct slc_image_order *order_of(SluiceDemandLoader *loader,
                                        const struct slc_demand_image *image)
{
    return &loader->orders[image->has_tail];
}

static void append(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    struct slc_image_order *order = order_of(loader, image);
    image->older = order->newest;
    image->newer = SLC_NONE;
    if (image->older == SLC_NONE)
        order->oldest = image->slot;
    else
        loader->images[image->older]->newer = image->slot;
    order->newest = image->slot;
}

static void leave(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    struct slc_image_order *order = order_of(loader, image);
    if (image->older == SLC_NONE)
        order->oldest = image->newer;
    else
        loader->images[image->older]->newer = image->newer;
    if (image->newer == SLC_NONE)
        order->newest = image->older;
    else
        loader->images[image->newer]->older = image->older;
}

static void change_order(SluiceDemandLoader *loader, struct slc_demand_image *image, bool has_tail)
{
    leave(loader, image);
    image->has_tail = has_tail;
    append(loader, image);
}

/* If the page table has no block for the tail, only lookups and misses of pages count as use. */
void slc_image_enter_order(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    image->last_use =
        loader->launch + loader->info.launchesInFlight; /* later launches will use it */
    image->has_tail = false;
    append(loader, image);
    (void)slc_page_directory_keep(&loader->directory, image->tail_page);
}

void slc_image_leave_order(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    leave(loader, image);
    slc_page_directory_unkeep(&loader->directory, image->tail_page);
}

void slc_image_touch(SluiceDemandLoader *loader, struct slc_demand_image *image, uint64_t launch)
{
    if (image->state != SLC_IMAGE_OPEN || image->last_use >= launch)
        return;
    image->last_use = launch;
    if (image->newer != SLC_NONE)
        change_order(loader, image, image->has_tail);
}

void slc_image_gets_tail(SluiceDemandLoader *loader, struct slc_demand_image *image)
{
    slc_image_touch(loader, image, loader->processed);
    if (!image->has_tail)
        change_order(loader, image, true);
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

/* Returns the least recently used image if it is idle; the last launch may have used it. */
static struct slc_demand_image *find_oldest(SluiceDemandLoader *loader,
                                            const struct slc_image_order *order)
{
    while (order->oldest != SLC_NONE) {
        struct slc_demand_image *image = loader->images[order->oldest];
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

/* Frees tails, which no eviction frees. Tiles used before them are evicted instead. */
void slc_images_make_room(SluiceDemandLoader *loader, uint32_t page)
{
    if (!loader->knows_use || loader->info.noEviction || has_place(loader) ||
        !slc_residency_is_absent(loader->residency, page))
        return;
    uint64_t oldest_tile = slc_residency_oldest_use(loader->residency, SLC_CLASS_TILES);
    for (uint32_t i = 0; i < MOST_PER_PAGE && !has_place(loader); i++) {
        struct slc_demand_image *image = find_oldest(loader, &loader->orders[1]);
        if (!image || image->last_use > oldest_tile)
            return;
        if (slc_residency_is_absent(loader->residency, image->tail_page)) { /* lost its place */
            change_order(loader, image, false);
            continue;
        }
        slc_image_forget_texture(loader, image);
        slc_tiles_limit(loader);
    }
}

static uint32_t forget_old(SluiceDemandLoader *loader, const struct slc_image_order *order,
                           uint32_t most)
{
    uint32_t count = 0;
    while (count < most) {
        struct slc_demand_image *image = find_oldest(loader, order);
        if (!image || loader->processed - image->last_use < loader->info.forgetAfterLaunches)
            break;
        if (image->retry_group) { /* failed tiles would be read again too early */
            slc_image_touch(loader, image, loader->processed);
            continue;
        }
        slc_image_forget_texture(loader, image);
        count++;
    }
    return count;
}

void slc_images_forget_old(SluiceDemandLoader *loader)
{
    uint64_t after = loader->info.forgetAfterLaunches;
    if (after == 0 || !loader->knows_use || loader->info.noEviction ||
        loader->processed - loader->known_since < after)
        return;
    uint32_t count = forget_old(loader, &loader->orders[1], MOST_PER_LAUNCH);
    forget_old(loader, &loader->orders[0], MOST_PER_LAUNCH - count);
    slc_tiles_limit(loader);
}
