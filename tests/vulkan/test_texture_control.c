/* State and control of single textures. */
#include "vulkan/control_reload.h"
#include "vulkan/control_stage.h"
#include "vulkan/control_strict.h"

#include <sluice/vulkan_explain.h>

#include <string.h>

static SluiceVulkanTextureState state_of(const struct stage *s, uint32_t texture,
                                         SluiceTextureRect rect)
{
    SluiceVulkanTextureState state = {.structSize = sizeof state};
    CHECK_OK(
        sluiceGetVulkanTextureState(s->streamer, s->textures[texture].textureId, &rect, &state));
    return state;
}

/* Returns the finest level with one tile over both (x, y) and (tx, ty). */
static uint32_t shared_level(uint32_t x, uint32_t y, uint32_t tx, uint32_t ty)
{
    uint32_t level = 0;
    while (x >> level != tx >> level || y >> level != ty >> level)
        level++;
    return level;
}

/* State ------------------------------------------------------------------------------------- */

static void a_texture_is_drawable_once_its_mip_tail_is_shown(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 100});
    uint32_t frame = 0;
    for (; frame < 10; frame++) {
        SluiceVulkanTextureState now = state_of(s, 1, (SluiceTextureRect){0});
        if (now.drawable)
            break;
        assert_int_equal(now.residentLevel, SLUICE_MIP_UNTOUCHED);
        assert_true(now.shownLevel == (float)SLUICE_MIP_UNTOUCHED);
        frames(s, 1);
    }
    assert_true(frame > 0 && frame < 10);
    assert_int_equal(state_of(s, 1, (SluiceTextureRect){0}).residentLevel, TAIL);
    assert_true(state_of(s, 1, (SluiceTextureRect){0}).shownLevel == TAIL);
    CHECK_OK(sluiceRemoveVulkanTexture(s->streamer, s->textures[1].textureId));
    SluiceVulkanTextureState gone = {.structSize = sizeof gone};
    CHECK_RESULT(sluiceGetVulkanTextureState(s->streamer, s->textures[1].textureId, NULL, &gone),
                 SLUICE_ERROR_STALE_TEXTURE);
    stage_finish(s);
}

static void states_of_rectangles_follow_what_is_resident(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 100});
    const uint32_t tx = 3, ty = 2;
    s->seen[2][ty * TILES + tx] = 0;
    frames(s, 10);
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++) {
            SluiceVulkanTextureState tile =
                state_of(s, 2, (SluiceTextureRect){x * 128 + 5, y * 128 + 127, 123, 1});
            assert_int_equal(tile.residentLevel, shared_level(x, y, tx, ty));
            assert_true(tile.drawable && tile.shownLevel == (float)tile.residentLevel);
            /* from here to the last texel */
            SluiceVulkanTextureState rest = state_of(
                s, 2,
                (SluiceTextureRect){x * 128 + 127, y * 128, SIZE - x * 128 - 127, SIZE - y * 128});
            assert_int_equal(rest.residentLevel, TAIL);
        }
    assert_int_equal(state_of(s, 2, (SluiceTextureRect){256, 256, 256, 128}).residentLevel, 1);
    assert_int_equal(state_of(s, 2, (SluiceTextureRect){256, 255, 256, 257}).residentLevel, 2);
    assert_int_equal(state_of(s, 1, (SluiceTextureRect){256, 256, 1, 1}).residentLevel, TAIL);
    stage_finish(s);
}

static void shown_levels_fade_to_resident_ones(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000, .residencyFadeTicks = 8});
    const SluiceTextureRect tile = {0, 0, 1, 1};
    frames(s, 6);
    s->seen[0][0] = 0;
    float before = state_of(s, 0, tile).shownLevel;
    assert_true(before == TAIL);
    uint32_t between = 0;
    for (uint32_t i = 0; i < 60; i++) {
        frames(s, 1);
        SluiceVulkanTextureState now = state_of(s, 0, tile);
        assert_true(now.shownLevel <= before && now.shownLevel >= (float)now.residentLevel);
        between += now.shownLevel > (float)now.residentLevel;
        before = now.shownLevel;
    }
    assert_true(before == 0.0f && between >= 8);
    stage_finish(s);
}

