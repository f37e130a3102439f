/** Feedback calls for a texture of 16384 x 16384 texels in tiles of 256 x 256: 4096 regions. */
#include "micro.h"

#include "figures.h"
#include "rig.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE = 16384, TILE = 256, MAPS = 64, PLENTY = 1u << 16, ROOM = 8192 };

static const SluiceStreamedTextureManagerConfig keep_everything = {
    .structSize = sizeof keep_everything,
    .numExtraStandbyTiles = PLENTY,
    .missesToExpire = 1, ///< otherwise alternating maps would be learned and held
};

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

/**
 * Draws the middle quarter of the map, from level 0 in front to level 2 at the back. `drop` of 1000
 * regions are missing.
 */
static void draw_window(const SluiceStreamedTextureDesc *desc, uint8_t *map, uint32_t drop,
                        uint32_t *random)
{
    uint32_t width = desc->width / desc->feedbackRegionWidth;
    uint32_t height = desc->height / desc->feedbackRegionHeight;
    memset(map, SLUICE_MIP_UNTOUCHED, region_count(desc));
    for (uint32_t y = 0; y < height / 2; y++)
        for (uint32_t x = 0; x < width / 2; x++)
            if (next_random(random) % 1000 >= drop)
                map[(height / 4 + y) * width + width / 4 + x] =
                    (uint8_t)((height / 2 - 1 - y) * 5 / height);
}

static void time_untouched(void)
{
    enum { BATCH = 64 };
    struct rig rig;
    struct samples samples;
    rig_init(&rig, 1024, &keep_everything, ROOM);
    SluiceStreamedTextureDesc desc = square_desc(SIZE, TILE);
    SluiceTextureId id = rig_add(&rig, &desc);
    rig_drain(&rig);
    uint8_t *map = must_allocate(region_count(&desc));
    memset(map, SLUICE_MIP_UNTOUCHED, region_count(&desc));
    SluiceFeedbackDesc feedback = map_for(&desc, map);
    samples_init(&samples, repetitions(2000));
    for (uint32_t i = 0; i < samples.room; i++) {
        uint64_t start = now_ns();
        for (uint32_t k = 0; k < BATCH; k++)
            rig_feedback(&rig, id, &feedback, STEP, TIMEOUT);
        samples_add(&samples, (double)(now_ns() - start) / BATCH);
    }
    figure_times("feedback.untouched", &samples);
    samples_finish(&samples);
    free(map);
    rig_finish(&rig);
}

/** Repeats one map: a window, or level 0 everywhere. All its tiles are mapped. */
static void time_unchanged(const char *name, bool everywhere)
{
    enum { BATCH = 16 };
    struct rig rig;
    struct samples samples;
    uint32_t random = 1;
    rig_init(&rig, 1024, &keep_everything, ROOM);
    SluiceStreamedTextureDesc desc = square_desc(SIZE, TILE);
    SluiceTextureId id = rig_add(&rig, &desc);
    uint8_t *map = must_allocate(region_count(&desc));
    if (!everywhere)
        draw_window(&desc, map, 0, &random);
    SluiceFeedbackDesc feedback = map_for(&desc, map);
    for (uint32_t i = 0; i < 16; i++) {
        rig_feedback(&rig, id, &feedback, STEP, TIMEOUT);
        rig_drain(&rig);
    }
    samples_init(&samples, repetitions(2000));
    for (uint32_t i = 0; i < samples.room; i++) {
        uint64_t start = now_ns();
        for (uint32_t k = 0; k < BATCH; k++)
            rig_feedback(&rig, id, &feedback, STEP, TIMEOUT);
        samples_add(&samples, (double)(now_ns() - start) / BATCH);
    }
    figure_times(name, &samples);
    samples_finish(&samples);
    free(map);
    rig_finish(&rig);
}

