/* Pixels that view 7 shows, against definitions of who writes feedback, and against counts of what
 * the streamer reads back. */
#include "show.h"

#include "feedback_words.h"

#include <sluice/feedback_rate.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PIXELS (SHOW_WIDTH * SHOW_HEIGHT)

/* Pixels that show a surface with a texture, computed with rays on the CPU. */
static bool textured[PIXELS];
static uint32_t textured_count;

static void find_textured(void)
{
    const struct show *show = show_get();
    textured_count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const float x = ((float)(i % SHOW_WIDTH) + 0.5f) / SHOW_WIDTH;
        const float y = ((float)(i / SHOW_WIDTH) + 0.5f) / SHOW_HEIGHT;
        textured[i] =
            stage_pick(show->stage, &show->app.camera, (float)SHOW_WIDTH / SHOW_HEIGHT, x, y)
                .texture != STAGE_NO_TEXTURE;
        textured_count += textured[i];
    }
    assert_true(textured_count > PIXELS / 2 && textured_count < PIXELS);
}

/* The pixels that view 7 shows as written. Others have 0.35 of their color at most. */
static void draw_written(int by, bool written[PIXELS])
{
    struct view_settings *s = &show_get()->app.settings;
    s->view = VIEW_WRITTEN;
    s->feedback_by = by;
    const uint8_t *pixels = show_draw();
    for (uint32_t i = 0; i < PIXELS; i++)
        written[i] = pixels[4 * i] > 160 && pixels[4 * i + 2] < 100;
}

/* Edges of surfaces may differ by a pixel between rays and triangles. */
static void check_near(uint32_t wrong)
{
    if (wrong * 100 > textured_count)
        fail_msg("%u of %u pixels differ", wrong, textured_count);
}

static void every_pixel_with_a_texture_writes(void **state)
{
    (void)state;
    static bool written[PIXELS];
    find_textured();
    draw_written(VIEW_BY_EVERY_PIXEL, written);
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < PIXELS; i++)
        wrong += written[i] != textured[i];
    check_near(wrong);
}

static void the_lattice_writes_one_pixel_of_each_block_and_all_in_64_frames(void **state)
{
    (void)state;
    static bool written[PIXELS];
    static uint32_t times[PIXELS];
    find_textured();
    memset(times, 0, sizeof times);
    for (int frame = 0; frame < 64; frame++) {
        uint8_t blocks[PIXELS / 64] = {0};
        draw_written(VIEW_BY_LATTICE, written);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const uint32_t block = i / SHOW_WIDTH / 8 * (SHOW_WIDTH / 8) + i % SHOW_WIDTH / 8;
            times[i] += written[i];
            blocks[block] += written[i];
            assert_true(blocks[block] <= 1);
        }
    }
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < PIXELS; i++)
        wrong += times[i] != textured[i];
    check_near(wrong);
}

static void quads_write_together_and_as_often_as_their_probability_says(void **state)
{
    (void)state;
    static bool written[PIXELS];
    const double p = 0.125;
    uint32_t count = 0, torn = 0;
    find_textured();
    show_get()->app.settings.probability = p;
    for (int frame = 0; frame < 10; frame++) {
        draw_written(VIEW_BY_QUADS, written);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const uint32_t x = i % SHOW_WIDTH, y = i / SHOW_WIDTH;
            const uint32_t first = (y & ~1u) * SHOW_WIDTH + (x & ~1u);
            count += written[i];
            torn += textured[i] && textured[first] && written[i] != written[first];
        }
    }
    show_get()->app.settings.probability = 1;
    check_near(torn / 10);
    /* 6 standard deviations, and 1 % */
    const double quads = 10.0 * textured_count / 4, expected = quads * p;
    assert_true(fabs(count / 4.0 - expected) < 6 * sqrt(expected * (1 - p)) + 0.01 * expected);
}

static void in_turns_all_pixels_write_in_as_many_frames_as_a_round_of_textures_has(void **state)
{
    (void)state;
    static bool written[PIXELS], any[PIXELS];
    struct show *show = show_get();
    const uint32_t textures = feedback_texture_count(show->stage), maps = 3;
    const uint32_t frames = (textures + maps - 1) / maps;
    find_textured();
    memset(any, 0, sizeof any);
    show->app.settings.textures_per_frame = maps;
    draw_written(VIEW_BY_TURNS, written); /* the setting counts from the next frame on */
    uint32_t most = 0, wrong = 0;
    for (uint32_t frame = 0; frame < frames; frame++) {
        uint32_t count = 0;
        draw_written(VIEW_BY_TURNS, written);
        for (uint32_t i = 0; i < PIXELS; i++) {
            count += written[i];
            any[i] |= written[i];
        }
        most = count > most ? count : most;
    }
    show->app.settings.textures_per_frame = 0;
    for (uint32_t i = 0; i < PIXELS; i++)
        wrong += any[i] != textured[i];
    check_near(wrong);
    assert_true(frames > 3 && most < textured_count);
}

static void without_feedback_no_pixel_writes(void **state)
{
    (void)state;
    static bool written[PIXELS];
    show_get()->app.settings.feedback = VIEW_FEEDBACK_OFF;
    for (int by = VIEW_BY_QUADS; by <= VIEW_BY_TURNS; by++) {
        draw_written(by, written);
        for (uint32_t i = 0; i < PIXELS; i++)
            assert_false(written[i]);
    }
    show_get()->app.settings.feedback = VIEW_FEEDBACK_ON;
}

