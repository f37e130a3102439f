/*
 * An image with mostly constant tiles, in paged mode and in a demand loader. Equal tiles are read
 * once and share one page, in any order of showing, evicting and restoring.
 */
#include "device/demand_runner.h"
#include "device/scene.h"

#include "vulkan/page_pool.h"
#include "vulkan/streamer.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SIZE 1024u
#define TILE 128u
#define LEVELS 3u
#define TILES 84u /* in these levels; level 3 is packed in the streamer */
#define CONTENTS 7u
#define DISTINCT 8u /* contents over all levels */

/* 90 % of the tiles have content 0. The others have equal tiles, too. */
static uint32_t content_of(uint32_t level, uint32_t x, uint32_t y)
{
    uint32_t number = (y * 37 + x * 11 + level * 5) % 40;
    return number < 4 ? 1 + (number + level) % (CONTENTS - 1) : 0;
}

static void color_of(uint32_t level, uint32_t content, float color[4])
{
    color[0] = (float)(level + 1) / 16;
    color[1] = (float)content / 8;
    color[2] = 0;
    color[3] = 1;
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)width, (void)height;
    color_of(level, content_of(level, x / TILE, y / TILE), rgba);
}

struct equal_source {
    SluiceImageSource base;
    SluiceImageSource *inner;
    atomic_uint reads; ///< reads of the counted tiles
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct equal_source *)base)->inner, info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct equal_source *source = (struct equal_source *)base;
    if (region->mipLevel < LEVELS)
        atomic_fetch_add(&source->reads, 1);
    return sluiceReadImageRegion(source->inner, region, texels, row_pitch);
}

static bool identify(SluiceImageSource *base, const SluiceImageRegion *region, uint64_t *identity)
{
    (void)base;
    uint32_t content = content_of(region->mipLevel, region->x / TILE, region->y / TILE);
    *identity = region->mipLevel * CONTENTS + content;
    return region->mipLevel < LEVELS;
}

static void destroy(SluiceImageSource *base)
{
    (void)base;
}

static const SluiceImageSourceInterface equal_interface = {.structSize = sizeof equal_interface,
                                                           .pfnGetInfo = get_info,
                                                           .pfnReadRegion = read_region,
                                                           .pfnDestroy = destroy,
                                                           .pfnIdentifyRegion = identify};

static struct harness h;

struct stage {
    struct scene scene;
    struct runner runner;
    struct equal_source source;
    uint32_t streamed;
    SluiceDemandTextureId demand;
    struct {
        uint32_t level, x, y;
    } tiles[TILES], sampled[TILES];
    uint32_t sampled_count;
};

static void init(struct stage *s, uint64_t budget, uint64_t timeout)
{
    *s = (struct stage){.source.base.pInterface = &equal_interface};
    const SluiceProceduralImage image = {NULL, texel};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = SIZE,
                                  .height = SIZE,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "mostly constant"};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &s->source.inner));
    const SluiceDemandLoaderCreateInfo loader = {.structSize = sizeof loader,
                                                 .memoryBudget = budget};
    const SluiceVulkanStreamerCreateInfo streamer = {.structSize = sizeof streamer,
                                                     .feedbackTimeoutTicks = timeout};
    scene_init(&s->scene, &h, streamer);
    runner_init(&s->runner, &h, &loader);
    s->streamed = scene_add(&s->scene, &s->source.base);
    s->scene.textures[s->streamed].owns = false;
    const SluiceDemandTextureCreateInfo texture = {
        .structSize = sizeof texture,
        .image = {.source = &s->source.base, .pName = "mostly constant"},
        .pSampler = &runner_nearest};
    CHECK_OK(sluiceAddDemandTexture(s->runner.loader, &texture, &s->demand));
    uint32_t count = 0;
    for (uint32_t level = 0; level < LEVELS; level++)
        for (uint32_t i = 0; i < (SIZE / TILE >> level) * (SIZE / TILE >> level); i++, count++) {
            s->tiles[count].level = level;
            s->tiles[count].x = i % (SIZE / TILE >> level);
            s->tiles[count].y = i / (SIZE / TILE >> level);
        }
    assert_int_equal(count, TILES);
}

static void finish(struct stage *s)
{
    runner_finish(&s->runner);
    scene_finish(&s->scene);
    sluiceDestroyImageSource(s->source.inner);
}

static uint32_t held_pages(const struct stage *s)
{
    return s->scene.streamer->pages->held_count;
}

