#include "core/fixture.h"

#include "core/check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static SluiceTextureId add(struct fixture *f, uint32_t width, uint32_t height, uint32_t tile_width,
                           uint32_t tile_height)
{
    SluiceStreamedTextureDesc desc = full_chain(width, height, tile_width, tile_height);
    return fixture_add(f, &desc);
}

/* Counts wanted tiles of one level. None has been handed out. */
static uint32_t requested_at(const struct fixture *f, SluiceTextureId id, uint32_t level)
{
    SluiceStreamedTextureLayout layout = fixture_layout(f, id);
    uint32_t count = 0;
    for (uint32_t i = 0; i < layout.tileCount; i++)
        count += fixture_state(f, id, i) == SLUICE_TILE_STATE_REQUESTED &&
                 fixture_tile(f, id, i).mipLevel == level;
    return count;
}

static uint32_t finest_requested(const struct fixture *f, SluiceTextureId id)
{
    for (uint32_t level = 0; level <= SLUICE_MAX_MIP_LEVELS; level++)
        if (requested_at(f, id, level))
            return level;
    return SLUICE_MIP_UNTOUCHED;
}

static void levels_shift_by_the_smaller_ratio_rounded_down(void **state)
{
    (void)state;
    static const struct {
        uint32_t width, height, primary_level, expected;
    } cases[] = {
        {512, 512, 0, 0},   {512, 512, 2, 2},   {256, 256, 0, 0},   {256, 256, 1, 0},
        {256, 256, 3, 2},   {1024, 1024, 0, 1}, {1024, 1024, 3, 4}, {1024, 256, 0, 0},
        {1024, 256, 1, 0},  {1024, 256, 2, 1},  {700, 700, 1, 1},   {1023, 1023, 1, 1},
        {1023, 1024, 0, 0}, {511, 511, 1, 0},   {511, 511, 2, 1},   {255, 2048, 3, 1},
        {2048, 2048, 1, 3}, {64, 64, 4, 1},     {2048, 4096, 0, 2},
    };
    for (uint32_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        SluiceTextureId primary = add(&f, 512, 512, 64, 64);
        SluiceTextureId follower = add(&f, cases[i].width, cases[i].height, 16, 16);
        fixture_feed(&f, primary, (uint8_t)cases[i].primary_level, 0, 0);
        CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, follower, 0, 0));
        assert_int_equal(finest_requested(&f, follower), cases[i].expected);
        SluiceStreamedTextureLayout layout = fixture_layout(&f, follower);
        assert_int_equal(requested_at(&f, follower, cases[i].expected),
                         layout.levelWidthInTiles[cases[i].expected] *
                             layout.levelHeightInTiles[cases[i].expected]);
        fixture_close(&f);
    }
}

/* Levels of the primary that are packed count by their own number. */
static void levels_are_those_asked_for_not_those_cut_into_tiles(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId primary = add(&f, 128, 128, 128, 128); /* one regular level */
    SluiceTextureId follower = add(&f, 1024, 1024, 16, 16);
    fixture_feed(&f, primary, 3, 0, 0);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, follower, 0, 0));
    assert_int_equal(finest_requested(&f, follower), 6);
    fixture_close(&f);
}

static void bias_and_limit_of_the_primary_go_over(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId primary = add(&f, 512, 512, 64, 64), a = add(&f, 512, 512, 16, 16),
                    b = add(&f, 512, 512, 16, 16);
    uint8_t map[64] = {0};
    SluiceFeedbackDesc feedback = {sizeof feedback, map, 8, 8, 2, 0};
    CHECK_OK(sluiceUpdateWithSamplerFeedback(f.manager, primary, &feedback, 0, 0));
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, a, 0, 0));
    assert_int_equal(finest_requested(&f, a), 2);
    feedback = (SluiceFeedbackDesc){
        sizeof(SluiceFeedbackDesc), map, 8, 8, 0, 1}; /* only the coarsest of 4 regular ones */
    CHECK_OK(sluiceUpdateWithSamplerFeedback(f.manager, primary, &feedback, 1, 0));
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, b, 1, 0));
    assert_int_equal(finest_requested(&f, b), 3);
    fixture_close(&f);
}

