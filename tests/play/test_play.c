/* Playing a trace: compares figures with a naive model, repeats them, and checks errors. */
#define _POSIX_C_SOURCE 200809L

#include "play/naive_play.h"
#include "play/trace_file.h"
#include "support/test.h"

#include <play.h>
#include <play_loop.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static uint64_t random_state;

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(random_state >> 33) % limit;
}

static SluiceStreamedTextureDesc random_texture(void)
{
    static const uint32_t tiles[] = {32, 64}, regions[] = {16, 32, 64, 48};
    SluiceStreamedTextureDesc d = {.width = 33 + random_below(220),
                                   .height = 33 + random_below(220),
                                   .tileWidth = tiles[random_below(2)],
                                   .tileHeight = tiles[random_below(2)],
                                   .feedbackRegionWidth = regions[random_below(4)],
                                   .feedbackRegionHeight = regions[random_below(4)],
                                   .packedTileCount = 1 + random_below(2)};
    for (uint32_t size = d.width > d.height ? d.width : d.height; size; size /= 2)
        d.mipLevelCount++;
    while (d.width >> d.regularMipCount >= d.tileWidth &&
           d.height >> d.regularMipCount >= d.tileHeight)
        d.regularMipCount++;
    return d;
}

/** Makes a map: a moving window over each texture, and scattered regions. */
static void random_map(const SluiceStreamedTextureDesc *d, uint32_t frame, uint8_t *map)
{
    const uint32_t width = (d->width + d->feedbackRegionWidth - 1) / d->feedbackRegionWidth;
    const uint32_t height = (d->height + d->feedbackRegionHeight - 1) / d->feedbackRegionHeight;
    memset(map, 255, NAIVE_REGIONS);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            if ((x + 2 * y + frame / 3) % 7 < 2 || random_below(40) == 0)
                map[y * width + x] = (uint8_t)random_below(5);
}

static void random_trace(uint64_t seed, struct naive_trace *t)
{
    random_state = seed;
    memset(t, 0, sizeof *t);
    t->texture_count = 2 + random_below(NAIVE_TEXTURES - 1);
    t->frame_count = 1 + random_below(NAIVE_FRAMES);
    for (uint32_t i = 0; i < t->texture_count; i++) {
        bool follows = i > 0 && t->primaries[i - 1] == i - 1 && random_below(3) == 0;
        t->primaries[i] = follows ? i - 1 : i;
        t->textures[i] = follows ? t->textures[i - 1] : random_texture();
    }
    for (uint32_t f = 0; f < t->frame_count; f++)
        for (uint32_t i = 0; i < t->texture_count; i++) {
            t->has_map[f][i] = t->primaries[i] == i && random_below(4) > 0;
            random_map(&t->textures[i], f, t->maps[f][i]);
        }
}

static void add_frame(struct trace_file *file, const struct naive_trace *t, uint32_t frame)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < t->texture_count; i++)
        count += t->has_map[frame][i];
    trace_file_add_frame(file, frame * 10000u, count);
    for (uint32_t i = 0; i < t->texture_count; i++) {
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        CHECK_OK(sluiceGetStreamedTextureLayout(&t->textures[i], &layout));
        if (t->has_map[frame][i])
            trace_file_add_map(file, i, t->maps[frame][i],
                               layout.feedbackWidth * layout.feedbackHeight);
    }
}

static struct trace_file write_naive(const struct naive_trace *t)
{
    struct trace_file file = {0};
    trace_file_begin(&file, t->texture_count, t->frame_count);
    for (uint32_t i = 0; i < t->texture_count; i++)
        trace_file_add_texture(&file, &t->textures[i], t->primaries[i]);
    for (uint32_t f = 0; f < t->frame_count; f++)
        add_frame(&file, t, f);
    return file;
}

/** Arguments after "play TRACE", ending with NULL. */
struct played {
    struct play_options options;
    struct feedback_trace trace;
    struct play_loop loop;
};