/* Samples the middle of each tile once. */
static void aim(struct stage *s, uint32_t one_in)
{
    struct ProbeInput *inputs = scene_inputs(&s->scene, s->streamed);
    s->sampled_count = 0;
    for (uint32_t i = 0; i < TILES; i++) {
        if (roll() % (int)one_in)
            continue;
        uint32_t size = SIZE >> s->tiles[i].level;
        float u = ((float)(s->tiles[i].x * TILE + TILE / 2) + 0.5f) / (float)size;
        float v = ((float)(s->tiles[i].y * TILE + TILE / 2) + 0.5f) / (float)size;
        inputs[s->sampled_count] = (struct ProbeInput){.uv = {u, v},
                                                       .dx = {1 / (float)size, 0},
                                                       .dy = {0, 1 / (float)size},
                                                       .maxAnisotropy = 1};
        s->sampled[s->sampled_count].level = s->tiles[i].level;
        s->sampled[s->sampled_count].x = s->tiles[i].x;
        s->sampled[s->sampled_count++].y = s->tiles[i].y;
    }
    s->scene.textures[s->streamed].sample_count = s->sampled_count;
    runner_clear(&s->runner);
    for (uint32_t i = 0; i < s->sampled_count; i++)
        runner_add_texel(&s->runner, s->demand, SIZE, SIZE, s->sampled[i].level,
                         s->sampled[i].x * TILE + TILE / 2, s->sampled[i].y * TILE + TILE / 2);
}

static void check_color(const float color[4], const float expected[4], float tolerance)
{
    for (uint32_t i = 0; i < 4; i++)
        if (fabsf(color[i] - expected[i]) > tolerance)
            fail_msg("channel %u is %g, not %g", i, (double)color[i], (double)expected[i]);
}

/* Color at a position that is not near a tile's edge. */
static void color_at(const float uv[2], uint32_t level, float color[4])
{
    float size = (float)(SIZE >> level);
    color_of(level,
             content_of(level, (uint32_t)(uv[0] * size) / TILE, (uint32_t)(uv[1] * size) / TILE),
             color);
}

/* Returns the number of samples that show their requested level. */
static uint32_t check_streamed(struct stage *s)
{
    uint32_t right = 0;
    assert_int_equal(scene_non_resident(&s->scene), 0);
    for (uint32_t i = 0; i < s->sampled_count; i++) {
        const struct ProbeInput *in = &scene_inputs(&s->scene, s->streamed)[i];
        const struct ProbeOutput *out = &scene_outputs(&s->scene, s->streamed)[i];
        float fine[4], coarse[4];
        if (out->level == SLUICE_MIP_UNTOUCHED)
            continue; /* nothing is resident yet */
        float lod = fmaxf(out->lod, (float)out->level), fraction = lod - floorf(lod);
        color_at(in->uv, (uint32_t)lod, fine);
        color_at(in->uv, (uint32_t)lod + 1, coarse);
        for (uint32_t j = 0; j < 4; j++)
            fine[j] += (coarse[j] - fine[j]) * fraction;
        check_color(out->color, fine, 2.0f / 255);
        right += lod < (float)s->sampled[i].level + 0.1f;
    }
    return right;
}

/* Under memory pressure the loader shows coarser levels. Returns the number of samples at their own
 * level. */
static uint32_t check_demand(struct stage *s)
{
    uint32_t right = 0;
    for (uint32_t i = 0; i < s->sampled_count; i++) {
        struct RunnerOutput out = runner_output(&s->runner, i);
        if (!out.resident)
            continue;
        uint32_t level = (uint32_t)lrintf(out.color[0] * 16) - 1;
        float expected[4];
        assert_in_range(level, s->sampled[i].level, 10);
        color_at(scene_inputs(&s->scene, s->streamed)[i].uv, level, expected);
        check_color(out.color, expected, 1.0f / 255);
        right += level == s->sampled[i].level;
    }
    return right;
}

static uint32_t count_distinct(const struct stage *s)
{
    uint32_t count = 0;
    bool seen[LEVELS][CONTENTS] = {0};
    for (uint32_t i = 0; i < TILES; i++) {
        bool *it =
            &seen[s->tiles[i].level][content_of(s->tiles[i].level, s->tiles[i].x, s->tiles[i].y)];
        count += !*it;
        *it = true;
    }
    return count;
}