static void rectangles_outside_are_refused(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){0});
    const SluiceTextureRect wrong[] = {{0, 0, SIZE + 1, 1},
                                       {0, 0, 1, SIZE + 1},
                                       {1, 0, 0, 0},
                                       {0, 0, 0, 5},
                                       {SIZE, 0, 1, 1},
                                       {1, 1, SIZE, 1},
                                       {UINT32_MAX, 0, 1, 1},
                                       {5, 5, UINT32_MAX, UINT32_MAX},
                                       {0, UINT32_MAX, 1, UINT32_MAX}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        SluiceVulkanTextureState out = {.structSize = sizeof out, .residentLevel = 77};
        s->last[0] = 0;
        CHECK_RESULT(
            sluiceGetVulkanTextureState(s->streamer, s->textures[0].textureId, &wrong[i], &out),
            SLUICE_ERROR_INVALID_ARGUMENT);
        assert_true(strstr(s->last, "1024 x 1024") && out.residentLevel == 77);
    }
    SluiceVulkanTextureState unset = {0};
    CHECK_RESULT(sluiceGetVulkanTextureState(s->streamer, s->textures[0].textureId, NULL, &unset),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    stage_finish(s);
}

/* Requests ---------------------------------------------------------------------------------- */

static SluiceTextureRequestId request(struct stage *s, uint32_t texture, uint32_t level,
                                      SluiceTextureRect rect, uint64_t until)
{
    const SluiceVulkanTextureRequest info = {
        .structSize = sizeof info, .level = level, .rect = rect, .until = until};
    SluiceTextureRequestId id = 0;
    CHECK_OK(sluiceRequestVulkanTexture(s->streamer, s->textures[texture].textureId, &info, &id));
    assert_true(id != 0);
    return id;
}

static SluiceVulkanRequestProgress progress_of(const struct stage *s, SluiceTextureRequestId id)
{
    SluiceVulkanRequestProgress progress = {.structSize = sizeof progress};
    CHECK_OK(sluiceGetVulkanRequestProgress(s->streamer, id, &progress));
    return progress;
}

static uint32_t mapped_tiles(const struct stage *s)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(s->streamer, &stats));
    return stats.mappedTileCount;
}

static const SluiceTextureRect tile_3_2 = {3 * 128 + 7, 2 * 128 + 9, 1, 1};

static void a_request_loads_its_tiles_without_any_feedback(void **state)
{
    (void)state;
    struct stage *s = stage_init(
        &(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 4, .texturesPerFrame = 1});
    frames(s, 5);
    uint32_t before = mapped_tiles(s);
    SluiceTextureRequestId id = request(s, 1, 0, tile_3_2, UINT64_MAX);
    SluiceVulkanRequestProgress progress = progress_of(s, id);
    /* one tile of each regular level, and the mip tail */
    assert_true(progress.tileCount == TAIL + 1 && progress.residentTileCount == 1);
    assert_false(progress.ready || progress.over);
    uint32_t waited = 0;
    for (; !progress_of(s, id).ready && waited < 20; waited++)
        frames(s, 1);
    assert_true(waited >= 2 && waited <= 5); /* does not wait for a turn of four textures */
    frames(s, 40);
    assert_int_equal(progress_of(s, id).residentTileCount, TAIL + 1);
    assert_int_equal(mapped_tiles(s), before + TAIL);
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++)
            assert_int_equal(
                state_of(s, 1, (SluiceTextureRect){x * 128, y * 128, 128, 128}).residentLevel,
                shared_level(x, y, 3, 2));
    CHECK_OK(sluiceWithdrawVulkanRequest(s->streamer, id));
    frames(s, 40);
    assert_int_equal(mapped_tiles(s), before);
    stage_finish(s);
}

