#include "slow_source.h"

#include <stdlib.h>

#define FORGOTTEN_AFTER 1000000u ///< microseconds

/** Requested region. */
struct wanted {
    SluiceImageRegion region;
    double due;
    uint64_t asked; ///< time of the last request
};

struct slow_source {
    SluiceImageSource base;
    SluiceImageSource *inner;
    struct slow_line *line;
    struct wanted *wanted; ///< owned
    size_t count, capacity;
};

bool slow_line_init(struct slow_line *line, const struct slow_line_info *info)
{
    *line = (struct slow_line){.info = *info};
    return pthread_mutex_init(&line->mutex, NULL) == 0;
}

void slow_line_finish(struct slow_line *line)
{
    pthread_mutex_destroy(&line->mutex);
}

static bool same_region(const SluiceImageRegion *a, const SluiceImageRegion *b)
{
    return a->mipLevel == b->mipLevel && a->x == b->x && a->y == b->y && a->width == b->width &&
           a->height == b->height && a->arrayLayer == b->arrayLayer;
}

static void forget(struct slow_source *source, uint64_t now)
{
    for (size_t i = 0; i < source->count;)
        if (now - source->wanted[i].asked > FORGOTTEN_AFTER)
            source->wanted[i] = source->wanted[--source->count];
        else
            i++;
}

static struct wanted *find(struct slow_source *source, const SluiceImageRegion *region)
{
    for (size_t i = 0; i < source->count; i++)
        if (same_region(&source->wanted[i].region, region))
            return &source->wanted[i];
    return NULL;
}

static struct wanted *add(struct slow_source *source, const SluiceImageRegion *region)
{
    if (source->count == source->capacity) {
        size_t capacity = source->capacity ? 2 * source->capacity : 16;
        struct wanted *wanted = realloc(source->wanted, capacity * sizeof *wanted);
        if (!wanted)
            return NULL;
        source->wanted = wanted;
        source->capacity = capacity;
    }
    struct wanted *added = &source->wanted[source->count++];
    *added = (struct wanted){.region = *region};
    return added;
}

/** Queues `size` bytes on the line. Returns the time at which they arrive. */
static double send(struct slow_line *line, double now, uint64_t size)
{
    double time = line->info.bandwidth > 0 ? (double)size / line->info.bandwidth : 0;
    line->free_at = (line->free_at > now ? line->free_at : now) + time;
    return line->free_at + line->info.latency;
}

/** Requests a region at time `now`. */
static bool request(struct slow_source *source, const SluiceImageInfo *info,
                    const SluiceImageRegion *region, uint64_t now)
{
    struct wanted *wanted = add(source, region);
    if (!wanted)
        return false;
    uint64_t size = sluiceGetFormatRegionSize(info->format, region->width, region->height);
    wanted->due = send(source->line, (double)now, size);
    wanted->asked = now;
    return true;
}

static SluiceImageRegion whole_level(const SluiceImageInfo *info, uint32_t level, uint32_t layer)
{
    uint32_t width = info->width >> level, height = info->height >> level;
    return (SluiceImageRegion){level, 0, 0, width ? width : 1, height ? height : 1, layer};
}

/** Requests a region. A whole level brings the coarser levels, which lie beside it in the file and
 * are wanted together. */
static SluiceResult request_all(struct slow_source *source, const SluiceImageRegion *region,
                                uint64_t now)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceResult result = sluiceGetImageInfo(source->inner, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!request(source, &info, region, now))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceImageRegion whole = whole_level(&info, region->mipLevel, region->arrayLayer);
    if (!same_region(region, &whole))
        return SLUICE_SUCCESS;
    for (uint32_t level = region->mipLevel + 1; level < info.mipLevelCount; level++) {
        whole = whole_level(&info, level, region->arrayLayer);
        if (!find(source, &whole) && !request(source, &info, &whole, now))
            break; /* a later read requests it */
    }
    return SLUICE_SUCCESS;
}

/** Requests the region on the first call. Returns NOT_READY until it has arrived. The line must be
 * locked. */
static SluiceResult ask(struct slow_source *source, const SluiceImageRegion *region)
{
    uint64_t now = source->line->info.clock(source->line->info.user_data);
    forget(source, now);
    if (!find(source, region)) {
        SluiceResult result = request_all(source, region, now);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    struct wanted *wanted = find(source, region);
    wanted->asked = now;
    return (double)now < wanted->due ? SLUICE_NOT_READY : SLUICE_SUCCESS;
}

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct slow_source *)base)->inner, info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch, SluiceImageFault *fault)
{
    struct slow_source *source = (struct slow_source *)base;
    pthread_mutex_lock(&source->line->mutex);
    SluiceResult result = ask(source, region);
    pthread_mutex_unlock(&source->line->mutex);
    if (result != SLUICE_SUCCESS)
        return result;
    return sluiceReadImageRegionLocated(source->inner, region, texels, row_pitch, fault);
}

static void destroy(SluiceImageSource *base)
{
    struct slow_source *source = (struct slow_source *)base;
    free(source->wanted);
    free(source);
}

SluiceResult slow_source_create(struct slow_line *line, SluiceImageSource *inner,
                                SluiceImageSource **out)
{
    static const SluiceImageSourceInterface interface = {.structSize = sizeof interface,
                                                         .pfnGetInfo = get_info,
                                                         .pfnDestroy = destroy,
                                                         .pfnReadRegionLocated = read_region};
    struct slow_source *source = calloc(1, sizeof *source);
    if (!source)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *source = (struct slow_source){.base = {&interface}, .inner = inner, .line = line};
    *out = &source->base;
    return SLUICE_SUCCESS;
}