/* Returns whether region p of one axis and q of the other overlap: cuts [0, 1) into W * w cells. */
static bool overlap(uint32_t p, uint32_t p_region, uint32_t p_size, uint32_t q, uint32_t q_region,
                    uint32_t q_size)
{
    for (uint64_t cell = (uint64_t)p * p_region * q_size;
         cell < (uint64_t)p_size * q_size && cell / q_size / p_region == p; cell++)
        if (cell / p_size / q_region == q)
            return true;
    return false;
}

enum { MOST_REGIONS = 20 }; /* limit along one axis */

/* Regions of the primary and the follower that overlap, along x and along y. */
struct meeting {
    bool x[MOST_REGIONS][MOST_REGIONS], y[MOST_REGIONS][MOST_REGIONS];
};

static void meet(const SluiceStreamedTextureLayout *from, const SluiceStreamedTextureLayout *to,
                 struct meeting *out)
{
    const SluiceStreamedTextureDesc *p = &from->desc, *q = &to->desc;
    assert_true(from->feedbackWidth <= MOST_REGIONS && from->feedbackHeight <= MOST_REGIONS);
    assert_true(to->feedbackWidth <= MOST_REGIONS && to->feedbackHeight <= MOST_REGIONS);
    for (uint32_t i = 0; i < MOST_REGIONS; i++) {
        for (uint32_t j = 0; j < MOST_REGIONS; j++) {
            out->x[i][j] =
                overlap(i, p->feedbackRegionWidth, p->width, j, q->feedbackRegionWidth, q->width);
            out->y[i][j] = overlap(i, p->feedbackRegionHeight, p->height, j,
                                   q->feedbackRegionHeight, q->height);
        }
    }
}

/* Computes the follower's map from every pair of regions. */
static void expected_map(const SluiceStreamedTextureLayout *from, const uint8_t *map,
                         const SluiceStreamedTextureLayout *to, const struct meeting *meeting,
                         int shift, uint8_t *out)
{
    int last = (int)to->desc.mipLevelCount - 1;
    for (uint32_t i = 0; i < to->feedbackWidth * to->feedbackHeight; i++) {
        uint32_t x = i % to->feedbackWidth, y = i / to->feedbackWidth;
        int least = SLUICE_MIP_UNTOUCHED;
        for (uint32_t j = 0; j < from->feedbackWidth * from->feedbackHeight; j++)
            if (map[j] < least && meeting->x[j % from->feedbackWidth][x] &&
                meeting->y[j / from->feedbackWidth][y])
                least = map[j];
        int level = least + shift < 0 ? 0 : least + shift > last ? last : least + shift;
        out[i] = least == SLUICE_MIP_UNTOUCHED ? SLUICE_MIP_UNTOUCHED : (uint8_t)level;
    }
}

