#include "traced.h"

#include "facts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TILE_SIZE 65536u
/* Tiles of pictures that are read per frame. */
#define TILES_PER_FRAME 16384u

static uint32_t picture_of_id(const struct traced *t, uint64_t id)
{
    /* The low half of an id is the index for shaders. Variants share the picture of their base. */
    for (uint32_t i = 0; i < t->textures.use_count; i++) {
        const struct picture_use *use = t->textures.uses[i];
        if (use->id != id)
            continue;
        for (uint32_t k = 0; k < t->picture_count; k++)
            if (strcmp(t->pictures[k].texture.path, use->image->file->path) == 0)
                return k;
    }
    return UINT32_MAX;
}

static int compare(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

static void add_event(struct traced *t, const SluiceDemandMiss *miss, uint32_t picture)
{
    t->events[t->event_next] = (struct traced_event){.launch = t->now.launchCount,
                                                     .picture = picture,
                                                     .kind = miss->kind,
                                                     .level = miss->level,
                                                     .x = miss->x,
                                                     .y = miss->y};
    t->event_next = (t->event_next + 1) % TRACED_EVENTS;
    t->event_count += t->event_count < TRACED_EVENTS;
}

/* Notes the misses of the last launch. Launches miss a page until it is resident: the first miss
 * counts. */
void traced_note_misses(struct traced *t)
{
    SluiceDemandMiss misses[TRACED_MISSES];
    uint32_t pages[TRACED_MISSES], count = TRACED_MISSES, kept = 0;
    if (sluiceGetDemandMisses(t->loader, &count, misses) < SLUICE_SUCCESS)
        count = 0;
    for (uint32_t i = 0; i < count; i++) {
        const SluiceDemandMiss *miss = &misses[i];
        if (miss->kind > SLUICE_DEMAND_MISS_TAIL) /* boxes and materials */
            continue;
        pages[kept++] = miss->page;
        if (bsearch(&miss->page, t->pages, t->miss_count, sizeof *t->pages, compare))
            continue;
        const uint32_t picture = picture_of_id(t, miss->id);
        add_event(t, miss, picture);
        if (picture != UINT32_MAX)
            t->pictures[picture].asked++;
    }
    qsort(pages, kept, sizeof *pages, compare);
    memcpy(t->pages, pages, kept * sizeof *pages);
    t->miss_count = kept;
}

static const char *format_name(SluiceFormat format)
{
    switch (format) {
    case SLUICE_FORMAT_R8_UNORM: return "R8";
    case SLUICE_FORMAT_R8G8_UNORM: return "RG8";
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return "RGBA8";
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return "RGBA8 sRGB";
    case SLUICE_FORMAT_R16G16B16A16_SFLOAT: return "RGBA16F";
    case SLUICE_FORMAT_R16G16B16A16_UNORM: return "RGBA16";
    default: return "other";
    }
}

/* Describes an open picture. A thread of the loader writes the info before it answers the region.
 */
static void describe(struct traced_picture *p, const struct picture_image *image)
{
    const SluiceImageInfo *info = &image->info;
    p->texture.width = info->width;
    p->texture.height = info->height;
    p->texture.level_count = info->mipLevelCount;
    p->texture.format = format_name(info->format);
}

static bool get_progress(const struct traced *t, const struct traced_picture *p, uint32_t level,
                         SluiceDemandRegionProgress *progress)
{
    const uint32_t width = p->texture.width >> level, height = p->texture.height >> level;
    const SluiceImageRegion region = {
        .mipLevel = level, .width = width > 0 ? width : 1, .height = height > 0 ? height : 1};
    *progress = (SluiceDemandRegionProgress){.structSize = sizeof *progress};
    return sluiceGetDemandRegionProgress(t->loader, p->id, level > 0 ? &region : NULL, progress) ==
           SLUICE_SUCCESS;
}

/* Finds the finest level with resident tiles. A count includes all coarser levels, so this is the
 * finest level whose count exceeds the next one's. */
static uint32_t find_finest(const struct traced *t, const struct traced_picture *p)
{
    SluiceDemandRegionProgress progress;
    for (uint32_t level = 1; level < p->texture.level_count; level++) {
        if (!get_progress(t, p, level, &progress))
            return UINT32_MAX;
        if (progress.residentTileCount < p->resident_count)
            return level - 1;
    }
    return p->resident_count > 0 && p->texture.level_count > 0 ? p->texture.level_count - 1
                                                               : UINT32_MAX;
}

static uint32_t look_at(struct traced *t, struct traced_picture *p)
{
    SluiceDemandRegionProgress progress;
    const struct picture_image *image = NULL;
    for (uint32_t i = 0; i < t->textures.image_count && !image; i++)
        if (strcmp(t->textures.images[i]->file->path, p->texture.path) == 0)
            image = t->textures.images[i];
    p->id = image ? image->id : SLUICE_NO_DEMAND_TEXTURE;
    if (!image || !get_progress(t, p, 0, &progress))
        return 1;
    if (progress.isOpen) {
        describe(p, image);
        atomic_store(&p->file, image->file);
    }
    const uint32_t before = p->resident_count, now = progress.residentTileCount;
    p->arrived += now > before ? now - before : 0;
    p->left += before > now ? before - now : 0;
    p->resident_count = now;
    p->pending_count = progress.pendingTileCount;
    p->refused_count = progress.refusedTileCount + progress.failed;
    p->tile_count = progress.tileCount;
    p->texture.size = (uint64_t)p->tile_count * TILE_SIZE;
    p->finest = progress.isOpen ? find_finest(t, p) : UINT32_MAX;
    return 1 + 2 * p->tile_count;
}

SluiceImageSource *traced_borrow_source(const struct traced *t, uint32_t picture)
{
    struct picture_file *file = atomic_load(&t->pictures[picture].file);
    SluiceImageSource *source = NULL;
    return file && shared_source_open(&file->shared, &source) == SLUICE_SUCCESS ? source : NULL;
}

void traced_return_source(const struct traced *t, uint32_t picture, SluiceImageSource *source)
{
    shared_source_close(&atomic_load(&t->pictures[picture].file)->shared, source);
}

static void look_at_pictures(struct traced *t)
{
    uint32_t done = 0;
    for (uint32_t i = 0; i < t->picture_count && done < TILES_PER_FRAME; i++) {
        done += look_at(t, &t->pictures[t->next_picture]);
        t->next_picture = (t->next_picture + 1) % t->picture_count;
    }
}

uint32_t traced_opening_count(const struct traced *t)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->picture_count; i++) {
        const struct traced_picture *p = &t->pictures[i];
        count += p->id != 0 && p->tile_count == 0 && p->refused_count == 0;
    }
    return count;
}

