/* Several loaders on the threads of one pool. */
#include "image/read_pool.h"

#include "support/fault_source.h"
#include "support/test.h"

#include <string.h>

enum { SIZE = 64, LOADERS = 3, MOST = 64 };

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)width, (void)height;
    rgba[0] = (float)(SIZE * y + x);
    rgba[1] = rgba[2] = rgba[3] = 0;
}

struct rig {
    struct slc_read_pool *pool;
    SluiceTileLoader *loaders[LOADERS];
    SluiceImageSource *inner;
    struct fault_source source, other;
    float texels[LOADERS][MOST];
};

static SluiceImageSource *create_image(void)
{
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = SIZE,
                                  .height = SIZE,
                                  .format = SLUICE_FORMAT_R32_SFLOAT};
    const SluiceProceduralImage procedural = {.pfnTexel = texel};
    SluiceImageSource *image;
    CHECK_OK(sluiceCreateProceduralImageSource(&procedural, &info, NULL, &image));
    return image;
}

static void init(struct rig *r, SluiceTileLoaderCreateInfo create)
{
    *r = (struct rig){.inner = create_image()};
    fault_source_init(&r->source, r->inner);
    fault_source_init(&r->other, r->inner);
    CHECK_OK(slc_read_pool_create(&create, &r->pool));
    create.requestCapacity = MOST;
    for (uint32_t i = 0; i < LOADERS; i++)
        CHECK_OK(slc_create_pool_loader(r->pool, &create, &r->loaders[i]));
}

static void finish(struct rig *r)
{
    for (uint32_t i = 0; i < LOADERS; i++)
        sluiceDestroyTileLoader(r->loaders[i]);
    slc_read_pool_destroy(r->pool);
    fault_source_finish(&r->source);
    fault_source_finish(&r->other);
    sluiceDestroyImageSource(r->inner);
}

/* Reads the texel (x, 0) into the loader's xth texel. */
static uint64_t submit(struct rig *r, uint32_t loader, struct fault_source *source, uint32_t x,
                       uint32_t priority)
{
    const SluiceImageRegion region = {.x = x, .width = 1, .height = 1};
    void *texels = &r->texels[loader][x];
    const SluiceTileRead read = {.source = &source->base,
                                 .regionCount = 1,
                                 .pRegions = &region,
                                 .ppTexels = &texels,
                                 .priority = priority,
                                 .userValue = 100 * loader + x};
    uint64_t ticket;
    CHECK_OK(sluiceSubmitTileRead(r->loaders[loader], &read, &ticket));
    return ticket;
}

static uint32_t collect(struct rig *r, uint32_t loader, SluiceTileReadResult *results)
{
    uint32_t count = MOST;
    CHECK_OK(sluiceCollectTileReads(r->loaders[loader], &count, results));
    return count;
}

static void a_read_comes_back_to_the_loader_that_submitted_it(void **state)
{
    (void)state;
    struct rig r;
    SluiceTileReadResult results[MOST];
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 2});
    for (uint32_t i = 0; i < LOADERS; i++)
        for (uint32_t x = 0; x < 10 + i; x++)
            submit(&r, i, x % 2 ? &r.source : &r.other, x, 0);
    for (uint32_t i = LOADERS; i-- > 0;) {
        sluiceWaitTileLoaderIdle(r.loaders[i]);
        uint32_t count = collect(&r, i, results);
        assert_int_equal(count, 10 + i);
        for (uint32_t k = 0; k < count; k++) {
            CHECK_OK(results[k].result);
            assert_int_equal(results[k].userValue / 100, i);
        }
        for (uint32_t x = 0; x < count; x++)
            assert_true(r.texels[i][x] == (float)x);
    }
    finish(&r);
}

/* The only thread is held by a first read. The next read is the other loader's, although the first
 * loader has more reads, more urgent and earlier ones. */
static void loaders_take_turns(void **state)
{
    (void)state;
    enum { MANY = 40, FEW = 5 };
    struct rig r;
    SluiceTileReadResult results[MOST];
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 1});
    r.source.holds = true;
    r.other.holds = true;
    submit(&r, 0, &r.source, 0, 9);
    fault_source_await(&r.source, 1);
    for (uint32_t x = 1; x < MANY; x++)
        submit(&r, 0, &r.source, x, 9);
    for (uint32_t x = 0; x < FEW; x++)
        submit(&r, 1, &r.other, x, 0);
    fault_source_release(&r.source);
    fault_source_await(&r.other, 1);
    assert_int_equal(r.source.read_count, 1);
    fault_source_release(&r.other);
    sluiceWaitTileLoaderIdle(r.loaders[1]);
    assert_int_equal(collect(&r, 1, results), FEW);
    sluiceWaitTileLoaderIdle(r.loaders[0]);
    assert_int_equal(collect(&r, 0, results), MANY);
    finish(&r);
}

