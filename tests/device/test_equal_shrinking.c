/* Memory falls although most pages have several equal tiles. */
#include "device/demand_runner.h"
#include "device/scene.h"

#include "support/test.h"

#include <math.h>
#include <stdio.h>

#define MIB (UINT64_C(1) << 20)
#define SIZE 2048u
#define TILE 128u
#define ALL 16u /* tiles of level 0 along an edge */
#define LEVELS 4u

static struct harness h;
static struct scene scene;

/* Tiles 2k and 2k + 1 of a level are equal. */
static uint32_t content_of(uint32_t level, uint32_t x, uint32_t y)
{
    return (y * (ALL >> level) + x) / 2;
}

static void color_of(uint32_t level, uint32_t x, uint32_t y, float rgba[4])
{
    uint32_t content = level < LEVELS ? content_of(level, x, y) : 0;
    rgba[0] = (float)(level + 1) / 16;
    rgba[1] = (float)(content % 16) / 16;
    rgba[2] = (float)(content / 16) / 16;
    rgba[3] = 1;
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)width, (void)height;
    color_of(level, x / TILE, y / TILE, rgba);
}

struct pairs {
    SluiceImageSource base;
    SluiceImageSource *inner;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct pairs *)base)->inner, info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    return sluiceReadImageRegion(((struct pairs *)base)->inner, region, texels, row_pitch);
}

static bool identify(SluiceImageSource *base, const SluiceImageRegion *region, uint64_t *identity)
{
    (void)base;
    *identity = (region->mipLevel + 1) * 1000 +
                content_of(region->mipLevel, region->x / TILE, region->y / TILE);
    return region->mipLevel < LEVELS;
}

static void destroy(SluiceImageSource *base)
{
    (void)base;
}

static const SluiceImageSourceInterface pairs_interface = {.structSize = sizeof pairs_interface,
                                                           .pfnGetInfo = get_info,
                                                           .pfnReadRegion = read_region,
                                                           .pfnDestroy = destroy,
                                                           .pfnIdentifyRegion = identify};

static struct pairs sources[2];

static uint64_t tile_memory(void)
{
    SluiceVulkanContextStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanContextStatistics(h.context, &s));
    return s.tileMemorySize;
}

static SluiceVulkanStreamerStatistics statistics(void)
{
    SluiceVulkanStreamerStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(scene.streamer, &s));
    return s;
}

static void open_pairs(struct pairs *source, SluiceFormat format)
{
    const SluiceProceduralImage image = {NULL, texel};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = SIZE,
                                  .height = SIZE,
                                  .format = format,
                                  .pName = "pairs"};
    *source = (struct pairs){.base.pInterface = &pairs_interface};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source->inner));
}

static void open_scene(uint32_t standby)
{
    const SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                                 .feedbackTimeoutTicks = 2,
                                                 .numExtraStandbyTiles = standby,
                                                 .heapTileCapacity = 16};
    scene_init(&scene, &h, info);
    for (uint32_t i = 0; i < 2; i++) {
        open_pairs(&sources[i], SLUICE_FORMAT_R8G8B8A8_UNORM);
        scene.textures[scene_add(&scene, &sources[i].base)].owns = false;
    }
}

static void close_scene(void)
{
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    scene_finish(&scene);
    for (uint32_t i = 0; i < 2; i++)
        sluiceDestroyImageSource(sources[i].inner);
}

/* Samples the middles of part x part tiles of level 0. */
static void look_at(uint32_t texture, uint32_t part)
{
    struct ProbeInput *inputs = scene_inputs(&scene, texture);
    for (uint32_t i = 0; i < part * part; i++)
        inputs[i] = (struct ProbeInput){
            .uv = {((float)(i % part) + 0.502f) / ALL, ((float)(i / part) + 0.502f) / ALL},
            .dx = {1.0f / SIZE, 0},
            .dy = {0, 1.0f / SIZE},
            .maxAnisotropy = 1};
    scene.textures[texture].sample_count = part * part;
}

static void color_at(const float uv[2], uint32_t level, float rgba[4])
{
    float size = (float)(SIZE >> level);
    color_of(level, (uint32_t)(uv[0] * size) / TILE, (uint32_t)(uv[1] * size) / TILE, rgba);
}

static void check_sample(const struct ProbeInput *in, const struct ProbeOutput *out)
{
    float fine[4], coarse[4];
    if (out->level == SLUICE_MIP_UNTOUCHED)
        return; /* nothing is resident yet */
    float lod = fmaxf(out->lod, (float)out->level), fraction = lod - floorf(lod);
    if (lod + 1 >= LEVELS)
        return; /* these levels blend near their edges */
    color_at(in->uv, (uint32_t)lod, fine);
    color_at(in->uv, (uint32_t)lod + 1, coarse);
    for (uint32_t i = 0; i < 4; i++) {
        float expected = fine[i] + (coarse[i] - fine[i]) * fraction;
        if (fabsf(out->color[i] - expected) > 3.0f / 255)
            fail_msg("channel %u at %g %g is %g, not %g", i, (double)in->uv[0], (double)in->uv[1],
                     (double)out->color[i], (double)expected);
    }
}

