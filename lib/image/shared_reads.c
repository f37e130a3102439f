#include "image/shared_reads.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/read_queue.h"

#include <assert.h>
#include <string.h>

/* Bytes. Alignment of the texels behind the struct, so that sources may use wide instructions. */
#define ALIGNMENT 64u
#define HEADER_SIZE ((sizeof(struct slc_shared_region) + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT)
#define LEAST_BUCKETS 256u
#define MOST_BUCKETS (1u << 24)

void slc_shared_reads_init(struct slc_shared_reads *shares, const SluiceAllocationCallbacks *cb,
                           uint64_t limit)
{
    *shares = (struct slc_shared_reads){.cb = *cb, .limit = limit};
}

static void uncount(struct slc_shared_reads *shares, const struct slc_shared_region *region)
{
    shares->size -= region->size;
    shares->count--;
}

static void free_region(struct slc_shared_reads *shares, struct slc_shared_region *region)
{
    uncount(shares, region);
    slc_free(&shares->cb, region, 1, HEADER_SIZE + region->size);
}

void slc_shared_regions_free(const SluiceAllocationCallbacks *cb, struct slc_shared_region *region)
{
    struct slc_shared_region *next;
    for (; region; region = next) {
        next = region->next_by_source;
        slc_free(cb, region, 1, HEADER_SIZE + region->size);
    }
}

static void free_tables(struct slc_shared_reads *shares)
{
    slc_free(&shares->cb, shares->by_region, shares->bucket_count, sizeof *shares->by_region);
    slc_free(&shares->cb, shares->by_source, shares->bucket_count, sizeof *shares->by_source);
}

void slc_shared_reads_finish(struct slc_shared_reads *shares)
{
    struct slc_shared_region *dropped = NULL;
    slc_shared_reads_drop_all(shares, &dropped);
    slc_shared_regions_free(&shares->cb, dropped);
    assert(shares->count == 0 && shares->size == 0);
    free_tables(shares);
    *shares = (struct slc_shared_reads){0};
}

bool slc_shared_reads_are_on(const struct slc_shared_reads *shares)
{
    return shares->member_count > 1;
}

void slc_shared_reads_add_member(struct slc_shared_reads *shares)
{
    shares->member_count++;
}

void slc_shared_reads_remove_member(struct slc_shared_reads *shares,
                                    struct slc_shared_region **dropped)
{
    assert(shares->member_count > 0);
    shares->member_count--;
    if (!slc_shared_reads_are_on(shares))
        slc_shared_reads_drop_all(shares, dropped);
}

/* Tables ------------------------------------------------------------------------------------- */

static uint64_t mix(uint64_t hash, uint64_t value)
{
    hash = (hash ^ value) * 0x9E3779B97F4A7C15u;
    return hash ^ hash >> 32;
}

static struct slc_shared_region **source_bucket(const struct slc_shared_reads *shares,
                                                const SluiceImageSource *source)
{
    return &shares->by_source[mix(0, (uintptr_t)source) & (shares->bucket_count - 1)];
}

static struct slc_shared_region **region_bucket(const struct slc_shared_reads *shares,
                                                const SluiceImageSource *source,
                                                const SluiceImageRegion *at)
{
    uint64_t hash = mix(0, (uintptr_t)source);
    hash = mix(hash, (uint64_t)at->mipLevel << 32 | at->arrayLayer);
    hash = mix(hash, (uint64_t)at->x << 32 | at->y);
    hash = mix(hash, (uint64_t)at->width << 32 | at->height);
    return &shares->by_region[hash & (shares->bucket_count - 1)];
}

bool slc_shared_region_is_at(const struct slc_shared_region *region, const SluiceImageRegion *b)
{
    const SluiceImageRegion *a = &region->region;
    return a->mipLevel == b->mipLevel && a->arrayLayer == b->arrayLayer && a->x == b->x &&
           a->y == b->y && a->width == b->width && a->height == b->height;
}

static struct slc_shared_region *find(const struct slc_shared_reads *shares,
                                      const SluiceImageSource *source, const SluiceImageRegion *at)
{
    if (shares->bucket_count == 0)
        return NULL;
    struct slc_shared_region *region = *region_bucket(shares, source, at);
    while (region && (region->source != source || !slc_shared_region_is_at(region, at)))
        region = region->next_by_region;
    return region;
}

static void put(struct slc_shared_reads *shares, struct slc_shared_region *region)
{
    struct slc_shared_region **bucket = region_bucket(shares, region->source, &region->region);
    region->next_by_region = *bucket;
    *bucket = region;
    bucket = source_bucket(shares, region->source);
    region->next_by_source = *bucket;
    region->link_by_source = bucket;
    if (*bucket)
        (*bucket)->link_by_source = &region->next_by_source;
    *bucket = region;
}