static void a_source_has_one_limit_for_all_loaders(void **state)
{
    (void)state;
    struct rig r;
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 4,
                                          .maxReadsPerSource = 2});
    r.source.holds = true;
    for (uint32_t i = 0; i < LOADERS; i++)
        for (uint32_t x = 0; x < 8; x++)
            submit(&r, i, &r.source, x, 0);
    fault_source_await(&r.source, 2);
    submit(&r, 2, &r.other, 9, 0); /* threads are free for another source */
    while (r.other.read_count == 0)
        ;
    assert_int_equal(r.source.waiting, 2);
    fault_source_release(&r.source);
    for (uint32_t i = 0; i < LOADERS; i++)
        sluiceWaitTileLoaderIdle(r.loaders[i]);
    assert_int_equal(r.source.most_running, 2);
    assert_int_equal(r.source.read_count, 8 * LOADERS);
    finish(&r);
}

/* Room for one texel at a time. */
static void loaders_share_the_bytes_in_flight(void **state)
{
    (void)state;
    struct rig r;
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 4,
                                          .maxBytesInFlight = 4});
    r.source.delay_us = 200;
    for (uint32_t i = 0; i < LOADERS; i++)
        for (uint32_t x = 0; x < 8; x++)
            submit(&r, i, &r.source, x, 0);
    for (uint32_t i = 0; i < LOADERS; i++)
        sluiceWaitTileLoaderIdle(r.loaders[i]);
    assert_int_equal(r.source.most_running, 1);
    assert_int_equal(r.source.read_count, 8 * LOADERS);
    finish(&r);
}

static void a_loader_is_destroyed_while_others_read(void **state)
{
    (void)state;
    struct rig r;
    SluiceTileReadResult results[MOST];
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 2,
                                          .maxReadsPerSource = 1});
    r.source.holds = true;
    submit(&r, 1, &r.source, 0, 0);
    fault_source_await(&r.source, 1);
    for (uint32_t x = 0; x < 8; x++) {
        submit(&r, 0, &r.source, x, 0); /* none of them begins */
        submit(&r, 1, &r.source, x, 0);
    }
    sluiceDestroyTileLoader(r.loaders[0]);
    r.loaders[0] = NULL;
    fault_source_release(&r.source);
    sluiceWaitTileLoaderIdle(r.loaders[1]);
    assert_int_equal(collect(&r, 1, results), 9);
    for (uint32_t i = 0; i < 9; i++)
        CHECK_OK(results[i].result);
    assert_int_equal(r.source.read_count, 9);
    finish(&r);
}

static void statistics_are_of_one_loader(void **state)
{
    (void)state;
    struct rig r;
    SluiceTileLoaderStatistics stats = {.structSize = sizeof stats};
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 2});
    for (uint32_t x = 0; x < 7; x++)
        submit(&r, 0, &r.source, x, 0);
    for (uint32_t x = 0; x < 3; x++)
        submit(&r, 1, &r.source, x, 0);
    sluiceWaitTileLoaderIdle(r.loaders[0]);
    sluiceWaitTileLoaderIdle(r.loaders[1]);
    CHECK_OK(sluiceGetTileLoaderStatistics(r.loaders[0], &r.source.base, &stats));
    assert_int_equal(stats.succeededCount, 7);
    CHECK_OK(sluiceGetTileLoaderStatistics(r.loaders[1], &r.source.base, &stats));
    assert_int_equal(stats.succeededCount, 3);
    CHECK_OK(sluiceGetTileLoaderStatistics(r.loaders[2], NULL, &stats));
    assert_int_equal(stats.readCount, 0);
    finish(&r);
}

/* One loader drops a source with a stalled read. Another loader continues with it. */
static void a_source_is_forgotten_by_one_loader_alone(void **state)
{
    (void)state;
    struct rig r;
    SluiceTileReadResult results[MOST];
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 2,
                                          .maxReadsPerSource = 1});
    submit(&r, 0, &r.source, 0, 0);
    sluiceWaitTileLoaderIdle(r.loaders[0]);
    assert_int_equal(collect(&r, 0, results), 1);
    r.source.holds = true;
    submit(&r, 1, &r.source, 0, 0);
    fault_source_await(&r.source, 1);
    CHECK_OK(sluiceDropTileLoaderStatistics(r.loaders[0], &r.source.base));
    CHECK_RESULT(sluiceDropTileLoaderStatistics(r.loaders[1], &r.source.base), SLUICE_NOT_READY);
    submit(&r, 0, &r.source, 1, 0);
    assert_int_equal(r.source.waiting, 1); /* the new record knows the limit */
    fault_source_release(&r.source);
    sluiceWaitTileLoaderIdle(r.loaders[0]);
    assert_int_equal(collect(&r, 0, results), 1);
    assert_int_equal(r.source.most_running, 1);
    finish(&r);
}