/** Each map lacks a different 30 % of the window's regions. Six maps are in use at a time. */
static void time_stochastic(void)
{
    struct rig rig;
    struct samples samples;
    uint32_t random = 1;
    rig_init(&rig, 1024, &keep_everything, ROOM);
    SluiceStreamedTextureDesc desc = square_desc(SIZE, TILE);
    SluiceTextureId id = rig_add(&rig, &desc);
    uint32_t size = region_count(&desc);
    uint8_t *maps = must_allocate((size_t)MAPS * size);
    for (uint32_t i = 0; i < MAPS; i++)
        draw_window(&desc, maps + (size_t)i * size, 300, &random);
    for (uint32_t i = 0; i < MAPS; i++) {
        SluiceFeedbackDesc feedback = map_for(&desc, maps + (size_t)i * size);
        rig_feedback(&rig, id, &feedback, STEP, TIMEOUT);
        rig_drain(&rig);
    }
    samples_init(&samples, repetitions(5000));
    for (uint32_t i = 0; i < samples.room; i++) {
        SluiceFeedbackDesc feedback = map_for(&desc, maps + (size_t)(i % MAPS) * size);
        uint64_t start = now_ns();
        rig_feedback(&rig, id, &feedback, STEP, TIMEOUT);
        samples_add(&samples, (double)(now_ns() - start));
    }
    figure_times("feedback.stochastic", &samples);
    samples_finish(&samples);
    free(maps);
    rig_finish(&rig);
}

/** A new texture's first map requests everything: each tile becomes requested. */
static void time_all_first(void)
{
    struct rig rig;
    struct samples samples;
    rig_init(&rig, 1024, &keep_everything, ROOM);
    SluiceStreamedTextureDesc desc = square_desc(SIZE, TILE);
    uint8_t *map = must_allocate(region_count(&desc)); /* level 0 everywhere */
    SluiceFeedbackDesc feedback = map_for(&desc, map);
    samples_init(&samples, repetitions(400));
    for (uint32_t i = 0; i < samples.room; i++) {
        SluiceTextureId id = rig_add(&rig, &desc);
        rig_drain(&rig);
        uint64_t start = now_ns();
        rig_feedback(&rig, id, &feedback, STEP, TIMEOUT);
        samples_add(&samples, (double)(now_ns() - start));
        if (i == 0)
            figure("feedback.all_first.requested", NULL, rig_statistics(&rig).requestedTileCount,
                   "tiles");
        must(sluiceRemoveStreamedTexture(rig.manager, id, 0), "remove");
    }
    figure_times("feedback.all_first", &samples);
    samples_finish(&samples);
    free(map);
    rig_finish(&rig);
}

/**
 * Alternates maps of level 0 and of level 1 everywhere, with everything mapped. Within the timeout
 * the texture continues to want level 0. If the timeout ends before the next map, all of level 0
 * changes between MAPPED and STANDBY.
 */
static void time_all_alternating(uint64_t timeout, const char *to_fine, const char *to_coarse)
{
    struct rig rig;
    struct samples samples[2];
    rig_init(&rig, 1024, &keep_everything, ROOM);
    SluiceStreamedTextureDesc desc = square_desc(SIZE, TILE);
    SluiceTextureId id = rig_add(&rig, &desc);
    uint32_t size = region_count(&desc);
    uint8_t *maps = must_allocate((size_t)2 * size);
    memset(maps + size, 1, size);
    SluiceFeedbackDesc feedback[2] = {map_for(&desc, maps), map_for(&desc, maps + size)};
    for (uint32_t i = 0; i < 16; i++) {
        rig_feedback(&rig, id, &feedback[i % 2], STEP, timeout);
        rig_drain(&rig);
    }
    for (uint32_t k = 0; k < 2; k++)
        samples_init(&samples[k], repetitions(2000));
    for (uint32_t i = 0; i < samples[0].room * 2; i++) {
        uint64_t start = now_ns();
        rig_feedback(&rig, id, &feedback[i % 2], STEP, timeout);
        samples_add(&samples[i % 2], (double)(now_ns() - start));
    }
    figure_times(to_fine, &samples[0]);
    figure_times(to_coarse, &samples[1]);
    for (uint32_t k = 0; k < 2; k++)
        samples_finish(&samples[k]);
    free(maps);
    rig_finish(&rig);
}

void bench_feedback(void)
{
    time_untouched();
    time_unchanged("feedback.window", false);
    time_unchanged("feedback.all", true);
    time_stochastic();
    time_all_first();
    time_all_alternating(TIMEOUT, "feedback.all_held_fine", "feedback.all_held_coarse");
    time_all_alternating(1, "feedback.all_to_fine", "feedback.all_to_coarse");
}