/* Grows the tables. Without memory, chains become longer. False: there are no tables. */
static bool ensure_tables(struct slc_shared_reads *shares)
{
    uint32_t old_count = shares->bucket_count;
    uint32_t count = old_count ? 2 * old_count : LEAST_BUCKETS;
    if (shares->listed_count < old_count || old_count >= MOST_BUCKETS)
        return true;
    struct slc_shared_reads grown = *shares;
    grown.bucket_count = count;
    grown.by_region = slc_calloc(&shares->cb, count, sizeof *grown.by_region);
    grown.by_source = slc_calloc(&shares->cb, count, sizeof *grown.by_source);
    if (!grown.by_region || !grown.by_source) {
        free_tables(&grown);
        return old_count > 0;
    }
    for (uint32_t i = 0; i < old_count; i++) {
        struct slc_shared_region *next;
        for (struct slc_shared_region *region = shares->by_region[i]; region; region = next) {
            next = region->next_by_region;
            put(&grown, region);
        }
    }
    free_tables(shares);
    *shares = grown;
    return true;
}

/* Kept regions ------------------------------------------------------------------------------- */

static void keep(struct slc_shared_reads *shares, struct slc_shared_region *region)
{
    region->older = shares->newest;
    region->newer = NULL;
    if (shares->newest)
        shares->newest->newer = region;
    else
        shares->oldest = region;
    shares->newest = region;
}

static void unkeep(struct slc_shared_reads *shares, struct slc_shared_region *region)
{
    if (region->older)
        region->older->newer = region->newer;
    else
        shares->oldest = region->newer;
    if (region->newer)
        region->newer->older = region->older;
    else
        shares->newest = region->older;
    region->older = region->newer = NULL;
}

static bool is_kept(const struct slc_shared_region *region)
{
    return region->is_listed && region->holder_count == 0;
}

/* Unlists a region. True if it was kept, so that its memory can be freed. */
static bool unlist(struct slc_shared_reads *shares, struct slc_shared_region *region)
{
    struct slc_shared_region **link = region_bucket(shares, region->source, &region->region);
    while (*link != region)
        link = &(*link)->next_by_region;
    *link = region->next_by_region;
    *region->link_by_source = region->next_by_source;
    if (region->next_by_source)
        region->next_by_source->link_by_source = region->link_by_source;
    bool was_kept = is_kept(region);
    region->is_listed = false;
    shares->listed_count--;
    if (was_kept)
        unkeep(shares, region);
    return was_kept;
}

void slc_shared_reads_hide(struct slc_shared_reads *shares, struct slc_shared_region *region)
{
    if (region->is_listed && unlist(shares, region))
        free_region(shares, region);
}

static void evict(struct slc_shared_reads *shares)
{
    while (shares->size > shares->limit && shares->oldest) {
        shares->statistics.evictedCount++;
        slc_shared_reads_hide(shares, shares->oldest);
    }
}

/* Evicts the oldest region, and reuses its memory if it has the size. */
static struct slc_shared_region *reuse(struct slc_shared_reads *shares, size_t size)
{
    struct slc_shared_region *region = shares->oldest;
    if (!region || region->size != size || shares->size > shares->limit ||
        size <= shares->limit - shares->size)
        return NULL;
    unkeep(shares, region);
    region->holder_count = 1; /* keeps the memory */
    slc_shared_reads_hide(shares, region);
    shares->statistics.evictedCount++;
    return region;
}

/* Allocates a region. Evicts nothing without memory, or for a region that does not fit. */
static struct slc_shared_region *allocate(struct slc_shared_reads *shares, size_t size)
{
    if (size > SIZE_MAX - HEADER_SIZE)
        return NULL;
    struct slc_shared_region *region =
        slc_alloc_aligned(&shares->cb, 1, HEADER_SIZE + size, ALIGNMENT);
    if (!region)
        return NULL;
    shares->size += size;
    shares->count++;
    if (size <= shares->limit)
        evict(shares);
    return region;
}

static struct slc_shared_region *create(struct slc_shared_reads *shares, struct slc_read *read,
                                        const SluiceImageRegion *at, size_t size)
{
    struct slc_shared_region *region = reuse(shares, size);
    if (!region)
        region = allocate(shares, size);
    if (!region)
        return NULL;
    *region = (struct slc_shared_region){.texels = (unsigned char *)region + HEADER_SIZE,
                                         .source = read->source->source,
                                         .region = *at,
                                         .size = size,
                                         .reader = read,
                                         .holder_count = 1,
                                         .is_reading = true,
                                         .is_listed = true};
    shares->listed_count++;
    put(shares, region);
    if (shares->size > shares->statistics.keptPeakSize)
        shares->statistics.keptPeakSize = shares->size;
    return region;
}