static void requests_are_over_at_their_time(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 3});
    frames(s, 5);
    uint32_t before = mapped_tiles(s);
    SluiceTextureRequestId late = request(s, 0, 1, tile_3_2, s->time);
    SluiceTextureRequestId id = request(s, 0, 1, tile_3_2, s->time + 20);
    for (uint32_t i = 1; i < 20; i++) {
        frames(s, 1);
        assert_true(progress_of(s, late).over && !progress_of(s, id).over);
    }
    assert_true(progress_of(s, id).ready && mapped_tiles(s) == before + TAIL - 1);
    frames(s, 1);
    SluiceVulkanRequestProgress end = progress_of(s, id);
    assert_true(end.over && !end.ready && end.tileCount == 0);
    assert_int_equal(mapped_tiles(s), before + TAIL - 1); /* the timeout has just begun */
    frames(s, 30);
    assert_int_equal(mapped_tiles(s), before);
    CHECK_OK(sluiceWithdrawVulkanRequest(s->streamer, id));
    stage_finish(s);
}

/* Returns the level that a tile of level 0 shows if regions hold these levels. */
static uint32_t expected_level(const uint8_t held[TILES * TILES], uint32_t x, uint32_t y)
{
    uint32_t finest = TAIL;
    for (uint32_t i = 0; i < TILES * TILES; i++) {
        uint32_t level = shared_level(x, y, i % TILES, i / TILES);
        level = held[i] > level ? held[i] : level;
        finest = level < finest ? level : finest;
    }
    return finest;
}

static void check_all_tiles(const struct stage *s, uint32_t texture,
                            const uint8_t held[TILES * TILES])
{
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++)
            assert_int_equal(
                state_of(s, texture, (SluiceTextureRect){x * 128, y * 128, 128, 128}).residentLevel,
                expected_level(held, x, y));
}

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static SluiceTextureRect random_rect(uint32_t *seed)
{
    uint32_t x = next_random(seed) % SIZE, y = next_random(seed) % SIZE;
    return (SluiceTextureRect){x, y, 1 + next_random(seed) % (SIZE - x),
                               1 + next_random(seed) % (SIZE - y)};
}

static void lower(uint8_t held[TILES * TILES], uint8_t level, SluiceTextureRect r)
{
    for (uint32_t i = 0; i < TILES * TILES; i++) {
        uint32_t x = i % TILES * 128, y = i / TILES * 128;
        if (x < r.x + r.width && x + 128 > r.x && y < r.y + r.height && y + 128 > r.y)
            held[i] = level < held[i] ? level : held[i];
    }
}

static void the_finer_of_feedback_and_requests_counts(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (uint32_t round = 0; round < 4; round++) {
        struct stage *s =
            stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 100});
        uint8_t held[TILES * TILES];
        for (uint32_t i = 0; i < TILES * TILES; i++)
            held[i] = s->seen[2][i] = (uint8_t)(next_random(&seed) % 40);
        SluiceTextureRequestId ids[40];
        for (uint32_t i = 0; i < 40; i++) {
            SluiceTextureRect rect = random_rect(&seed);
            uint8_t level = (uint8_t)(i % 10 ? 2 + i % 5 : i / 20);
            bool counts = i % 3 != 0;
            ids[i] = request(s, counts ? 2 : 3, level, rect, UINT64_MAX);
            if (counts)
                lower(held, level, rect);
        }
        for (uint32_t i = 0; i < 40; i += 3)
            CHECK_OK(sluiceWithdrawVulkanRequest(s->streamer, ids[i]));
        frames(s, 12);
        check_all_tiles(s, 2, held);
        assert_int_equal(state_of(s, 3, (SluiceTextureRect){0}).residentLevel, TAIL);
        stage_finish(s);
    }
}