/* A source that writes a pattern, and checks it afterwards. Records where it wrote. */
struct picky_source {
    SluiceImageSource base; ///< must be first
    const void *texels;     ///< address of the last read's texels
    SluiceResult answer;
};

static SluiceResult picky_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    (void)source;
    *info = (SluiceImageInfo){.structSize = sizeof *info,
                              .width = 256,
                              .height = 256,
                              .mipLevelCount = 1,
                              .format = SLUICE_FORMAT_R8G8B8A8_UNORM};
    return SLUICE_SUCCESS;
}

static SluiceResult picky_read(SluiceImageSource *base, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch)
{
    struct picky_source *source = (struct picky_source *)base;
    size_t size = row_pitch * region->height;
    source->texels = texels;
    memset(texels, 0x5a, size);
    for (size_t i = 1; i < size; i++)
        ((unsigned char *)texels)[i] = (unsigned char)(((unsigned char *)texels)[i - 1] + 1);
    return source->answer;
}

static void picky_destroy(SluiceImageSource *source)
{
    (void)source;
}

static const SluiceImageSourceInterface picky = {sizeof picky, picky_info, picky_read,
                                                 picky_destroy};

static SluiceResult read_picky(SluiceTileLoader *loader, struct picky_source *source, uint32_t rows,
                               unsigned char *texels)
{
    const SluiceImageRegion region = {.width = 256, .height = rows};
    void *to = texels;
    const SluiceTileRead read = {
        .source = &source->base, .regionCount = 1, .pRegions = &region, .ppTexels = &to};
    SluiceTileReadResult result;
    uint32_t count = 1;
    uint64_t ticket;
    CHECK_OK(sluiceSubmitTileRead(loader, &read, &ticket));
    sluiceWaitTileLoaderIdle(loader);
    CHECK_OK(sluiceCollectTileReads(loader, &count, &result));
    assert_int_equal(count, 1);
    return result.result;
}

static void sources_never_read_from_memory_that_is_not_cached(void **state)
{
    (void)state;
    enum { ROW = 1024, TILE = 64 * ROW };
    static unsigned char texels[2 * TILE];
    struct rig r;
    struct picky_source source = {.base = {&picky}, .answer = SLUICE_SUCCESS};
    init(&r, (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                          .threadCount = 1});
    CHECK_OK(read_picky(r.loaders[0], &source, 64, texels));
    assert_ptr_equal(source.texels, texels); /* reads directly, as usual */
    r.loaders[0]->uncached = true;
    memset(texels, 0, sizeof texels);
    CHECK_OK(read_picky(r.loaders[0], &source, 64, texels));
    assert_ptr_not_equal(source.texels, texels);
    for (uint32_t i = 0; i < sizeof texels; i++)
        assert_int_equal(texels[i], i < TILE ? (unsigned char)(0x5a + i) : 0);
    /* A failed read changes nothing. */
    memset(texels, 7, sizeof texels);
    source.answer = SLUICE_ERROR_CORRUPT_DATA;
    assert_int_equal(read_picky(r.loaders[0], &source, 64, texels), SLUICE_ERROR_CORRUPT_DATA);
    for (uint32_t i = 0; i < sizeof texels; i++)
        assert_int_equal(texels[i], 7);
    /* only tiles are read through the cache */
    source.answer = SLUICE_SUCCESS;
    CHECK_OK(read_picky(r.loaders[0], &source, 65, texels));
    assert_ptr_equal(source.texels, texels);
    /* Objects that are no images are found by their address. */
    r.loaders[0]->direct[1] = &picky;
    CHECK_OK(read_picky(r.loaders[0], &source, 64, texels));
    assert_ptr_equal(source.texels, texels);
    finish(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_read_comes_back_to_the_loader_that_submitted_it),
        cmocka_unit_test(loaders_take_turns),
        cmocka_unit_test(a_source_has_one_limit_for_all_loaders),
        cmocka_unit_test(loaders_share_the_bytes_in_flight),
        cmocka_unit_test(a_loader_is_destroyed_while_others_read),
        cmocka_unit_test(statistics_are_of_one_loader),
        cmocka_unit_test(a_source_is_forgotten_by_one_loader_alone),
        cmocka_unit_test(sources_never_read_from_memory_that_is_not_cached),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