static void regions_match_in_uv_whatever_the_shapes(void **state)
{
    (void)state;
    static const struct {
        SluiceStreamedTextureDesc primary, follower;
        int shift;
    } cases[] = {
        {{.width = 300, .height = 200, .tileWidth = 64, .tileHeight = 32},
         {.width = 301, .height = 201, .tileWidth = 32, .tileHeight = 64},
         0},
        {{.width = 512, .height = 512, .tileWidth = 128, .tileHeight = 128},
         {.width = 256, .height = 256, .tileWidth = 32, .tileHeight = 16},
         -1},
        {{.width = 257, .height = 129, .tileWidth = 16, .tileHeight = 16},
         {.width = 520, .height = 516, .tileWidth = 128, .tileHeight = 64},
         1},
        {{.width = 257, .height = 251, .tileWidth = 32, .tileHeight = 32},
         {.width = 1, .height = 300, .tileWidth = 1, .tileHeight = 16},
         -9},
        {{.width = 199, .height = 211, .tileWidth = 17, .tileHeight = 23},
         {.width = 211, .height = 199, .tileWidth = 23, .tileHeight = 17},
         -1},
    };
    uint64_t random = 9;
    for (uint32_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        const SluiceStreamedTextureDesc *p = &cases[i].primary, *q = &cases[i].follower;
        SluiceTextureId primary = add(&f, p->width, p->height, p->tileWidth, p->tileHeight);
        SluiceTextureId follower = add(&f, q->width, q->height, q->tileWidth, q->tileHeight);
        SluiceTextureId twin = add(&f, q->width, q->height, q->tileWidth, q->tileHeight);
        SluiceStreamedTextureLayout from = fixture_layout(&f, primary);
        SluiceStreamedTextureLayout to = fixture_layout(&f, follower);
        struct meeting meeting;
        meet(&from, &to, &meeting);
        uint8_t *map = malloc(from.feedbackWidth * from.feedbackHeight);
        uint8_t *expected = malloc(to.feedbackWidth * to.feedbackHeight);
        assert_true(map && expected);
        for (uint64_t t = 0; t < 8; t++) {
            for (uint32_t r = 0; r < from.feedbackWidth * from.feedbackHeight; r++)
                map[r] = next_random(&random) % 8 ? SLUICE_MIP_UNTOUCHED : next_random(&random) % 5;
            fixture_feed_map(&f, primary, map, t, 2);
            CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, follower, t, 2));
            expected_map(&from, map, &to, &meeting, cases[i].shift, expected);
            fixture_feed_map(&f, twin, expected, t, 2);
            for (uint32_t tile = 0; tile < to.tileCount; tile++)
                assert_int_equal(fixture_state(&f, follower, tile), fixture_state(&f, twin, tile));
        }
        free(map);
        free(expected);
        fixture_close(&f);
    }
}

/* Scale and offset in eighths. */
struct moved_axis {
    int scale, offset;
    SluiceUvWrap wrap;
};

/* Returns the follower's cell at numerator / (16 steps), which is on no border. */
static uint32_t wrapped_cell(int64_t numerator, int64_t whole, SluiceUvWrap wrap, uint32_t size,
                             uint32_t cell)
{
    bool mirrors = wrap == SLUICE_UV_WRAP_MIRROR || wrap == SLUICE_UV_WRAP_MIRROR_CLAMP;
    if (wrap == SLUICE_UV_WRAP_MIRROR_CLAMP)
        numerator = numerator < -whole ? -whole + 1 : numerator > whole ? whole - 1 : numerator;
    if (wrap == SLUICE_UV_WRAP_CLAMP)
        numerator = numerator < 0 ? 0 : numerator > whole ? whole - 1 : numerator;
    int64_t period = mirrors ? 2 * whole : whole;
    numerator = (numerator % period + period) % period;
    numerator = numerator > whole ? period - numerator : numerator;
    return (uint32_t)(numerator * size / whole / cell);
}

/* Samples points so densely that every cell of both grids contains one. */
static void meet_moved(uint32_t from_size, uint32_t from_cell, uint32_t to_size, uint32_t to_cell,
                       const struct moved_axis *axis, bool out[MOST_REGIONS][MOST_REGIONS])
{
    int64_t steps = (int64_t)from_size * to_size * abs(axis->scale) * 8;
    memset(out, 0, sizeof(bool) * MOST_REGIONS * MOST_REGIONS);
    for (int64_t i = 0; i < steps; i++) {
        uint32_t from = (uint32_t)(i * from_size / steps / from_cell);
        int64_t numerator = (2 * i + 1) * axis->scale + 2 * steps * axis->offset;
        uint32_t to = wrapped_cell(numerator, 16 * steps, axis->wrap, to_size, to_cell);
        out[from][to] = true;
    }
}

static int shift_of(uint32_t from_size, uint32_t to_size, int scale)
{
    int shift = -12;
    while (ldexp(from_size, shift + 1) <= to_size * abs(scale) / 8.0)
        shift++;
    return shift;
}