static void equal_tiles_are_read_once_and_have_one_page(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, 0, 1000);
    aim(&s, 1);
    assert_int_equal(count_distinct(&s), DISTINCT);
    scene_settle(&s.scene, 40);
    assert_int_equal(check_streamed(&s), TILES);
    assert_int_equal(s.source.reads, DISTINCT);
    assert_int_equal(held_pages(&s), DISTINCT);
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s.scene.streamer, &stats));
    assert_int_equal(stats.tilesShared, TILES - DISTINCT);
    runner_load(&s.runner, 20);
    assert_int_equal(check_demand(&s), TILES);
    assert_int_equal(s.source.reads, DISTINCT);
    finish(&s);
}

static void a_loader_alone_reads_equal_tiles_once(void **state)
{
    static struct stage s;
    (void)state;
    for (int preloads = 0; preloads < 2; preloads++) {
        init(&s, 0, 1000);
        aim(&s, 1);
        if (preloads)
            CHECK_OK(sluicePreloadDemandTexture(s.runner.loader, s.demand, 0, NULL));
        uint32_t launches = runner_load(&s.runner, 40);
        printf("# %s: %u launches\n", preloads ? "with a preload" : "by requests", launches);
        assert_int_equal(check_demand(&s), TILES);
        assert_int_equal(s.source.reads, DISTINCT);
        assert_in_range(runner_statistics(&s.runner).residentTileCount, TILES, TILES + 2);
        assert_in_range(held_pages(&s), DISTINCT, DISTINCT + 2); /* level 3, and the tail */
        finish(&s);
    }
}

/* All sampled tiles become resident, in any history. */
static void wander(struct stage *s, uint32_t rounds)
{
    for (uint32_t i = 0; i < rounds; i++) {
        uint32_t one_in = 1 + (uint32_t)roll() % 8, frames = 1 + (uint32_t)roll() % 4;
        aim(s, one_in);
        for (uint32_t j = 0; j < frames; j++) {
            scene_clear_outputs(&s->scene);
            scene_settle(&s->scene, 1);
            check_streamed(s);
            runner_launch(&s->runner);
            check_demand(s);
            CHECK_OK(sluiceWaitDemandTicket(s->runner.loader, s->runner.ticket, UINT64_MAX, NULL));
        }
    }
}

/* The loader has memory for 64 tiles. The streamer drops tiles that three frames did not sample. */
static void tiles_go_and_come_in_any_order(void **state)
{
    static struct stage s;
    (void)state;
    uint32_t before = h.abandon_one_in;
    for (uint32_t abandon = 0; abandon < 3; abandon += 2) {
        roll_seed(5 + abandon);
        init(&s, (uint64_t)64 << 16, 3);
        h.abandon_one_in = abandon;
        wander(&s, 60);
        h.abandon_one_in = before;
        assert_in_range(held_pages(&s), 1, DISTINCT + 2);
        aim(&s, 1);
        scene_clear_outputs(&s.scene);
        scene_settle(&s.scene, 40);
        assert_int_equal(check_streamed(&s), TILES);
        assert_in_range(held_pages(&s), DISTINCT, DISTINCT + 2);
        printf("# %u reads of %u contents\n", s.source.reads, DISTINCT);
        finish(&s);
    }
}

/* Two textures of one source in one streamer. */
static void a_texture_that_goes_leaves_the_pages_of_the_other(void **state)
{
    static struct stage s;
    (void)state;
    init(&s, 0, 1000);
    aim(&s, 1);
    uint32_t other = scene_add(&s.scene, &s.source.base);
    s.scene.textures[other].owns = false;
    memcpy(scene_inputs(&s.scene, other), scene_inputs(&s.scene, s.streamed),
           TILES * sizeof(struct ProbeInput));
    s.scene.textures[other].sample_count = TILES;
    scene_settle(&s.scene, 40);
    assert_int_equal(s.source.reads, DISTINCT);
    assert_int_equal(held_pages(&s), DISTINCT);
    scene_remove(&s.scene, other);
    scene_settle(&s.scene, 10);
    assert_int_equal(held_pages(&s), DISTINCT);
    assert_int_equal(check_streamed(&s), TILES);
    scene_remove(&s.scene, s.streamed);
    s.sampled_count = 0;
    scene_settle(&s.scene, 10);
    assert_int_equal(held_pages(&s), 0);
    finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_tiles_are_read_once_and_have_one_page),
        cmocka_unit_test(a_loader_alone_reads_equal_tiles_once),
        cmocka_unit_test(tiles_go_and_come_in_any_order),
        cmocka_unit_test(a_texture_that_goes_leaves_the_pages_of_the_other),
    };
    int status = harness_init(&h);
    return status ? status : harness_finish(&h, RUN_TESTS(tests));
}