static void run_frames(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        scene_clear_outputs(&scene);
        scene_settle(&scene, 1);
        for (uint32_t t = 0; t < 2; t++)
            for (uint32_t j = 0; j < scene.textures[t].sample_count; j++)
                check_sample(&scene_inputs(&scene, t)[j], &scene_outputs(&scene, t)[j]);
    }
}

static void run_until_sharp(uint32_t limit)
{
    for (uint32_t i = 0; i < limit; i++) {
        run_frames(1);
        if (i > 6 && scene_missing(&scene) == 0)
            return;
    }
    fail_msg("%u samples are not sharp after %u frames", scene_missing(&scene), limit);
}

static void run_until_memory_is(uint64_t size, uint32_t limit)
{
    for (uint32_t i = 0; tile_memory() > size; i++) {
        if (i == limit)
            fail_msg("%u KiB after %u frames", (unsigned)(tile_memory() / 1024), i);
        run_frames(1);
    }
}

static void unneeded_equal_tiles_go_when_the_budget_falls(void **state)
{
    (void)state;
    open_scene(2000);
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    assert_true(tile_memory() > 20 * MIB);
    assert_true(statistics().tilesShared > 300);
    look_at(0, 2);
    scene.textures[1].sample_count = 0;
    run_frames(10);
    uint32_t mapped = statistics().mappedTileCount;
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 8 * MIB));
    run_until_memory_is(8 * MIB, 300);
    run_until_sharp(40);
    assert_int_equal(statistics().mappedTileCount, mapped);
    close_scene();
}

static void wanted_equal_tiles_go_when_the_budget_falls_below_them(void **state)
{
    (void)state;
    open_scene(0);
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    assert_true(tile_memory() > 20 * MIB);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 8 * MIB));
    run_until_memory_is(8 * MIB, 300);
    run_frames(40);
    printf("# %u tiles on %u KiB, %u samples blurred\n", statistics().mappedTileCount,
           (unsigned)(tile_memory() / 1024), scene_missing(&scene));
    assert_true(tile_memory() <= 8 * MIB);
    assert_true(scene_missing(&scene) > 0);
    assert_true(statistics().mappedTileCount > 64);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    run_until_sharp(200);
    close_scene();
}

static void equal_tiles_are_moved_together_on_request(void **state)
{
    (void)state;
    uint32_t count = 1, i;
    open_scene(0);
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    look_at(0, 6);
    look_at(1, 6);
    run_frames(70); /* images that run empty are freed */
    uint64_t before = tile_memory();
    uint32_t mapped = statistics().mappedTileCount;
    for (i = 0; i < 60 && count > 0; i++) {
        CHECK_OK(sluiceCompactVulkanStreamer(scene.streamer, 64, &count));
        run_frames(1);
        assert_int_equal(scene_missing(&scene), 0);
    }
    assert_int_equal(count, 0);
    run_frames(6);
    printf("# from %u to %u KiB in %u frames\n", (unsigned)(before / 1024),
           (unsigned)(tile_memory() / 1024), i);
    assert_true(tile_memory() <= 5 * MIB);
    assert_int_equal(statistics().mappedTileCount, mapped);
    close_scene();
}

/* Images of pages have one format each: the streamer's must be emptied. */
static void unneeded_equal_tiles_give_way_to_a_loader(void **state)
{
    (void)state;
    static struct runner r;
    static struct runner_image image;
    uint32_t rounds = 0;
    open_scene(2000);
    look_at(0, ALL);
    look_at(1, ALL);
    run_until_sharp(60);
    look_at(0, 2);
    scene.textures[1].sample_count = 0;
    run_frames(10);
    h.quiet = true;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R16G16B16A16_SFLOAT, 1024, 1024, 7);
    SluiceDemandTextureId texture = runner_add_texture(&r, &image);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, tile_memory() + MIB));
    for (uint32_t i = 0; i < 64; i++)
        runner_add_texel(&r, texture, 1024, 1024, 0, i % 8 * TILE + 5, i / 8 * TILE + 9);
    do {
        run_frames(1);
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    } while ((r.requests.missingCount > 0 || r.requests.lodBias > 1) && ++rounds < 200);
    printf("# %u launches, lod bias %g\n", rounds, (double)r.requests.lodBias);
    assert_true(rounds < 200);
    assert_true(runner_all_resident(&r));
    h.quiet = false;
    runner_finish(&r);
    runner_image_finish(&image);
    close_scene();
}