static void compare_moved(struct fixture *f, SluiceTextureId primary, SluiceTextureId follower,
                          SluiceTextureId twin, const struct moved_axis axes[2], uint64_t *random)
{
    const SluiceStreamedTextureLayout from = fixture_layout(f, primary);
    const SluiceStreamedTextureLayout to = fixture_layout(f, follower);
    const SluiceStreamedTextureDesc *p = &from.desc, *q = &to.desc;
    static struct meeting meeting;
    uint8_t map[MOST_REGIONS * MOST_REGIONS], expected[MOST_REGIONS * MOST_REGIONS];
    meet_moved(p->width, p->feedbackRegionWidth, q->width, q->feedbackRegionWidth, &axes[0],
               meeting.x);
    meet_moved(p->height, p->feedbackRegionHeight, q->height, q->feedbackRegionHeight, &axes[1],
               meeting.y);
    int shift = shift_of(p->width, q->width, axes[0].scale);
    int shift_v = shift_of(p->height, q->height, axes[1].scale);
    const SluiceUvTransform uv = {axes[0].scale / 8.0f,  axes[1].scale / 8.0f,
                                  axes[0].offset / 8.0f, axes[1].offset / 8.0f,
                                  axes[0].wrap,          axes[1].wrap};
    CHECK_OK(sluiceSetUvTransform(f->manager, follower, &uv));
    for (uint64_t t = 0; t < 3; t++) {
        for (uint32_t r = 0; r < from.feedbackWidth * from.feedbackHeight; r++)
            map[r] = next_random(random) % 8 ? SLUICE_MIP_UNTOUCHED : next_random(random) % 5;
        fixture_feed_map(f, primary, map, t, 2);
        expected_map(&from, map, &to, &meeting, shift < shift_v ? shift : shift_v, expected);
        fixture_feed_map(f, twin, expected, t, 2);
        for (uint32_t tile = 0; tile < to.tileCount; tile++)
            assert_int_equal(fixture_state(f, follower, tile), fixture_state(f, twin, tile));
    }
}

static void followers_with_scale_and_offset_want_what_is_sampled(void **state)
{
    (void)state;
    static const uint32_t sizes[][4] = {/* width, height, tile */
                                        {32, 32, 4, 4},
                                        {31, 17, 4, 2},
                                        {8, 40, 2, 4},
                                        {19, 19, 3, 5},
                                        {16, 16, 16, 16}};
    uint64_t random = 5;
    for (uint32_t i = 0; i < 160; i++) {
        struct fixture f;
        fixture_open(&f, 64, false);
        const uint32_t *p = sizes[i % 5], *q = sizes[next_random(&random) % 5];
        SluiceTextureId primary = add(&f, p[0], p[1], p[2], p[3]);
        SluiceTextureId follower = add(&f, q[0], q[1], q[2], q[3]);
        SluiceTextureId twin = add(&f, q[0], q[1], q[2], q[3]);
        CHECK_OK(sluiceSetPrimaryTexture(f.manager, follower, primary));
        struct moved_axis axes[2];
        for (int k = 0; k < 2; k++) {
            axes[k].scale = (int)(next_random(&random) % 21) - 10;
            axes[k].scale = axes[k].scale ? axes[k].scale : 64;
            axes[k].offset = (int)(next_random(&random) % 49) - 24;
            axes[k].wrap = (SluiceUvWrap)(next_random(&random) % 4);
        }
        compare_moved(&f, primary, follower, twin, axes, &random);
        fixture_close(&f);
    }
}