static void requests_go_with_their_texture(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 5});
    SluiceTextureRequestId first = request(s, 3, 0, tile_3_2, UINT64_MAX);
    SluiceTextureRequestId kept = request(s, 2, 0, tile_3_2, UINT64_MAX);
    CHECK_OK(sluiceRemoveVulkanTexture(s->streamer, s->textures[3].textureId));
    assert_true(progress_of(s, first).over && !progress_of(s, kept).over);
    frames(s, 6);
    assert_true(progress_of(s, kept).ready);
    SluiceTextureRequestId next = request(s, 2, 0, tile_3_2, UINT64_MAX);
    assert_true(next != first && progress_of(s, first).over);
    CHECK_OK(sluiceWithdrawVulkanRequest(s->streamer, first));
    assert_true(progress_of(s, next).ready);
    const SluiceTextureRequestId wrong[] = {0, next + 1, next + ((uint64_t)1 << 32), UINT64_MAX};
    for (uint32_t i = 0; i < 4; i++) {
        SluiceVulkanRequestProgress progress = {.structSize = sizeof progress};
        CHECK_RESULT(sluiceWithdrawVulkanRequest(s->streamer, wrong[i]),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        CHECK_RESULT(sluiceGetVulkanRequestProgress(s->streamer, wrong[i], &progress),
                     SLUICE_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(s->last, "requestId"));
    }
    stage_finish(s);
}

static void followers_load_what_their_primary_requests(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 5});
    CHECK_OK(sluiceRemoveVulkanTexture(s->streamer, s->textures[3].textureId));
    frames(s, 4);
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                            .source = &s->faults.base,
                                            .primaryId = s->textures[2].textureId};
    CHECK_OK(sluiceAddVulkanTexture(s->streamer, &create, &s->textures[3]));
    const SluiceVulkanTextureRequest info = {
        .structSize = sizeof info, .rect = tile_3_2, .until = UINT64_MAX};
    CHECK_RESULT(sluiceRequestVulkanTexture(s->streamer, s->textures[3].textureId, &info, NULL),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(s->last, "primary"));
    CHECK_OK(sluiceRequestVulkanTexture(s->streamer, s->textures[2].textureId, &info, NULL));
    frames(s, 8);
    assert_int_equal(state_of(s, 3, tile_3_2).residentLevel, 0);
    stage_finish(s);
}

static void requests_survive_every_refused_allocation(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 5});
    frames(s, 4);
    uint64_t refused = 0;
    for (uint32_t i = 0; i < 40; i++) {
        const SluiceVulkanTextureRequest info = {
            .structSize = sizeof info, .level = i % 4, .rect = tile_3_2, .until = UINT64_MAX};
        SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
        for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
            s->memory.refuse_from = s->memory.calls + n;
            result = sluiceRequestVulkanTexture(s->streamer, s->textures[1].textureId, &info, NULL);
            refused += result != SLUICE_SUCCESS;
            assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        }
    }
    assert_int_equal(refused, 4); /* the scratch, and room for 16, 32 and 64 */
    s->memory.refuse_from = 0;    /* the manager cannot take the map */
    frames(s, 3);
    assert_int_equal(state_of(s, 1, tile_3_2).residentLevel, TAIL);
    s->memory.refuse_from = UINT64_MAX;
    frames(s, 6);
    assert_int_equal(state_of(s, 1, tile_3_2).residentLevel, 0);
    stage_finish(s);
}

/* Control ----------------------------------------------------------------------------------- */

static void limits_hold_for_feedback_and_requests_at_once(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000});
    memset(s->seen, 0, sizeof s->seen);
    for (uint32_t i = 0; i < TEXTURES; i++)
        set_control(s, i, (SluiceVulkanTextureControl){.finestLevel = i == 3 ? 99 : i});
    request(s, 1, 0, (SluiceTextureRect){0}, UINT64_MAX);
    frames(s, 10);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        assert_int_equal(state_of(s, i, (SluiceTextureRect){0}).residentLevel, i);
        assert_int_equal(state_of(s, i, tile_3_2).residentLevel, i);
    }
    for (uint32_t i = 0; i < TEXTURES; i++) /* long before the timeout */
        set_control(s, i, (SluiceVulkanTextureControl){.finestLevel = TAIL - i});
    frames(s, 4);
    assert_int_equal(mapped_tiles(s), TEXTURES + 4 + 16 + 4 + 64 + 16 + 4);
    frames(s, 8);
    for (uint32_t i = 0; i < TEXTURES; i++)
        assert_int_equal(state_of(s, i, (SluiceTextureRect){0}).residentLevel, TAIL - i);
    stage_finish(s);
}

