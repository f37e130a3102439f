#define _POSIX_C_SOURCE 200809L

#include "image/pool_rig.h"

#include "support/test.h"

#include <time.h>

/* Level 0: 64 y + x + `*user`. */
static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)width, (void)height;
    rgba[0] = (float)(10000 * level + SIZE * y + x) + *(const float *)user;
    rgba[1] = rgba[2] = rgba[3] = 0;
}

SluiceImageSource *create_image_of(SluiceFormat format, float *added)
{
    const SluiceImageInfo info = {
        .structSize = sizeof info, .width = SIZE, .height = SIZE, .format = format};
    const SluiceProceduralImage procedural = {added, texel};
    SluiceImageSource *image;
    CHECK_OK(sluiceCreateProceduralImageSource(&procedural, &info, NULL, &image));
    return image;
}

SluiceImageSource *create_image(float *added)
{
    return create_image_of(SLUICE_FORMAT_R32_SFLOAT, added);
}

void add_loader_of(struct pool_rig *r, uint32_t i, SluiceTileLoaderCreateInfo create)
{
    create.structSize = sizeof create;
    create.requestCapacity = create.requestCapacity ? create.requestCapacity : MOST;
    create.retry.maxAttempts = create.retry.maxAttempts ? create.retry.maxAttempts : 1;
    create.retry.firstDelayNs = create.retry.maxDelayNs = 1;
    create.readPool = r->pool;
    CHECK_OK(sluiceCreateTileLoader(&create, &r->loaders[i]));
}

void add_loader(struct pool_rig *r, uint32_t i)
{
    add_loader_of(r, i, (SluiceTileLoaderCreateInfo){0});
}

void pool_rig_init(struct pool_rig *r, uint32_t loaders, SluiceReadPoolCreateInfo create)
{
    *r = (struct pool_rig){.added = 0};
    r->inner = create_image(&r->added);
    fault_source_init(&r->source, r->inner);
    fault_source_init(&r->other, r->inner);
    create.structSize = sizeof create;
    CHECK_OK(sluiceCreateReadPool(&create, &r->pool));
    for (uint32_t i = 0; i < loaders; i++)
        add_loader(r, i);
}

void pool_rig_finish(struct pool_rig *r)
{
    for (uint32_t i = 0; i < LOADERS; i++)
        sluiceDestroyTileLoader(r->loaders[i]);
    sluiceDestroyReadPool(r->pool);
    fault_source_finish(&r->source);
    fault_source_finish(&r->other);
    sluiceDestroyImageSource(r->inner);
}

SluiceReadPoolStatistics statistics_of(const struct pool_rig *r)
{
    SluiceReadPoolStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetReadPoolStatistics(r->pool, &statistics));
    return statistics;
}

SluiceImageRegion region_at(uint32_t x)
{
    return (SluiceImageRegion){.x = x % SIZE, .y = x / SIZE, .width = 1, .height = 1};
}

void submit_regions(struct pool_rig *r, uint32_t loader, SluiceImageSource *source, uint32_t first,
                    uint32_t count, uint32_t priority)
{
    SluiceImageRegion regions[4];
    void *texels[4];
    for (uint32_t i = 0; i < count; i++) {
        regions[i] = region_at(first + i);
        texels[i] = &r->texels[loader][first + i];
        r->texels[loader][first + i] = -1;
    }
    const SluiceTileRead read = {.source = source,
                                 .regionCount = count,
                                 .pRegions = regions,
                                 .ppTexels = texels,
                                 .priority = priority,
                                 .userValue = first};
    CHECK_OK(sluiceSubmitTileRead(r->loaders[loader], &read, &r->tickets[loader][first]));
}

void submit(struct pool_rig *r, uint32_t loader, struct fault_source *source, uint32_t x)
{
    submit_regions(r, loader, &source->base, x, 1, 0);
}

void expect(struct pool_rig *r, uint32_t loader, uint32_t count, SluiceResult result)
{
    SluiceTileReadResult results[MOST];
    uint32_t found = MOST;
    CHECK_OK(sluiceWaitTileLoaderIdle(r->loaders[loader]));
    CHECK_OK(sluiceCollectTileReads(r->loaders[loader], &found, results));
    assert_int_equal(found, count);
    for (uint32_t i = 0; i < found; i++)
        CHECK_RESULT(results[i].result, result);
}

void expect_texel(const struct pool_rig *r, uint32_t loader, uint32_t x)
{
    assert_true(r->texels[loader][x] == (float)x + r->added);
}

void settle(struct pool_rig *r, uint32_t loader)
{
    uint64_t count = r->other.read_count;
    submit(r, loader, &r->other, MOST - 1 - (uint32_t)count); /* none twice: it would be kept */
    while (r->other.read_count == count)
        nanosleep(&(struct timespec){0, 50000}, NULL);
}

void join(struct pool_rig *r, uint32_t x)
{
    r->source.holds = true;
    submit(r, 0, &r->source, x);
    fault_source_await(&r->source, 1);
    submit_regions(r, 1, &r->source.base, x, 1, 1);
    settle(r, 1);
}