static void a_detail_map_repeated_8_times_wants_levels_3_coarser(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId primary = add(&f, 512, 512, 64, 64), detail = add(&f, 512, 512, 64, 64);
    const SluiceUvTransform eight = {.scaleU = 8, .scaleV = 8};
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, detail, primary));
    fixture_feed(&f, primary, 2, 0, 9); /* both share one history */
    CHECK_OK(sluiceSetUvTransform(f.manager, detail, &eight));
    assert_null(slc_manager_check(f.manager));
    assert_int_equal(finest_requested(&f, detail), 2); /* until its request expires */
    fixture_feed_region(&f, primary, 9, 0, 20, 9);     /* an eighth of each axis: all of it */
    assert_int_equal(finest_requested(&f, detail), 3);
    fixture_feed_region(&f, primary, 9, 0, 40, 9);
    assert_int_equal(requested_at(&f, detail, 3), 1);
    CHECK_OK(sluiceSetUvTransform(f.manager, detail, NULL));
    fixture_feed_region(&f, primary, 9, 0, 60, 9);
    assert_int_equal(finest_requested(&f, detail), 0);
    assert_int_equal(requested_at(&f, detail, 0), 1);
    assert_null(slc_manager_check(f.manager));
    fixture_close(&f);
}

static void transforms_out_of_range_are_refused(void **state)
{
    (void)state;
    static const SluiceUvTransform wrong[] = {{0, 1, 0, 0, 0, 0},
                                              {1, 5000, 0, 0, 0, 0},
                                              {1, 1.0f / 5000, 0, 0, 0, 0},
                                              {1, 1, NAN, 0, 0, 0},
                                              {1, INFINITY, 0, 0, 0, 0},
                                              {1, 1, 0, -4097, 0, 0},
                                              {1, 1, 0, 0, (SluiceUvWrap)4, 0}};
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId id = fixture_add_small(&f);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        CHECK_RESULT(sluiceSetUvTransform(f.manager, id, &wrong[i]), SLUICE_ERROR_INVALID_ARGUMENT);
    const SluiceUvTransform good = {-4096, 1.0f / 4096, 4096, -4096, 0, 3};
    CHECK_OK(sluiceSetUvTransform(f.manager, id, &good));
    CHECK_RESULT(sluiceSetUvTransform(f.manager, id + 1, &good), SLUICE_ERROR_UNKNOWN_TEXTURE);
    fixture_close(&f);
}

static void two_primaries_within_the_timeout_are_united(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f), c = fixture_add_small(&f);
    fixture_feed_region(&f, a, 0, 0, 10, 5);
    fixture_feed_region(&f, b, 3, 0, 11, 5);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, a, c, 12, 5));
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, b, c, 13, 5));
    CHECK_STATE(&f, c, 0, REQUESTED);
    CHECK_STATE(&f, c, 1, FREE);
    CHECK_STATE(&f, c, 3, REQUESTED);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, b, c, 17, 5)); /* a was matched at 12 */
    CHECK_STATE(&f, c, 0, FREE);
    CHECK_STATE(&f, c, 3, REQUESTED);
    fixture_close(&f);
}

static void a_follower_without_regular_tiles_wants_its_packed_ones(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId primary = fixture_add_small(&f), follower = add(&f, 32, 32, 128, 128);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, follower, primary));
    fixture_feed_region(&f, primary, 1, 0, 0, 0);
    CHECK_STATE(&f, follower, 0, REQUESTED);
    fixture_feed(&f, primary, SLUICE_MIP_UNTOUCHED, 1, 0);
    CHECK_STATE(&f, follower, 0, FREE);
    fixture_close(&f);
}

static void a_primary_that_never_had_a_map_gives_nothing(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId primary = fixture_add_small(&f), follower = fixture_add_small(&f);
    fixture_feed(&f, follower, 0, 0, 10);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, follower, 20, 10));
    CHECK_STATE(&f, follower, 0, REQUESTED); /* without a map nothing expires */
    fixture_close(&f);
}

static void an_empty_map_of_the_primary_is_a_map(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId primary = fixture_add_small(&f), follower = fixture_add_small(&f);
    fixture_feed(&f, follower, 0, 0, 10);
    fixture_feed(&f, primary, SLUICE_MIP_UNTOUCHED, 5, 10); /* never sampled anything */
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, follower, 9, 10));
    CHECK_STATE(&f, follower, 0, REQUESTED);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, follower, 10, 10));
    CHECK_STATE(&f, follower, 0, FREE);
    fixture_close(&f);
}