static void a_bias_moves_feedback_and_not_requests(void **state)
{
    (void)state;
    uint32_t seed = 5;
    const int32_t biases[] = {1, -1, 32, -32};
    for (uint32_t round = 0; round < 4; round++) {
        struct stage *s =
            stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 100});
        uint8_t held[TILES * TILES];
        for (uint32_t i = 0; i < TILES * TILES; i++) {
            s->seen[0][i] = (uint8_t)(next_random(&seed) % 5 ? 255 : next_random(&seed) % 4);
            int32_t biased = s->seen[0][i] + biases[round];
            held[i] = s->seen[0][i] == 255 ? 255 : (uint8_t)(biased < 0 ? 0 : biased);
        }
        lower(held, 1, tile_3_2);
        set_control(s, 0, (SluiceVulkanTextureControl){.mipBias = biases[round]});
        request(s, 0, 1, tile_3_2, UINT64_MAX);
        frames(s, 10);
        check_all_tiles(s, 0, held);
        stage_finish(s);
    }
}

static void hidden_textures_leave_their_turns_and_their_tiles_stand_by(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){
        .feedbackTimeoutTicks = 1000, .texturesPerFrame = 1, .numExtraStandbyTiles = 1000});
    memset(s->seen, 1, sizeof s->seen);
    frames(s, 20);
    const uint32_t each = 16 + 4 + 1;
    assert_int_equal(mapped_tiles(s), TEXTURES * each);
    for (uint32_t i = 1; i < TEXTURES; i++)
        set_control(s, i, (SluiceVulkanTextureControl){.hidden = true});
    frames(s, 2);
    assert_int_equal(mapped_tiles(s), each + (TEXTURES - 1)); /* and mip tails */
    assert_int_equal(statistics(s).standbyTileCount, (TEXTURES - 1) * (each - 1));
    memset(s->seen[0], 0, sizeof s->seen[0]);
    frames(s, 5); /* its turn comes in each frame */
    assert_int_equal(state_of(s, 0, (SluiceTextureRect){0}).residentLevel, 0);
    assert_int_equal(statistics(s).standbyTileCount, (TEXTURES - 1) * (each - 1));
    SluiceTextureRequestId id = request(s, 2, 1, (SluiceTextureRect){0}, UINT64_MAX);
    frames(s, 2);
    assert_int_equal(statistics(s).standbyTileCount, (TEXTURES - 2) * (each - 1));
    CHECK_OK(sluiceWithdrawVulkanRequest(s->streamer, id));
    frames(s, 2);
    assert_int_equal(statistics(s).standbyTileCount, (TEXTURES - 1) * (each - 1));
    const uint64_t read = statistics(s).bytesRead;
    for (uint32_t i = 1; i < TEXTURES; i++)
        set_control(s, i, (SluiceVulkanTextureControl){0});
    frames(s, 12);
    assert_int_equal(mapped_tiles(s), 64 + TEXTURES * each);
    assert_int_equal(statistics(s).bytesRead, read);
    stage_finish(s);
}

static void evicted_tiles_are_unmapped_with_the_next_frame(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 1000,
                                                                   .numExtraStandbyTiles = 1000});
    memset(s->seen[0], 0, sizeof s->seen[0]);
    memset(s->seen[1], 0, sizeof s->seen[1]);
    frames(s, 8);
    memset(s->seen, SLUICE_MIP_UNTOUCHED, sizeof s->seen);
    frames(s, 2);
    assert_int_equal(mapped_tiles(s), 2 * (64 + 16 + 4) + TEXTURES);
    const uint64_t before = statistics(s).tilesUnmapped;
    CHECK_OK(sluiceEvictVulkanTexture(s->streamer, s->textures[0].textureId, 0));
    CHECK_OK(sluiceEvictVulkanTexture(s->streamer, s->textures[1].textureId, 20));
    frames(s, 1);
    assert_int_equal(statistics(s).tilesUnmapped, before + 64 + 16 + 4 + 64);
    assert_int_equal(state_of(s, 0, (SluiceTextureRect){0}).residentLevel, TAIL);
    assert_int_equal(state_of(s, 1, (SluiceTextureRect){0}).residentLevel, 1);
    frames(s, 10);
    assert_int_equal(mapped_tiles(s), TEXTURES);
    stage_finish(s);
}