static uint64_t requested(void)
{
    SluiceVulkanStreamerStatistics now = {.structSize = sizeof now};
    CHECK_OK(sluiceGetVulkanStreamerStatistics(stage_streamer(show_get()->stage), &now));
    return now.mappedTileCount;
}

/* The lattice reports less than every pixel in one frame, and the same tiles after 64 frames. */
static void all_kinds_request_the_same_tiles_in_the_end(void **state)
{
    (void)state;
    struct view_settings *s = &show_get()->app.settings;
    uint64_t tiles[4];
    s->view = VIEW_PICTURE;
    for (int by = VIEW_BY_QUADS; by <= VIEW_BY_TURNS; by++) {
        s->feedback_by = by;
        stage_restart(show_get()->stage);
        for (int frame = 0; frame < 72; frame++)
            show_draw();
        tiles[by] = requested();
    }
    for (int by = VIEW_BY_LATTICE; by <= VIEW_BY_TURNS; by++)
        if (tiles[by] != tiles[VIEW_BY_EVERY_PIXEL])
            fail_msg("kind %d: %u tiles, every pixel: %u", by, (unsigned)tiles[by],
                     (unsigned)tiles[VIEW_BY_EVERY_PIXEL]);
    /* Corners of quads that every frame turns reach the same tiles. */
    assert_true(tiles[VIEW_BY_QUADS] <= tiles[VIEW_BY_EVERY_PIXEL]);
    assert_true(tiles[VIEW_BY_QUADS] * 10 >= tiles[VIEW_BY_EVERY_PIXEL] * 9);
}

static uint32_t count_resident_below(uint32_t level)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < stage_texture_count(show_get()->stage); i++) {
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        const SluiceTextureId id = stage_texture(show_get()->stage, i)->id;
        CHECK_OK(sluiceGetTextureLayout(show_manager(), id, &layout));
        for (uint32_t tile = 0; tile < layout.tileCount; tile++) {
            SluiceTileState state;
            SluiceTile at;
            CHECK_OK(sluiceGetTileState(show_manager(), id, tile, &state, &at));
            count += at.mipLevel < level && at.mipLevel < layout.desc.regularMipCount &&
                     (state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY);
        }
    }
    return count;
}

static void no_tile_finer_than_the_finest_level_stays_or_comes(void **state)
{
    (void)state;
    struct view_settings *s = &show_get()->app.settings;
    const uint32_t standby = s->standby;
    s->feedback_by = VIEW_BY_EVERY_PIXEL;
    s->standby = 0;
    s->lod_bias = -4; /* the picture is small */
    for (int frame = 0; frame < 10; frame++)
        show_draw();
    assert_true(count_resident_below(4) > 10);
    s->finest_level = 4;
    for (int frame = 0; frame < 10; frame++)
        show_draw();
    assert_int_equal(count_resident_below(4), 0);
    assert_true(requested() > 0);
    s->finest_level = 0;
    for (int frame = 0; frame < 10; frame++)
        show_draw();
    assert_true(count_resident_below(4) > 10);
    s->standby = standby;
    s->lod_bias = 0;
}

static void outlooks_are_those_of_the_chosen_kind(void **state)
{
    (void)state;
    struct view_settings s = {.probability = 1.0 / 16, .textures_per_frame = 10, .timeout = 1};
    char text[96];
    struct feedback_outlook quads = feedback_outlook_of(&s, 10);
    assert_true(quads.known && quads.frames > 1);
    s.feedback_by = VIEW_BY_EVERY_PIXEL;
    struct feedback_outlook all = feedback_outlook_of(&s, 10);
    assert_true(all.known && all.frames == 1 && all.missed == 0);
    s.textures_per_frame = 0;
    assert_true(feedback_outlook_of(&s, 1000).frames == 1); /* all maps in each frame */
    s.feedback_by = VIEW_BY_LATTICE;
    struct feedback_outlook lattice = feedback_outlook_of(&s, 1000);
    /* 8 x 8 pixels have one of the lattice in each frame. */
    assert_true(lattice.known && lattice.frames == 1 && lattice.missed == 0);
    s.feedback_by = VIEW_BY_TURNS;
    s.textures_per_frame = 10;
    assert_true(feedback_outlook_of(&s, 100).frames == 10);
    assert_string_equal(feedback_writers(&s, 100, text, sizeof text),
                        "pixels of 10 of 100 textures, in turns");
    s.timeout = 1.0 / 1000;                                /* a round takes longer */
    assert_true(feedback_outlook_of(&s, 100).missed == 0); /* the newest map counts */
    s.feedback = VIEW_FEEDBACK_OFF;
    assert_false(feedback_outlook_of(&s, 100).known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(outlooks_are_those_of_the_chosen_kind),
        cmocka_unit_test(every_pixel_with_a_texture_writes),
        cmocka_unit_test(the_lattice_writes_one_pixel_of_each_block_and_all_in_64_frames),
        cmocka_unit_test(quads_write_together_and_as_often_as_their_probability_says),
        cmocka_unit_test(in_turns_all_pixels_write_in_as_many_frames_as_a_round_of_textures_has),
        cmocka_unit_test(without_feedback_no_pixel_writes),
        cmocka_unit_test(no_tile_finer_than_the_finest_level_stays_or_comes),
        cmocka_unit_test(all_kinds_request_the_same_tiles_in_the_end),
    };
    return tap_filter_stdout(), cmocka_run_group_tests(tests, show_begin, show_end);
}