static void write_picture(const struct traced_picture *p, struct facts_texture *f)
{
    const uint32_t wanted = p->resident_count + p->pending_count + p->refused_count;
    f->statistics =
        (SluiceTextureStatistics){.structSize = sizeof f->statistics,
                                  .residentTileCount = p->resident_count,
                                  .requestedTileCount = p->pending_count,
                                  .mappedTotal = p->arrived,
                                  .unmappedTotal = p->left,
                                  .failedTotal = p->refused_count,
                                  .wanted = wanted > 0,
                                  .wantedTileCount = wanted,
                                  .residentSize = (uint64_t)p->resident_count * TILE_SIZE,
                                  .wantedSize = (uint64_t)wanted * TILE_SIZE};
    f->finest_level = p->finest;
    f->thrash = p->resident_count > 0 ? p->arrived / (double)p->resident_count : 0.0;
}

static void write_streamer(const struct traced *t, const SluiceDemandStatistics *d,
                           SluiceVulkanStreamerStatistics *s)
{
    *s = (SluiceVulkanStreamerStatistics){.structSize = sizeof *s,
                                          .textureCount = t->picture_count,
                                          .globalMipBias = (uint32_t)(16.0f * d->lodBias + 0.5f),
                                          .bytesRead = d->bytesRead,
                                          .bytesUploaded = d->bytesUploaded,
                                          .tilesMapped = d->servedCount,
                                          .tilesUnmapped = d->evictedCount,
                                          .tilesCanceled = d->canceledCount,
                                          .tilesFailed = d->failedCount,
                                          .failedTileCount = atomic_load(&t->parts->failed_reads),
                                          .deviceMemorySize = d->deviceMemorySize,
                                          .tileMemorySize = d->tileMemorySize,
                                          .hostVisibleMemorySize = d->hostVisibleMemorySize,
                                          .heapCount = d->pageChunkCount,
                                          .pageChunkCount = d->pageChunkCount};
}