static void primaries_change_while_textures_stream(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 4});
    const SluiceTextureId id = s->textures[0].textureId, other = s->textures[1].textureId;
    memset(s->seen[0], 2, sizeof s->seen[0]);
    s->seen[1][2 * TILES + 3] = 0;
    SluiceTextureRequestId pin = request(s, 0, 1, (SluiceTextureRect){0}, UINT64_MAX);
    set_control(s, 0, (SluiceVulkanTextureControl){.finestLevel = 1, .hidden = true});
    frames(s, 10);
    assert_int_equal(state_of(s, 0, (SluiceTextureRect){0}).residentLevel, 1);
    uint64_t maps = statistics(s).feedbackMaps;
    CHECK_OK(sluiceSetVulkanPrimaryTexture(s->streamer, id, other));
    assert_true(progress_of(s, pin).over);
    SluiceVulkanTextureControl control = {.structSize = sizeof control};
    CHECK_RESULT(sluiceGetVulkanTextureControl(s->streamer, id, &control),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    frames(s, 20);
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++) {
            const SluiceTextureRect tile = {x * 128, y * 128, 128, 128};
            assert_int_equal(state_of(s, 0, tile).residentLevel, shared_level(x, y, 3, 2));
            assert_int_equal(state_of(s, 1, tile).residentLevel, shared_level(x, y, 3, 2));
        }
    assert_int_equal(statistics(s).feedbackMaps, maps + 1 + 20 * (TEXTURES - 1));
    CHECK_RESULT(sluiceSetVulkanPrimaryTexture(s->streamer, other, s->textures[2].textureId),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(s->last, "followers of its own"));
    CHECK_RESULT(sluiceSetVulkanPrimaryTexture(s->streamer, s->textures[2].textureId, id),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceSetVulkanPrimaryTexture(s->streamer, id, other)); /* no change */
    const uint64_t calls = s->memory.calls;
    CHECK_OK(sluiceSetVulkanPrimaryTexture(s->streamer, id, SLUICE_NO_TEXTURE));
    CHECK_OK(sluiceSetVulkanPrimaryTexture(s->streamer, id, SLUICE_NO_TEXTURE));
    assert_int_equal(s->memory.calls, calls);
    CHECK_OK(sluiceGetVulkanTextureControl(s->streamer, id, &control));
    assert_true(control.finestLevel == 0 && !control.hidden);
    frames(s, 20);
    assert_int_equal(state_of(s, 0, (SluiceTextureRect){0}).residentLevel, 2);
    assert_int_equal(state_of(s, 0, tile_3_2).residentLevel, 2);
    CHECK_OK(sluiceRemoveVulkanTexture(s->streamer, other));
    frames(s, 3);
    stage_finish(s);
}

/* Tile 3, 2 of 8 x 8 becomes 5.5 to 7.5, 4 to 6: tiles 5 to 7, 4 and 5. At level 1 these are tiles
 * 2 to 3, 2. The given wrap is ignored. */