static void play(const struct trace_file *file, const char **arguments, struct played *p)
{
    char path[64];
    const char *argv[32] = {"play", path};
    int argc = 2;
    while (arguments && *arguments)
        argv[argc++] = *arguments++;
    trace_file_write(file, file->size, path);
    assert_int_equal(play_options_parse(&p->options, argc, (char **)argv), OPTIONS_RUN);
    assert_true(feedback_trace_open(&p->trace, path));
    unlink(path);
    assert_true(play_loop_init(&p->loop, &p->options, &p->trace));
    assert_true(play_loop_run(&p->loop));
}

static void end_play(struct played *p)
{
    play_loop_finish(&p->loop);
    feedback_trace_close(&p->trace);
}

static struct naive_answer sum_up(const struct played *p)
{
    struct naive_answer sum = {.needed_tiles = p->loop.view.needed_tiles};
    for (uint32_t f = 0; f < p->trace.frame_count; f++) {
        const struct play_frame *frame = &p->loop.frames[f];
        sum.loaded_tiles += frame->loaded_tiles;
        sum.stale_tiles += frame->stale_tiles;
        sum.touched_regions += frame->view.touched_regions;
        sum.missing_regions += frame->view.missing_regions;
        sum.missing_levels += frame->view.missing_levels;
        assert_int_equal(frame->view.wrong_evictions, 0);
    }
    return sum;
}

static void figures_are_those_of_the_naive_model(void **state)
{
    (void)state;
    static struct naive_trace trace;
    static const char *latencies[] = {"0", "1", "2", "5"};
    for (uint64_t seed = 1; seed <= 60; seed++) {
        random_trace(seed, &trace);
        const char *latency = latencies[seed % 4];
        const char *arguments[] = {"--timeout", "1e6", "--latency", latency, NULL};
        struct trace_file file = write_naive(&trace);
        struct played p;
        play(&file, arguments, &p);
        const struct naive_answer expected = naive_play(&trace, (uint32_t)atoi(latency));
        const struct naive_answer sum = sum_up(&p);
        if (memcmp(&sum, &expected, sizeof sum) != 0)
            fail_msg("seed %u: needed %u for %u, loaded %u for %u, stale %u for %u, touched %u for "
                     "%u, missing %u for %u, levels %u for %u",
                     (unsigned)seed, (unsigned)sum.needed_tiles, (unsigned)expected.needed_tiles,
                     (unsigned)sum.loaded_tiles, (unsigned)expected.loaded_tiles,
                     (unsigned)sum.stale_tiles, (unsigned)expected.stale_tiles,
                     (unsigned)sum.touched_regions, (unsigned)expected.touched_regions,
                     (unsigned)sum.missing_regions, (unsigned)expected.missing_regions,
                     (unsigned)sum.missing_levels, (unsigned)expected.missing_levels);
        end_play(&p);
        trace_file_finish(&file);
    }
}

static void same_settings_play_the_same(void **state)
{
    (void)state;
    static struct naive_trace trace;
    const char *arguments[] = {
        "--drop-probability",   "0.4", "--max-heaps", "1", "--heap-tiles", "20",
        "--textures-per-frame", "2",   "--standby",   "3", "--timeout",    "0.03",
        "--tiles-per-frame",    "4",   NULL};
    for (uint64_t seed = 1; seed <= 10; seed++) {
        random_trace(seed, &trace);
        struct trace_file file = write_naive(&trace);
        struct played a, b;
        play(&file, arguments, &a);
        play(&file, arguments, &b);
        for (uint32_t f = 0; f < trace.frame_count; f++) {
            a.loop.frames[f].core_us = b.loop.frames[f].core_us = 0; /* a measured time */
            assert_memory_equal(&a.loop.frames[f], &b.loop.frames[f], sizeof a.loop.frames[f]);
        }
        end_play(&a);
        end_play(&b);
        trace_file_finish(&file);
    }
}