struct pair {
    struct rig rig;
    SluiceStreamedTextureDesc desc; ///< description of the primary
    SluiceTextureId primary, follower;
    uint8_t *maps;
    SluiceFeedbackDesc feedback[MAPS];
    uint32_t map_count;
};

/** Feeds the primary its `i`th map. */
static void lead(struct pair *pair, uint32_t i)
{
    rig_feedback(&pair->rig, pair->primary, &pair->feedback[i % pair->map_count], STEP, TIMEOUT);
}

static void match(struct pair *pair)
{
    must(sluiceMatchPrimaryTexture(pair->rig.manager, pair->primary, pair->follower, pair->rig.time,
                                   TIMEOUT),
         "match");
}

/** Makes two textures that have seen the window for a while and are mapped. */
static void pair_init(struct pair *pair, const SluiceStreamedTextureDesc *follower, uint32_t drop)
{
    uint32_t random = 1;
    *pair = (struct pair){.desc = square_desc(SIZE, TILE), .map_count = drop > 0 ? MAPS : 1};
    rig_init(&pair->rig, 1024, &keep_everything, ROOM);
    pair->primary = rig_add(&pair->rig, &pair->desc);
    pair->follower = rig_add(&pair->rig, follower);
    pair->maps = must_allocate((size_t)pair->map_count * region_count(&pair->desc));
    for (uint32_t i = 0; i < pair->map_count; i++) {
        uint8_t *map = pair->maps + (size_t)i * region_count(&pair->desc);
        draw_window(&pair->desc, map, drop, &random);
        pair->feedback[i] = map_for(&pair->desc, map);
    }
    for (uint32_t i = 0; i < MAPS; i++) {
        lead(pair, i);
        match(pair);
        rig_drain(&pair->rig);
    }
}

static void pair_finish(struct pair *pair)
{
    free(pair->maps);
    rig_finish(&pair->rig);
}

/** Times only the follower's call. */
static void time_match(const char *name, const SluiceStreamedTextureDesc *follower, uint32_t drop)
{
    struct pair pair;
    struct samples samples;
    pair_init(&pair, follower, drop);
    samples_init(&samples, repetitions(2000));
    for (uint32_t i = 0; i < samples.room; i++) {
        lead(&pair, i);
        uint64_t start = now_ns();
        match(&pair);
        samples_add(&samples, (double)(now_ns() - start));
    }
    figure_times(name, &samples);
    samples_finish(&samples);
    pair_finish(&pair);
}

/** Measures the primary's call with a follower minus the call without, in alternating batches. */
static void time_permanent_follower(void)
{
    enum { BATCH = 16 };
    struct pair pair;
    struct samples samples[2]; /* without, with */
    SluiceStreamedTextureDesc follower = square_desc(SIZE, TILE);
    pair_init(&pair, &follower, 0);
    for (uint32_t k = 0; k < 2; k++)
        samples_init(&samples[k], repetitions(1000));
    for (uint32_t i = 0; i < samples[0].room * 2; i++) {
        SluiceTextureId primary = i % 2 ? pair.primary : SLUICE_NO_TEXTURE;
        must(sluiceSetPrimaryTexture(pair.rig.manager, pair.follower, primary), "set primary");
        /* not timed: the first call after the change refills the history */
        for (uint32_t k = 0; k < 8; k++)
            lead(&pair, 0);
        uint64_t start = now_ns();
        for (uint32_t k = 0; k < BATCH; k++)
            lead(&pair, 0);
        samples_add(&samples[i % 2], (double)(now_ns() - start) / BATCH);
    }
    figure_times("follow.permanent_with_primary", &samples[1]);
    figure("follow.permanent", "median",
           (samples_quantile(&samples[1], 0.5) - samples_quantile(&samples[0], 0.5)) / 1e3, "us");
    for (uint32_t k = 0; k < 2; k++)
        samples_finish(&samples[k]);
    pair_finish(&pair);
}

void bench_follow(void)
{
    SluiceStreamedTextureDesc equal = square_desc(SIZE, TILE), half = square_desc(SIZE / 2, TILE),
                              finer_tiles = square_desc(SIZE, TILE / 2);
    time_match("follow.equal", &equal, 0);
    time_match("follow.half_size", &half, 0);
    time_match("follow.other_tiles", &finer_tiles, 0);
    time_match("follow.equal_stochastic", &equal, 300);
    time_permanent_follower();
}