/* Gives all whole tiles of the source the same identity. */
static bool identify_all(SluiceImageSource *base, const SluiceImageRegion *region,
                         uint64_t *identity)
{
    (void)base;
    *identity = 1;
    return region->width == TILE && region->height == TILE;
}

static SluiceDemandTextureId add_demand(struct runner *r, struct pairs *source, uint32_t size,
                                        const SluiceImageSourceInterface *interface)
{
    const SluiceProceduralImage image = {NULL, texel};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = size,
                                  .height = size,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "equal"};
    *source = (struct pairs){.base.pInterface = interface};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source->inner));
    SluiceDemandTextureId id;
    const SluiceDemandTextureCreateInfo texture = {
        .structSize = sizeof texture,
        .image = {.source = &source->base, .pName = "equal"},
        .pSampler = &runner_nearest};
    CHECK_OK(sluiceAddDemandTexture(r->loader, &texture, &id));
    return id;
}

static void add_tiles(struct runner *r, SluiceDemandTextureId id, uint32_t edge, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        runner_add_texel(r, id, edge * TILE, edge * TILE, 0, i % edge * TILE + 3,
                         i / edge * TILE + 3);
}

/* The tails and the distinct tiles of one texture fill the first image of
 * pages, and stay. */
static void any_number_of_equal_tiles_leaves_an_image_of_a_loader_at_once(void **state)
{
    (void)state;
    enum { EDGE = 64 };
    static struct runner r;
    static struct pairs distinct, equal, more;
    SluiceImageSourceInterface none = pairs_interface, all = pairs_interface;
    none.pfnIdentifyRegion = NULL;
    all.pfnIdentifyRegion = identify_all;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 1u << 30};
    runner_init(&r, &h, &info);
    SluiceDemandTextureId a = add_demand(&r, &distinct, 1024, &none);
    SluiceDemandTextureId b = add_demand(&r, &equal, EDGE * TILE, &all);
    SluiceDemandTextureId c = add_demand(&r, &more, 1024, &none);
    runner_clear(&r);
    runner_add_texel(&r, b, EDGE * TILE, EDGE * TILE, 7, 0, 0);
    runner_add_texel(&r, c, 1024, 1024, 4, 0, 0);
    runner_add_texel(&r, a, 1024, 1024, 4, 0, 0);
    assert_true(runner_load(&r, 40) < 40);
    add_tiles(&r, a, 8, 64);
    assert_true(runner_load(&r, 40) < 40);
    add_tiles(&r, c, 8, 24);
    assert_true(runner_load(&r, 40) < 40);
    runner_clear(&r);
    add_tiles(&r, b, EDGE, EDGE * EDGE);
    assert_true(runner_load(&r, 100) < 100);
    assert_true(runner_statistics(&r).residentTileCount > EDGE * EDGE);
    runner_clear(&r);
    add_tiles(&r, a, 8, 64);
    assert_true(runner_load(&r, 40) < 40);
    uint64_t before = tile_memory();
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 4 * MIB + MIB / 4));
    for (uint32_t i = 0; i < 2; i++) {
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
    printf("# %u of %u KiB after two launches, %u tiles\n", (unsigned)(tile_memory() / 1024),
           (unsigned)(before / 1024), (unsigned)runner_statistics(&r).residentTileCount);
    assert_true(tile_memory() <= before / 2);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    runner_finish(&r);
    sluiceDestroyImageSource(distinct.inner);
    sluiceDestroyImageSource(equal.inner);
    sluiceDestroyImageSource(more.inner);
}

static void abandoned_frames_keep_no_memory(void **state)
{
    uint32_t before = h.abandon_one_in;
    h.abandon_one_in = 2;
    unneeded_equal_tiles_go_when_the_budget_falls(state);
    wanted_equal_tiles_go_when_the_budget_falls_below_them(state);
    equal_tiles_are_moved_together_on_request(state);
    h.abandon_one_in = before;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unneeded_equal_tiles_go_when_the_budget_falls),
        cmocka_unit_test(wanted_equal_tiles_go_when_the_budget_falls_below_them),
        cmocka_unit_test(equal_tiles_are_moved_together_on_request),
        cmocka_unit_test(unneeded_equal_tiles_give_way_to_a_loader),
        cmocka_unit_test(any_number_of_equal_tiles_leaves_an_image_of_a_loader_at_once),
        cmocka_unit_test(abandoned_frames_keep_no_memory),
    };
    int status = harness_init(&h);
    return status ? status : harness_finish(&h, RUN_TESTS(tests));
}