/** One texture of four regions. The first one is visible at level 0 from frame 3 on. */
static struct trace_file appearing_region(void)
{
    const SluiceStreamedTextureDesc desc = {.width = 64,
                                            .height = 64,
                                            .mipLevelCount = 7,
                                            .regularMipCount = 2,
                                            .packedTileCount = 1,
                                            .tileWidth = 32,
                                            .tileHeight = 32};
    const uint8_t nothing[4] = {255, 255, 255, 255}, one[4] = {0, 255, 255, 255};
    struct trace_file file = {0};
    trace_file_begin(&file, 1, 12);
    trace_file_add_texture(&file, &desc, 0);
    for (uint32_t f = 0; f < 12; f++) {
        trace_file_add_frame(&file, f * 10000u, 1);
        trace_file_add_map(&file, 0, f < 3 ? nothing : one, 4);
    }
    return file;
}

static void region_is_sharp_one_frame_after_its_latency(void **state)
{
    (void)state;
    static const char *latencies[] = {"0", "1", "4"};
    for (uint32_t i = 0; i < 3; i++) {
        const char *arguments[] = {"--latency", latencies[i], NULL};
        struct trace_file file = appearing_region();
        struct played p;
        play(&file, arguments, &p);
        assert_true(view_wait(&p.loop.view, 0.5) == atoi(latencies[i]) + 1);
        assert_int_equal(p.loop.view.wait_count, 1);
        end_play(&p);
        trace_file_finish(&file);
    }
}

static int run_main(const char *path, const char *option)
{
    const char *argv[] = {"play", path, option};
    return play_main(option ? 3 : 2, (char **)argv);
}

/** Returns a figure that play_main prints; NaN if it does not. */
static double printed(const char *path, const char *figure, const char **arguments)
{
    const char *argv[32] = {"play", path, "--json"};
    int argc = 3;
    while (*arguments)
        argv[argc++] = *arguments++;
    FILE *captured = tmpfile();
    assert_non_null(captured);
    assert_int_equal(play_print(argc, (char **)argv, captured), 0);
    rewind(captured);
    double value = NAN;
    char line[256], start[96];
    const int length = snprintf(start, sizeof start, "{\"name\": \"%s\", \"value\": ", figure);
    while (fgets(line, sizeof line, captured))
        if (strncmp(line, start, (size_t)length) == 0)
            value = strtod(line + length, NULL);
    fclose(captured);
    return value;
}

/**
 * Nine maps show the region. It lacks both regular levels in its first frame and the next. A
 * clairvoyant policy lacks nothing. A plan with one tile beside the packed one uses the coarser
 * level.
 */
static void clairvoyance_tells_what_can_be_had(void **state)
{
    (void)state;
    const char *roomy[] = {"--latency", "1", "--clairvoyant", NULL};
    const char *tight[] = {"--latency", "1", "--clairvoyant", "--max-heaps", "1", "--heap-tiles",
                           "2",         NULL};
    struct trace_file file = appearing_region();
    char path[64];
    trace_file_write(&file, file.size, path);
    assert_true(fabs(printed(path, "levels_too_coarse", roomy) - 4.0 / 9) < 1e-6);
    assert_true(fabs(printed(path, "reactive_levels_too_coarse", roomy) - 4.0 / 9) < 1e-6);
    assert_true(printed(path, "clairvoyant_levels_too_coarse", roomy) == 0);
    assert_true(printed(path, "bound_levels_too_coarse", roomy) == 0);
    assert_true(printed(path, "clairvoyant_tiles", roomy) == 3);
    assert_true(printed(path, "tiles_needed", roomy) == 3);
    assert_true(printed(path, "clairvoyant_tiles", tight) == 2);
    assert_true(printed(path, "clairvoyant_levels_too_coarse", tight) == 1);
    assert_true(printed(path, "resident_bytes_peak", tight) == 2 * 65536);
    unlink(path);
    trace_file_finish(&file);
}

static uint32_t count_lines(const char *path)
{
    FILE *file = fopen(path, "r");
    uint32_t lines = 0;
    assert_non_null(file);
    for (int c; (c = getc(file)) != EOF;)
        lines += c == '\n';
    fclose(file);
    return lines;
}