static void followers_leave_their_set_one_by_one(void **state)
{
    (void)state;
    for (uint32_t gone = 0; gone < 8; gone++) { /* removed followers, as bits */
        struct fixture f;
        fixture_open(&f, 64, false);
        SluiceTextureId primary = fixture_add_small(&f), followers[3];
        for (uint32_t i = 0; i < 3; i++) {
            followers[i] = fixture_add_small(&f);
            CHECK_OK(sluiceSetPrimaryTexture(f.manager, followers[i], primary));
        }
        for (uint32_t i = 3; i-- > 0;) {
            if (gone >> i & 1 && i % 2)
                CHECK_OK(sluiceRemoveStreamedTexture(f.manager, followers[i], 0));
            else if (gone >> i & 1)
                CHECK_OK(sluiceSetPrimaryTexture(f.manager, followers[i], SLUICE_NO_TEXTURE));
        }
        fixture_feed(&f, primary, 2, 1, 1);
        CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
        uint32_t next = 0;
        assert_true(f.tiles[next++].textureId == primary);
        for (uint32_t i = 0; i < 3; i++) /* remaining followers, in the order of their addition */
            if (!(gone >> i & 1))
                assert_true(f.tiles[next++].textureId == followers[i]);
        assert_int_equal(f.count, next);
        CHECK_RESULT(sluiceSetPrimaryTexture(f.manager, primary, fixture_add_small(&f)),
                     gone == 7 ? SLUICE_SUCCESS : SLUICE_ERROR_INVALID_ARGUMENT);
        fixture_close(&f);
    }
}

static void a_set_needs_no_call(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId primary = fixture_add_small(&f);
    SluiceTextureId first = fixture_add_small(&f), second = fixture_add_small(&f);
    fixture_feed(&f, primary, 2, 0, 1);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, second, primary));
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, first, primary));
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, second, primary)); /* changes nothing */
    CHECK_STATE(&f, second, 5, FREE);                              /* from the next map on */
    fixture_feed(&f, primary, 2, 1, 1);
    CHECK_OK(fixture_to_map(&f, SLUICE_ALL_TEXTURES));
    assert_int_equal(
        f.count, 3); /* the texture, then its followers in the order of sluiceSetPrimaryTexture */
    assert_true(f.tiles[0].textureId == primary && f.tiles[1].textureId == second &&
                f.tiles[2].textureId == first);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, second, SLUICE_NO_TEXTURE));
    fixture_feed(&f, primary, 0, 2, 0);
    CHECK_STATE(&f, first, 0, REQUESTED);
    CHECK_STATE(&f, second, 0, FREE);
    CHECK_STATE(&f, second, 5, ALLOCATED); /* keeps what it had */
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, second, SLUICE_NO_TEXTURE));
    fixture_close(&f);
}

static void a_follower_can_change_its_primary(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f), c = fixture_add_small(&f);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, c, a));
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, c, b));
    fixture_feed_region(&f, a, 0, 0, 0, 1);
    CHECK_STATE(&f, c, 0, FREE);
    fixture_feed_region(&f, b, 1, 0, 0, 1);
    CHECK_STATE(&f, c, 1, REQUESTED);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, a, b)); /* a has no followers any more */
    fixture_close(&f);
}

