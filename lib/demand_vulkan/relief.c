/*
 * Under pressure the loader empties whole images of pages, because only empty images free memory.
 * The image with the fewest pages in use goes first. The next launch misses its used pages, and
 * they are read again into other images.
 */
#include "base/alloc.h"
#include "demand_vulkan/loader.h"
#include "vulkan/page_leaving.h"
#include "vulkan/sparse_layout.h"

/* Pages of the loader on one image. */
struct chunk_use {
    uint32_t held, in_use;
    bool stays; ///< some pages are pinned, being loaded, or new
};

struct survey {
    struct chunk_use chunks[SLC_MAX_PAGE_CHUNKS];
    SluiceDemandLoader *loader;
    uint32_t chunk;                               ///< chunk whose pages are listed
    uint32_t pages[SLC_PAGE_CHUNK_LAYERS], count; ///< some pages of `chunk`
};

static uint32_t chunk_of(const struct slc_placed_page *page)
{
    return (page->place & SLUICE_DEMAND_PLACE_MASK) >> 16;
}

static void count_page(void *user, const struct slc_placed_page *page)
{
    struct survey *survey = user;
    struct chunk_use *use = &survey->chunks[chunk_of(page)];
    use->held++;
    use->in_use += page->in_use;
    use->stays |= page->stays;
}

static void list_page(void *user, const struct slc_placed_page *page)
{
    struct survey *survey = user;
    if (chunk_of(page) == survey->chunk && survey->count < SLC_PAGE_CHUNK_LAYERS)
        survey->pages[survey->count++] = page->page;
}

/* Chooses an image. Skips images with pages of other users: `held` counts only own pages. */
static uint32_t choose_chunk(const struct survey *survey, bool unused_only)
{
    struct slc_page_pool *pool = survey->loader->pages;
    uint32_t best = SLC_NONE;
    for (uint32_t i = 0; i < pool->chunks.count; i++) {
        const struct chunk_use *use = &survey->chunks[i];
        const struct chunk_use *other = best == SLC_NONE ? NULL : &survey->chunks[best];
        if (use->held == 0 || use->stays || (unused_only && use->in_use) ||
            use->held != slc_page_pool_held_in(pool, survey->loader->page_user, i))
            continue;
        if (!other || use->in_use < other->in_use ||
            (use->in_use == other->in_use && use->held < other->held))
            best = i;
    }
    return best;
}

static void empty_chunk(struct survey *survey, uint32_t chunk)
{
    struct slc_demand_residency *residency = survey->loader->residency;
    survey->chunk = chunk;
    do { /* several equal tiles can be on one page */
        survey->count = 0;
        slc_residency_visit_placed(residency, SLC_CLASS_TILES, list_page, survey);
        for (uint32_t i = 0; i < survey->count; i++)
            slc_residency_forget(residency, survey->pages[i], 1);
    } while (survey->count == SLC_PAGE_CHUNK_LAYERS);
    survey->chunks[chunk] = (struct chunk_use){0};
}

/* True if the last launch reported the pages that it used. */
static bool knows_use(const SluiceDemandLoader *loader)
{
    return loader->processed > 0 &&
           loader->tracked[loader->processed % loader->info.launchesInFlight];
}

/* Resets the LOD bias if the limit has risen. The bias remembers failures, and would not fall in a
 * still view. */
static void note_limit(SluiceDemandLoader *loader)
{
    uint64_t limit = slc_memory_budget_limit(&loader->context->budget);
    if (limit > loader->memory_limit)
        slc_page_pool_ask_again(loader->pages);
    if (limit > loader->memory_limit && slc_residency_lod_bias(loader->residency) > 0) {
        slc_residency_set_switches(loader->residency, loader->info.noEviction, true);
        slc_residency_set_switches(loader->residency, loader->info.noEviction,
                                   loader->info.noLodBias);
    }
    loader->memory_limit = limit;
}

void slc_relieve_memory(SluiceDemandLoader *loader)
{
    note_limit(loader);
    const struct slc_memory_pressure *pressure = &loader->memory_pressure;
    uint64_t beyond = pressure->beyond, size = beyond + (knows_use(loader) ? pressure->refused : 0);
    if (beyond + pressure->refused == 0)
        return;
    slc_page_pool_hurry(loader->pages);
    if (size == 0 || loader->info.noEviction || loader->admitted.first != SLC_NONE)
        return;
    struct survey *survey = slc_calloc(&loader->cb, 1, sizeof *survey);
    if (!survey)
        return; /* the next launch tries again */
    survey->loader = loader;
    slc_residency_visit_placed(loader->residency, SLC_CLASS_TILES, count_page, survey);
    for (uint64_t going; (going = slc_page_pool_going_size(loader->pages)) < size;) {
        uint32_t chunk = choose_chunk(survey, going >= beyond);
        if (chunk == SLC_NONE)
            break;
        empty_chunk(survey, chunk);
    }
    slc_free(&loader->cb, survey, 1, sizeof *survey);
}