void traced_facts_update(struct traced *t, struct view_facts *f)
{
    look_at_pictures(t);
    write_streamer(t, &t->now, &f->now);
    write_streamer(t, &t->before, &f->before);
    f->all_size = f->wanted_size = 0;
    f->now.loadsInFlight = 0;
    for (uint32_t i = 0; i < t->picture_count && i < f->texture_count; i++) {
        write_picture(&t->pictures[i], &f->textures[i]);
        f->all_size += t->pictures[i].texture.size;
        f->wanted_size += f->textures[i].statistics.wantedSize;
        f->now.loadsInFlight += t->pictures[i].pending_count;
    }
    /* A mip tail counts as a tile and shares its page: less than tiles times 64 KiB. */
    f->resident_size = t->now.residentTileCount * TILE_SIZE;
    if (f->resident_size > t->now.tileMemorySize)
        f->resident_size = t->now.tileMemorySize;
    f->memory_size = t->now.tileMemorySize;
    f->sharp = traced_complete(t);
    f->sharp_known = true;
    /* Launches are separate submissions, which the host waits for: their time counts as GPU time.
     */
    f->gpu_seconds += t->trace_seconds;
    f->host_seconds = fmax(0.0, f->host_seconds - t->trace_seconds);
}

static const char *say(char *text, size_t size, bool *good, bool is_good, const char *words)
{
    *good = is_good;
    snprintf(text, size, "%s", words);
    return text;
}

static const char *explain_scene(const struct traced *t, bool *good, char *text, size_t size)
{
    const uint32_t boxes = proxies_box_count(&t->proxies);
    if (t->missing == 0 || t->sample > 0)
        return say(text, size, good, true, "Complete: nothing that rays hit is missing.");
    *good = false;
    snprintf(text, size,
             "%u pixels lack something: shapes that are still boxes (%u in the scene), materials "
             "that are not made, or tiles on their way.",
             t->missing, boxes);
    return text;
}

const char *traced_explain(const struct traced *t, uint32_t picture, bool *good, char *text,
                           size_t size)
{
    if (picture >= t->picture_count)
        return explain_scene(t, good, text, size);
    const struct traced_picture *p = &t->pictures[picture];
    *good = false;
    if (!p->id)
        return say(text, size, good, false,
                   "No ray has requested it: no material that rays hit uses it.");
    if (p->refused_count > 0 && p->tile_count == 0)
        return say(text, size, good, false,
                   "It cannot be read: its surfaces are gray. Shift+I says why.");
    if (p->tile_count == 0)
        return say(text, size, good, false,
                   "It is being opened. Its tiles are made first if the cache has none.");
    if (p->refused_count > 0)
        snprintf(text, size, "%u tiles cannot be read or found no memory: coarser tiles are shown.",
                 p->refused_count);
    else if (t->now.lodBias > 0)
        snprintf(text, size,
                 "Memory is short: all textures are %.1f levels coarser. Raise the budget.",
                 (double)t->now.lodBias);
    else if (p->pending_count > 0)
        snprintf(text, size, "%u tiles are on their way.", p->pending_count);
    else
        return say(text, size, good, true,
                   "As sharp as rays request: all tiles that they sample are resident.");
    return text;
}