static void chains_and_loops_are_refused(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f), c = fixture_add_small(&f);
    CHECK_RESULT(sluiceSetPrimaryTexture(f.manager, a, a), SLUICE_ERROR_INVALID_ARGUMENT);
    fixture_feed(&f, a, 2, 0, 1);
    CHECK_RESULT(sluiceMatchPrimaryTexture(f.manager, a, a, 0, 1), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, b, a));
    CHECK_RESULT(sluiceSetPrimaryTexture(f.manager, c, b), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceSetPrimaryTexture(f.manager, a, c), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceSetPrimaryTexture(f.manager, a, b), SLUICE_ERROR_INVALID_ARGUMENT);
    fixture_feed(&f, c, 0, 0, 1); /* none of the refused came about */
    CHECK_STATE(&f, a, 0, FREE);
    CHECK_STATE(&f, b, 0, FREE);
    fixture_feed(&f, b, 0, 0, 1);
    CHECK_STATE(&f, a, 0, FREE);
    fixture_close(&f);
}

static void followers_stand_alone_when_their_primary_is_removed(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    SluiceTextureId a = fixture_add_small(&f), b = fixture_add_small(&f), c = fixture_add_small(&f);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, b, a));
    fixture_feed(&f, a, 0, 0, 1);
    fixture_load(&f);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, a, 0));
    CHECK_STATE(&f, b, 0, MAPPED);
    SluiceTextureId again = fixture_add_small(&f); /* has the index of the old primary */
    fixture_feed(&f, again, SLUICE_MIP_UNTOUCHED, 10, 0);
    CHECK_STATE(&f, b, 0, MAPPED);
    CHECK_OK(sluiceSetPrimaryTexture(f.manager, c, b)); /* b may be a primary now */
    fixture_feed(&f, b, 0, 11, 0);
    CHECK_STATE(&f, c, 0, REQUESTED);
    CHECK_OK(sluiceRemoveStreamedTexture(f.manager, c, 0)); /* and a follower may go first */
    fixture_feed(&f, b, 0, 12, 0);
    fixture_close(&f);
}

/* 349 526 regions against 2^20: comparing each pair would take hours. */
static void thin_regions_under_thick_ones_do_not_multiply(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 64, false);
    const uint32_t most = SLUICE_MAX_TEXTURE_SIZE;
    SluiceStreamedTextureDesc wide = full_chain(most, most, most, most);
    wide.feedbackRegionWidth = 3;
    wide.feedbackRegionHeight = most;
    SluiceStreamedTextureDesc tall = full_chain(1, most, 1, most);
    tall.feedbackRegionWidth = UINT32_MAX;
    tall.feedbackRegionHeight = 1;
    SluiceTextureId primary = fixture_add(&f, &wide), follower = fixture_add(&f, &tall);
    fixture_feed_region(&f, primary, 349525, 0, 0, 0);
    CHECK_OK(sluiceMatchPrimaryTexture(f.manager, primary, follower, 0, 0));
    assert_int_equal(finest_requested(&f, follower), 0);
    fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_shift_by_the_smaller_ratio_rounded_down),
        cmocka_unit_test(levels_are_those_asked_for_not_those_cut_into_tiles),
        cmocka_unit_test(bias_and_limit_of_the_primary_go_over),
        cmocka_unit_test(followers_with_scale_and_offset_want_what_is_sampled),
        cmocka_unit_test(a_detail_map_repeated_8_times_wants_levels_3_coarser),
        cmocka_unit_test(transforms_out_of_range_are_refused),
        cmocka_unit_test(regions_match_in_uv_whatever_the_shapes),
        cmocka_unit_test(two_primaries_within_the_timeout_are_united),
        cmocka_unit_test(a_follower_without_regular_tiles_wants_its_packed_ones),
        cmocka_unit_test(a_primary_that_never_had_a_map_gives_nothing),
        cmocka_unit_test(a_set_needs_no_call),
        cmocka_unit_test(a_follower_can_change_its_primary),
        cmocka_unit_test(chains_and_loops_are_refused),
        cmocka_unit_test(followers_stand_alone_when_their_primary_is_removed),
        cmocka_unit_test(an_empty_map_of_the_primary_is_a_map),
        cmocka_unit_test(followers_leave_their_set_one_by_one),
        cmocka_unit_test(thin_regions_under_thick_ones_do_not_multiply),
    };
    return RUN_TESTS(tests);
}