enum slc_delivery slc_shared_reads_claim(struct slc_shared_reads *shares, struct slc_read *read,
                                         const SluiceImageRegion *at, size_t size,
                                         struct slc_shared_region **out)
{
    struct slc_shared_region *region = find(shares, read->source->source, at);
    *out = region;
    if (region && region->size == size) {
        if (region->is_reading)
            return SLC_DELIVER_WAIT;
        if (is_kept(region))
            unkeep(shares, region);
        region->holder_count++;
        shares->statistics.cachedCount++;
        return SLC_DELIVER_COPY;
    }
    if (region) /* has another format: the source has changed */
        slc_shared_reads_hide(shares, region);
    *out = NULL;
    if (read->is_copy)
        return SLC_DELIVER_WAIT;
    *out = ensure_tables(shares) ? create(shares, read, at, size) : NULL;
    shares->statistics.refusedCount += !*out;
    return *out ? SLC_DELIVER_READ : SLC_DELIVER_ALONE;
}

struct slc_read *slc_shared_reads_end(struct slc_shared_reads *shares,
                                      struct slc_shared_region *region, bool read)
{
    struct slc_read *waiting = region->waiting;
    region->waiting = NULL;
    region->reader = NULL;
    region->is_reading = false;
    if (!read)
        slc_shared_reads_hide(shares, region);
    for (const struct slc_read *each = waiting; read && each; each = each->next_waiting)
        region->holder_count++;
    return waiting;
}

void slc_shared_reads_release(struct slc_shared_reads *shares, struct slc_shared_region *region)
{
    assert(region->holder_count > 0);
    if (--region->holder_count > 0)
        return;
    if (region->is_listed && region->size > shares->limit) {
        shares->statistics.evictedCount++;
        region->holder_count = 1; /* not a kept region yet */
        slc_shared_reads_hide(shares, region);
        region->holder_count = 0;
    }
    if (!region->is_listed) {
        free_region(shares, region);
        return;
    }
    keep(shares, region);
    evict(shares);
}

struct slc_shared_region *slc_shared_reads_find_reading(const struct slc_shared_reads *shares,
                                                        const SluiceImageSource *source,
                                                        const SluiceImageRegion *at)
{
    struct slc_shared_region *region = find(shares, source, at);
    return region && region->is_reading ? region : NULL;
}

bool slc_shared_reads_keep(const struct slc_shared_reads *shares, const SluiceImageSource *source,
                           const SluiceImageRegion *at)
{
    const struct slc_shared_region *region = find(shares, source, at);
    return region && !region->is_reading;
}

void slc_shared_region_await(struct slc_shared_region *region, struct slc_read *read)
{
    assert(region->is_reading);
    read->next_waiting = region->waiting;
    region->waiting = read;
}

void slc_shared_region_leave(struct slc_shared_region *region, struct slc_read *read)
{
    struct slc_read **link = &region->waiting;
    while (*link != read)
        link = &(*link)->next_waiting;
    *link = read->next_waiting;
    read->next_waiting = NULL;
}

/* Dropping ----------------------------------------------------------------------------------- */

static void drop_bucket(struct slc_shared_reads *shares, struct slc_shared_region *region,
                        const SluiceImageSource *source, struct slc_shared_region **dropped)
{
    struct slc_shared_region *next;
    for (; region; region = next) {
        next = region->next_by_source;
        if (source && region->source != source)
            continue;
        shares->statistics.invalidatedCount++;
        if (!unlist(shares, region))
            continue;
        uncount(shares, region);
        region->next_by_source = *dropped;
        *dropped = region;
    }
}

void slc_shared_reads_drop(struct slc_shared_reads *shares, const SluiceImageSource *source,
                           struct slc_shared_region **dropped)
{
    if (shares->listed_count > 0)
        drop_bucket(shares, *source_bucket(shares, source), source, dropped);
}

void slc_shared_reads_drop_all(struct slc_shared_reads *shares, struct slc_shared_region **dropped)
{
    for (uint32_t i = 0; i < shares->bucket_count && shares->listed_count > 0; i++)
        drop_bucket(shares, shares->by_source[i], NULL, dropped);
}

void slc_shared_reads_write_statistics(const struct slc_shared_reads *shares,
                                       SluiceReadPoolStatistics *statistics)
{
    *statistics = shares->statistics;
    statistics->structSize = sizeof *statistics;
    statistics->memberCount = shares->member_count;
    statistics->keptSize = shares->size;
    statistics->keptCount = shares->count;
}