static void followers_load_where_their_transform_samples(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){.feedbackTimeoutTicks = 4});
    const SluiceUvTransform two = {
        .scaleU = 2, .scaleV = 2, .offsetU = -0.0625f, .wrapU = SLUICE_UV_WRAP_CLAMP};
    CHECK_OK(sluiceSetVulkanPrimaryTexture(s->streamer, s->textures[0].textureId,
                                           s->textures[1].textureId));
    CHECK_OK(sluiceSetVulkanUvTransform(s->streamer, s->textures[0].textureId, &two));
    s->seen[1][2 * TILES + 3] = 0;
    frames(s, 10);
    for (uint32_t y = 0; y < TILES; y++)
        for (uint32_t x = 0; x < TILES; x++) {
            const SluiceTextureRect tile = {x * 128, y * 128, 128, 128};
            uint32_t level = x < 4 || y < 4 ? TAIL : y < 6 ? 1 : 2;
            assert_int_equal(state_of(s, 0, tile).residentLevel, level);
        }
    CHECK_OK(sluiceSetVulkanUvTransform(s->streamer, s->textures[0].textureId, NULL));
    frames(s, 20);
    assert_int_equal(state_of(s, 0, tile_3_2).residentLevel, 0);
    stage_finish(s);
}

static void transforms_survive_every_refused_allocation(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){0});
    const SluiceUvTransform eight = {.scaleU = 8, .scaleV = 8};
    const SluiceTextureId id = s->textures[0].textureId;
    s->memory.refuse_from = s->memory.calls;
    CHECK_RESULT(sluiceSetVulkanUvTransform(s->streamer, id, &eight),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    s->memory.refuse_from = UINT64_MAX;
    CHECK_OK(sluiceSetVulkanUvTransform(s->streamer, id, &eight));
    CHECK_RESULT(sluiceSetVulkanUvTransform(s->streamer, id, &(SluiceUvTransform){0}),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(s->last, "scale 0, 0, offset 0, 0"));
    stage_finish(s);
}

static void controls_survive_every_refused_allocation(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){0});
    const SluiceTextureId id = s->textures[0].textureId;
    SluiceVulkanTextureControl control = {.structSize = sizeof control, .mipBias = -33};
    CHECK_RESULT(sluiceSetVulkanTextureControl(s->streamer, id, &control),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(s->last, "mipBias is -33"));
    control.mipBias = -32;
    s->memory.refuse_from = s->memory.calls;
    CHECK_RESULT(sluiceSetVulkanTextureControl(s->streamer, id, &control),
                 SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    CHECK_OK(sluiceGetVulkanTextureControl(s->streamer, id, &control));
    assert_int_equal(control.mipBias, 0);
    s->memory.refuse_from = UINT64_MAX;
    control.priority = 17;
    CHECK_RESULT(sluiceSetVulkanTextureControl(s->streamer, id, &control),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(s->last, "priority is 17"));
    set_control(s, 0,
                (SluiceVulkanTextureControl){
                    .finestLevel = 2, .mipBias = 3, .hidden = true, .priority = -5});
    CHECK_OK(sluiceGetVulkanTextureControl(s->streamer, id, &control));
    assert_true(control.finestLevel == 2 && control.mipBias == 3 && control.hidden);
    assert_int_equal(control.priority, -5);
    stage_finish(s);
}