static void table_has_a_row_for_each_frame(void **state)
{
    (void)state;
    struct trace_file file = appearing_region();
    char path[64], folder[96], table[128];
    trace_file_write(&file, file.size, path);
    snprintf(folder, sizeof folder, "%s.out/a/b", path);
    const char *arguments[] = {"--output", folder, NULL};
    assert_true(printed(path, "frames", arguments) == 12);
    snprintf(table, sizeof table, "%s/frames.csv", folder);
    assert_int_equal(count_lines(table), 13);
    unlink(table);
    for (int i = 0; i < 3; i++) {
        rmdir(folder);
        *strrchr(folder, '/') = '\0';
    }
    unlink(path);
    trace_file_finish(&file);
}

static void cut_traces_are_refused_at_every_byte(void **state)
{
    (void)state;
    struct trace_file file = appearing_region();
    for (size_t size = 0; size < file.size; size++) {
        char path[64];
        trace_file_write(&file, size, path);
        assert_int_equal(run_main(path, NULL), 1);
        unlink(path);
    }
    trace_file_finish(&file);
}

/** A damaged trace is refused, or played if it is another valid trace: with another time or
 * level. */
static void damaged_traces_are_refused_or_played(void **state)
{
    (void)state;
    struct trace_file file = appearing_region();
    uint32_t refused = 0;
    FILE *out = tmpfile();
    assert_non_null(out);
    for (size_t at = 0; at < file.size; at++)
        for (uint32_t flip = 1; flip < 256; flip *= 16) {
            char path[64];
            file.bytes[at] ^= (uint8_t)flip;
            trace_file_write(&file, file.size, path);
            file.bytes[at] ^= (uint8_t)flip;
            const char *argv[] = {"play", path, "--clairvoyant", "--rounds", "3"};
            const int status = play_print(5, (char **)argv, out);
            assert_true(status == 0 || status == 1);
            refused += status;
            unlink(path);
        }
    assert_true(refused > file.size / 2 && refused < 2 * file.size);
    fclose(out);
    trace_file_finish(&file);
}

static void what_cannot_be_meant_is_refused(void **state)
{
    (void)state;
    static const char *wrong[][2] = {{"--latency", "-1"},
                                     {"--latency", "1.5"},
                                     {"--latency", "1000"},
                                     {"--heap-tiles", "0"},
                                     {"--drop-probability", "1.01"},
                                     {"--drop-probability", "nan"},
                                     {"--probability", "1/0"},
                                     {"--timeout", "0"},
                                     {"--mip-bias", "0.5"},
                                     {"--no-such-option", "1"},
                                     {"--standby"},
                                     {"another"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const char *argv[] = {"play", "trace", wrong[i][0], wrong[i][1]};
        struct play_options options;
        assert_int_equal(play_options_parse(&options, wrong[i][1] ? 4 : 3, (char **)argv),
                         OPTIONS_ERROR);
    }
    struct play_options options;
    const char *both[] = {"play", "trace", "--probability", "1/4", "--drop-probability", "0.5"};
    assert_int_equal(play_options_parse(&options, 6, (char **)both), OPTIONS_ERROR);
    assert_int_equal(play_options_parse(&options, 4, (char **)both), OPTIONS_RUN);
    assert_true(options.probability == 0.25 && options.drop == 0.75);
    assert_int_equal(play_options_parse(&options, 1, (char **)both), OPTIONS_ERROR);
    assert_int_equal(run_main("/nowhere/trace.slt", NULL), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(figures_are_those_of_the_naive_model),
        cmocka_unit_test(same_settings_play_the_same),
        cmocka_unit_test(region_is_sharp_one_frame_after_its_latency),
        cmocka_unit_test(clairvoyance_tells_what_can_be_had),
        cmocka_unit_test(table_has_a_row_for_each_frame),
        cmocka_unit_test(cut_traces_are_refused_at_every_byte),
        cmocka_unit_test(damaged_traces_are_refused_or_played),
        cmocka_unit_test(what_cannot_be_meant_is_refused),
    };
    return RUN_TESTS(tests);
}