static void questions_take_no_memory(void **state)
{
    (void)state;
    struct stage *s = stage_init(&(SluiceVulkanStreamerCreateInfo){0});
    frames(s, 3);
    SluiceTextureRequestId id = request(s, 0, 0, tile_3_2, UINT64_MAX);
    uint64_t calls = s->memory.calls;
    s->memory.refuse_from = 0;
    SluiceVulkanTextureState all = {.structSize = sizeof all};
    CHECK_OK(sluiceGetVulkanTextureState(s->streamer, s->textures[0].textureId, NULL, &all));
    SluiceVulkanLoadStages stages = {.structSize = sizeof stages};
    CHECK_OK(sluiceGetVulkanLoadStages(s->streamer, &stages));
    SluiceVulkanExplanation why = {.structSize = sizeof why};
    CHECK_OK(sluiceExplainVulkanTexture(s->streamer, s->textures[0].textureId, NULL, &why));
    uint8_t levels[TILES * TILES];
    CHECK_OK(sluiceWriteVulkanFeedback(s->streamer, s->textures[0].textureId, TILES, sizeof levels,
                                       levels));
    assert_int_equal(progress_of(s, id).tileCount, TAIL + 1);
    SluiceVulkanTextureControl control = {.structSize = sizeof control};
    CHECK_OK(sluiceGetVulkanTextureControl(s->streamer, s->textures[0].textureId, &control));
    CHECK_OK(sluiceEvictVulkanTexture(s->streamer, s->textures[0].textureId, 0));
    CHECK_OK(sluiceWithdrawVulkanRequest(s->streamer, id));
    assert_true(s->memory.calls == calls && all.drawable);
    s->memory.refuse_from = UINT64_MAX;
    stage_finish(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texture_is_drawable_once_its_mip_tail_is_shown),
        cmocka_unit_test(states_of_rectangles_follow_what_is_resident),
        cmocka_unit_test(shown_levels_fade_to_resident_ones),
        cmocka_unit_test(rectangles_outside_are_refused),
        cmocka_unit_test(a_request_loads_its_tiles_without_any_feedback),
        cmocka_unit_test(requests_are_over_at_their_time),
        cmocka_unit_test(the_finer_of_feedback_and_requests_counts),
        cmocka_unit_test(requests_go_with_their_texture),
        cmocka_unit_test(followers_load_what_their_primary_requests),
        cmocka_unit_test(requests_survive_every_refused_allocation),
        cmocka_unit_test(limits_hold_for_feedback_and_requests_at_once),
        cmocka_unit_test(a_bias_moves_feedback_and_not_requests),
        cmocka_unit_test(hidden_textures_leave_their_turns_and_their_tiles_stand_by),
        cmocka_unit_test(evicted_tiles_are_unmapped_with_the_next_frame),
        cmocka_unit_test(primaries_change_while_textures_stream),
        cmocka_unit_test(followers_load_where_their_transform_samples),
        cmocka_unit_test(transforms_survive_every_refused_allocation),
        cmocka_unit_test(controls_survive_every_refused_allocation),
        cmocka_unit_test(questions_take_no_memory),
        cmocka_unit_test(changed_tiles_are_copied_again_in_place),
        cmocka_unit_test(mip_tails_and_all_tiles_are_copied_again),
        cmocka_unit_test(a_reload_that_fails_keeps_the_old_texels),
        cmocka_unit_test(a_refused_reload_of_a_mip_tail_is_tried_again),
        cmocka_unit_test(given_up_tiles_are_tried_again_after_a_change),
        cmocka_unit_test(a_replaced_source_is_in_use_until_its_reads_end),
        cmocka_unit_test(waits_end_with_reads_and_ask_for_frames),
        cmocka_unit_test(waits_tell_of_failures_and_of_requests_that_are_over),
        cmocka_unit_test(sources_of_another_shape_are_refused),
        cmocka_unit_test(equal_tiles_get_pages_of_their_own),
        cmocka_unit_test(reloads_survive_every_refused_allocation),
        cmocka_unit_test(unpaired_frames_are_reported),
        cmocka_unit_test(frames_that_are_never_signaled_are_reported_once),
        cmocka_unit_test(a_semaphore_that_is_late_by_a_moment_is_waited_for),
        cmocka_unit_test(frames_without_feedback_are_reported),
        cmocka_unit_test(exhausted_heaps_are_reported),
        cmocka_unit_test(sources_in_use_are_reported_and_kept),
        cmocka_unit_test(each_step_of_a_load_is_told),
        cmocka_unit_test(what_the_application_decides_is_told),
        cmocka_unit_test(what_nobody_sees_is_told),
        cmocka_unit_test(memory_that_is_short_is_told),
        cmocka_unit_test(failed_loads_are_told),
        cmocka_unit_test(fades_are_told),
        cmocka_unit_test(followers_are_explained_by_their_primary),
        cmocka_unit_test(feedback_is_written_as_shaders_marked_it),
        cmocka_unit_test(stages_of_loads_are_counted_in_frames),
        cmocka_unit_test(explanations_agree_with_the_state_of_each_tile),
    };
    return RUN_TESTS(tests);
}
