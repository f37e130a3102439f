/* Values that panels show against the picture that shaders draw, and against counts of all tiles.
 */
#include "support/test.h"

#include "app.h"
#include "controls.h"
#include "device_words.h"
#include "event_rows.h"
#include "memory_map.h"
#include "panels.h"
#include "scene_data.h"
#include "texture_rows.h"
#include "thumbs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 160u
#define HEIGHT 120u
#define FRAME_MICROSECONDS 20000u

struct show {
    struct gpu gpu;
    struct frames frames;
    struct view_app app;
    struct stage *stage;
    uint64_t clock;
};

static struct show *show;

static int begin(void **state)
{
    (void)state;
    struct scene_data scene = {0};
    bool unsupported = false;
    show = calloc(1, sizeof *show);
    app_init(&show->app);
    struct view_settings *settings = &show->app.settings;
    settings->residency = VIEW_PAGED;
    settings->anisotropy = 4;
    settings->probability = 1;
    settings->textures_per_frame = 64;
    settings->tint = 1;
    settings->fade = 0;
    const struct gpu_request request = {
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_AUTO}};
    if (!ui_create(1) || !gpu_create(&request, &show->gpu, &unsupported)) {
        if (unsupported)
            return 0;
        return -1;
    }
    show->app.gpu = &show->gpu;
    show->app.deterministic = true;
    show->app.picture_scale = 1;
    const struct stage_request stage = {.gpu = &show->gpu, .threads = 1};
    if (!frames_create(&show->gpu, WIDTH, HEIGHT, &show->frames) || !scene_data_make_room(&scene))
        return -1;
    show->stage = stage_create(&stage, settings, &scene);
    return show->stage && app_open(&show->app, show->stage, false) ? 0 : -1;
}

static int end(void **state)
{
    (void)state;
    frames_wait(&show->frames);
    app_finish(&show->app);
    stage_destroy(show->stage);
    frames_destroy(&show->frames);
    gpu_destroy(&show->gpu);
    ui_destroy();
    free(show);
    return 0;
}

static SluiceStreamedTextureManager *manager(void)
{
    SluiceStreamedTextureManager *it = NULL;
    sluiceGetVulkanStreamerManager(stage_streamer(show->stage), &it);
    return it;
}

/* Draws a frame with the mouse at a place; returns its pixels. */
static const uint8_t *draw(float x, float y)
{
    struct view_app *app = &show->app;
    struct ui_geometry geometry;
    struct frames_end end = {.geometry = &geometry, .read = true};
    const struct ui_input input = {.width = WIDTH,
                                   .height = HEIGHT,
                                   .seconds = FRAME_MICROSECONDS / 1e6f,
                                   .mouse_x = x,
                                   .mouse_y = y};
    VkCommandBuffer commands = frames_begin(&show->frames);
    assert_true(commands != VK_NULL_HANDLE);
    ui_begin_frame(&input);
    app_input(app, &input);
    panels_draw(app);
    ui_end_frame(&geometry);
    show->clock += FRAME_MICROSECONDS;
    const struct stage_draw draw = {.settings = &app->settings,
                                    .camera = app->camera,
                                    .width = WIDTH,
                                    .height = HEIGHT,
                                    .number = show->frames.number,
                                    .time_stamp = show->clock};
    stage_apply(show->stage, &app->settings);
    assert_true(stage_record(show->stage, &draw, commands, &end));
    assert_true(frames_end(&show->frames, &end));
    const uint8_t *pixels = frames_pixels(&show->frames);
    assert_true(frames_wait(&show->frames) && stage_settle(show->stage));
    facts_update(&app->facts, show->stage, &app->settings, FRAME_MICROSECONDS / 1e6);
    return pixels;
}

static void settle(void)
{
    if (!show->stage)
        SKIP_TEST("no Vulkan device");
    while (show->app.facts.frame < 30)
        draw(-1, -1);
}

/* Colors over a picture keep the ratios of their channels. Returns the level, 7: or coarser. */
static uint32_t level_of_color(const uint8_t *pixel)
{
    uint32_t best = 0;
    double most = -1;
    for (uint32_t level = 0; level < 8; level++) {
        double product = 0, size = 0;
        for (int k = 0; k < 3; k++) {
            const double color = panel_level_color(level) >> 8 * k & 255;
            product += color * pixel[k];
            size += color * color;
        }
        if (product / sqrt(size) > most) {
            most = product / sqrt(size);
            best = level;
        }
    }
    return best;
}

static uint32_t at_most_7(double level)
{
    return level < 0 ? 0 : level > 7 ? 7 : (uint32_t)level;
}

/* The tile of the level that is resident covers the texel, is resident and was loaded. */
static void check_tile(const struct view_probe *probe)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(
        sluiceGetTextureLayout(manager(), stage_texture(show->stage, probe->texture)->id, &layout));
    assert_true(probe->state == SLUICE_TILE_STATE_MAPPED ||
                probe->state == SLUICE_TILE_STATE_STANDBY);
    assert_true(probe->loads > 0 && probe->age >= 0 && probe->failures == 0);
    if (probe->resident >= layout.desc.regularMipCount)
        return;
    assert_int_equal(probe->tile.mipLevel, probe->resident);
    assert_int_equal(probe->tile.x, (probe->texel[0] >> probe->resident) / layout.desc.tileWidth);
    assert_int_equal(probe->tile.y, (probe->texel[1] >> probe->resident) / layout.desc.tileHeight);
}

/* Checks at many points that the legend's level matches the color. Points on the border of two
 * levels may differ. */
static void check_levels(uint32_t view, uint32_t places[8])
{
    struct view_app *app = &show->app;
    uint32_t known = 0, equal = 0;
    app->settings.view = view;
    app->settings.panels = 1;
    draw(-1, -1);
    const uint8_t *pixels = draw(-1, -1);
    for (uint32_t y = 4; y < HEIGHT; y += 8)
        for (uint32_t x = 4; x < WIDTH; x += 8) {
            app->mouse_x = (float)x + 0.5f;
            app->mouse_y = (float)y + 0.5f;
            panel_probe_find(app);
            if (!app->probe.known)
                continue;
            const uint32_t is = level_of_color(pixels + 4 * (y * WIDTH + x));
            const uint32_t shown =
                at_most_7(view == VIEW_WANTED ? app->probe.camera_level : app->probe.resident);
            check_tile(&app->probe);
            places[shown]++;
            known++;
            equal += is == shown;
        }
    app->settings.panels = 0;
    assert_true(known > 100);
    if (equal * 20 < known * 19)
        fail_msg("view %u: %u of %u places have the level that is shown", view, equal, known);
}

static void levels_under_the_mouse_are_those_of_the_colors(void **state)
{
    (void)state;
    uint32_t resident[8] = {0}, wanted[8] = {0};
    settle();
    check_levels(VIEW_RESIDENT, resident);
    check_levels(VIEW_WANTED, wanted);
    uint32_t kinds = 0;
    for (int level = 0; level < 8; level++)
        kinds += wanted[level] > 0;
    assert_true(kinds >= 3); /* the room has near and far pictures */
}

/* A rolled camera of parallel rays: picks and shaders see one picture. */
static void levels_of_parallel_rays_are_those_of_the_colors(void **state)
{
    (void)state;
    struct view_app *app = &show->app;
    uint32_t wanted[8] = {0};
    const struct view_camera before = app->camera;
    settle();
    app->camera.span = 1.5f;
    app->camera.aspect = 2; /* more than the picture's: it sees more above and below */
    app->camera.roll = 0.4f;
    for (int i = 0; i < 20; i++)
        draw(-1, -1);
    check_levels(VIEW_WANTED, wanted);
    app->camera = before;
}

static void a_surface_without_a_resident_level_is_not_called_sharp(void **state)
{
    (void)state;
    char words[96];
    struct view_probe probe = {.resident = SLUICE_MIP_UNTOUCHED, .density = 1, .camera_level = 2};
    probe.why.reason = SLUICE_COARSE_BUDGET;
    assert_string_equal(panel_missing_words(&probe, words, sizeof words),
                        "nothing is resident: memory is short");
    probe.resident = 5;
    assert_string_equal(panel_missing_words(&probe, words, sizeof words),
                        "3 missing: memory is short");
    probe.resident = 2;
    assert_string_equal(panel_missing_words(&probe, words, sizeof words), "as sharp as wanted");
}

static void long_names_are_shortened_in_the_middle(void **state)
{
    (void)state;
    const char *name = "FlightHelmet_Materials_MetalPartsMat_Normal.jpg";
    char text[64], tiny[12];
    const float width = ui_text_width(name) / 2;
    const char *shortened = panel_shorten(name, width, text, sizeof text);
    const char *dots = strstr(shortened, "...");
    assert_non_null(dots);
    assert_true(ui_text_width(shortened) <= width);
    assert_memory_equal(shortened, name, (size_t)(dots - shortened));
    assert_true(dots > shortened + 4 && strlen(dots + 3) > 4);
    assert_string_equal(dots + 3, name + strlen(name) - strlen(dots + 3));
    assert_ptr_equal(panel_shorten(name, ui_text_width(name), text, sizeof text), name);
    assert_string_equal(panel_shorten(name, 1e9f, tiny, sizeof tiny), "Flig....jpg");
    assert_string_equal(panel_shorten("ääääääää", ui_text_width("ää...ä"), text, sizeof text),
                        "ä...ää");
}

/* Walks over all tiles of a texture. */
static void count_tiles(uint32_t texture, uint64_t *resident, uint64_t *all)
{
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    const SluiceTextureId id = stage_texture(show->stage, texture)->id;
    CHECK_OK(sluiceGetTextureLayout(manager(), id, &layout));
    for (uint32_t tile = 0; tile < layout.tileCount; tile++) {
        SluiceTileState state;
        CHECK_OK(sluiceGetTileState(manager(), id, tile, &state, NULL));
        *resident += state == SLUICE_TILE_STATE_MAPPED || state == SLUICE_TILE_STATE_STANDBY;
        *all += 1;
    }
}

static void rows_of_textures_and_their_sum_count_all_tiles(void **state)
{
    (void)state;
    settle();
    const uint32_t count = stage_texture_count(show->stage);
    struct texture_row *rows = calloc(count, sizeof *rows);
    uint64_t resident = 0, all = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint64_t here = 0, here_all = 0;
        count_tiles(i, &here, &here_all);
        rows[i] = texture_row_of(show->stage, &show->app.facts, i);
        assert_int_equal(rows[i].resident, here);
        assert_int_equal(rows[i].all, here_all);
        assert_true(rows[i].loads >= here && rows[i].failures == 0);
        resident += here;
        all += here_all;
    }
    const struct texture_row sum = texture_rows_sum(rows, count);
    assert_true(resident > 0 && sum.resident == resident && sum.all == all);
    assert_int_equal(sum.size, resident * SLUICE_DEFAULT_TILE_SIZE);
    texture_rows_sort(rows, count, COLUMN_RESIDENT, true);
    for (uint32_t i = 1; i < count; i++)
        assert_true(rows[i - 1].resident >= rows[i].resident);
    free(rows);
}

/* Fields of a line of a CSV file, outside of quotes. */
static uint32_t count_fields(const char *line)
{
    uint32_t fields = 1;
    bool quoted = false;
    for (; *line; line++) {
        quoted ^= *line == '"';
        fields += *line == ',' && !quoted;
    }
    return fields;
}

static void filters_and_files_take_names_with_blanks_quotes_and_commas(void **state)
{
    (void)state;
    const struct texture_row row = {.name = "Big \"Wall\", left",
                                    .format = "BC7",
                                    .set = "Floor",
                                    .source = "/a/b.png",
                                    .seen_seconds = -1};
    assert_true(texture_row_matches(&row, ""));
    assert_true(texture_row_matches(&row, "  wall BC7 floor B.PNG "));
    assert_false(texture_row_matches(&row, "wall door"));
    char text[1024] = "";
    FILE *file = tmpfile();
    assert_true(texture_rows_write(file, &row, 1));
    rewind(file);
    assert_non_null(fgets(text, sizeof text, file));
    const uint32_t titles = count_fields(text);
    assert_non_null(fgets(text, sizeof text, file));
    assert_int_equal(count_fields(text), titles);
    assert_non_null(strstr(text, "\"Big \"\"Wall\"\", left\","));
    fclose(file);
}

static void sums_of_memory_count_all_slots(void **state)
{
    (void)state;
    settle();
    const struct memory_sums sums = memory_sums_of(show->stage);
    struct memory_slot slot;
    uint32_t heaps = 0, used = 0;
    for (uint32_t heap = 0; heap < 64; heap++) {
        SluiceTile tile;
        if (sluiceGetSlotTile(manager(), heap, 0, &tile) != SLUICE_SUCCESS)
            continue;
        heaps++;
        for (uint32_t i = 0; i < stage_heap_tiles(show->stage); i++) {
            if (!memory_slot_get(show->stage, &show->app.facts, heap, i, &slot))
                continue;
            used++;
            assert_true(slot.loads > 0 && slot.age >= 0);
            assert_int_equal(stage_texture(show->stage, slot.texture)->id, slot.tile.textureId);
        }
    }
    assert_int_equal(sums.heaps, heaps);
    assert_int_equal(sums.used, used);
    uint32_t needed = 0;
    while (needed * stage_heap_tiles(show->stage) < used)
        needed++;
    assert_int_equal(sums.spare_heaps, heaps - needed);
    assert_true(used > 0);
}

/* Colors over a picture keep the ratios of their channels. */
static bool is_color(const uint8_t *pixel, uint32_t color)
{
    double product = 0, a = 0, b = 0;
    for (int k = 0; k < 3; k++) {
        const double channel = color >> 8 * k & 255;
        product += channel * pixel[k];
        a += channel * channel;
        b += (double)pixel[k] * pixel[k];
    }
    return product > 0.9995 * sqrt(a * b);
}

static void a_camera_that_looks_at_a_tile_sees_it_in_the_color_of_its_texture(void **state)
{
    (void)state;
    settle();
    struct view_app *app = &show->app;
    const struct view_camera before = app->camera;
    app->settings.view = VIEW_IDENTITY;
    app->settings.panels = 1;
    app->settings.feedback = VIEW_FEEDBACK_OFF; /* nothing more is painted */
    for (uint32_t texture = 0; texture < stage_texture_count(show->stage); texture += 5) {
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        SluiceTile tile;
        const SluiceTextureId id = stage_texture(show->stage, texture)->id;
        CHECK_OK(sluiceGetTextureLayout(manager(), id, &layout));
        CHECK_OK(sluiceGetTileState(manager(), id, layout.levelWidthInTiles[0] / 2, NULL, &tile));
        app_look_at_tile(app, texture, &tile);
        const struct stage_pick pick =
            stage_pick(show->stage, &app->camera, (float)WIDTH / HEIGHT, 0.5f, 0.5f);
        assert_int_equal(pick.texture, texture);
        const uint32_t width = stage_texture(show->stage, texture)->width;
        assert_int_equal((uint32_t)(pick.u * (float)width) / layout.desc.tileWidth, tile.x);
        draw(-1, -1);
        const uint8_t *pixels = draw(-1, -1);
        assert_true(is_color(pixels + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2),
                             memory_texture_color(show->stage, texture)));
    }
    app->settings.panels = 0;
    app->settings.feedback = VIEW_FEEDBACK_ON;
    app->camera = before;
}

static void listed_events_are_those_of_their_reason_and_texture(void **state)
{
    enum { MOST = 1 << 15 };
    static SluiceTileEvent every[MOST];
    static const SluiceTileEvent *rows[FACTS_EVENTS];
    (void)state;
    settle();
    uint64_t cursor = 0, lost;
    uint32_t count = MOST, kinds = 0;
    CHECK_OK(sluiceReadTileEvents(manager(), &cursor, &count, every, &lost));
    assert_int_equal(lost, 0);
    assert_true(count > 20);
    const SluiceTileEvent *all = count > FACTS_EVENTS ? every + count - FACTS_EVENTS : every;
    count = count > FACTS_EVENTS ? FACTS_EVENTS : count; /* the facts keep the last */
    for (uint32_t reason = 0; reason <= SLUICE_TILE_EVENT_REMOVED; reason++) {
        uint32_t here = 0, first = 0;
        for (uint32_t i = 0; i < count; i++) {
            here += (uint32_t)all[i].reason == reason;
            first += (uint32_t)all[i].reason == reason &&
                     all[i].textureId == stage_texture(show->stage, 0)->id;
        }
        assert_int_equal(
            event_rows_find(&show->app.facts, reason + 1, STAGE_NO_TEXTURE, rows, FACTS_EVENTS),
            here);
        assert_int_equal(event_rows_find(&show->app.facts, reason + 1, 0, rows, FACTS_EVENTS),
                         first);
        kinds += here > 0;
    }
    assert_true(kinds >= 3);
    assert_int_equal(event_rows_find(&show->app.facts, EVENT_ANY_REASON, STAGE_NO_TEXTURE, rows, 5),
                     5);
    assert_int_equal(rows[0]->mark, all[count - 1].mark); /* the newest is the first */
}

static void reasons_of_a_mode_are_those_that_the_library_chooses_by(void **state)
{
    (void)state;
    char words[DEVICE_WORDS], quirks[DEVICE_QUIRKS][DEVICE_WORDS];
    for (uint32_t kind = 0; kind < 8; kind++) {
        const SluiceVulkanDeviceCapabilities c = {
            .structSize = sizeof c,
            .sparse = kind & 1,
            .timelineSemaphore = true,
            .shaderResourceMinLod = true,
            .maxTouchedTiles = kind & 2 ? 16000 : 0,
        };
        const uint32_t textures = kind & 4 ? 5000 : 10;
        SluiceResidencyMode mode;
        CHECK_OK(sluiceChooseVulkanResidencyMode(&c, SLUICE_RESIDENCY_MODE_AUTO, textures, &mode));
        device_mode_reason(&c, SLUICE_RESIDENCY_MODE_AUTO, mode, textures, words);
        const bool too_many = strstr(words, "too many"), none = strstr(words, "no sparse");
        assert_int_equal(none, !c.sparse);
        assert_int_equal(too_many, c.sparse && mode == SLUICE_RESIDENCY_MODE_PAGED);
        assert_int_equal(strstr(words, "has sparse") != NULL, mode == SLUICE_RESIDENCY_MODE_SPARSE);
        const uint32_t count = device_quirks(&c, mode, quirks);
        bool touched = false;
        for (uint32_t i = 0; i < count; i++)
            touched |= strstr(quirks[i], "maxTouchedTiles") != NULL;
        assert_int_equal(touched, mode == SLUICE_RESIDENCY_MODE_SPARSE && c.maxTouchedTiles > 0);
    }
    const SluiceVulkanDeviceCapabilities none = {.structSize = sizeof none};
    assert_non_null(strstr(device_mode_reason(&none, SLUICE_RESIDENCY_MODE_PAGED,
                                              SLUICE_RESIDENCY_MODE_PAGED, 1, words),
                           "--residency"));
}

/* The digits 0 to 9 beside each other, each 3 points wide. */
static const char *const digit_points[5] = {"###"
                                            " # "
                                            "###"
                                            "###"
                                            "# #"
                                            "###"
                                            "###"
                                            "###"
                                            "###"
                                            "###",
                                            "# #"
                                            "## "
                                            "  #"
                                            "  #"
                                            "# #"
                                            "#  "
                                            "#  "
                                            "  #"
                                            "# #"
                                            "# #",
                                            "# #"
                                            " # "
                                            "###"
                                            "###"
                                            "###"
                                            "###"
                                            "###"
                                            "  #"
                                            "###"
                                            "###",
                                            "# #"
                                            " # "
                                            "#  "
                                            "  #"
                                            "  #"
                                            "  #"
                                            "# #"
                                            "  #"
                                            "# #"
                                            "  #",
                                            "###"
                                            "###"
                                            "###"
                                            "###"
                                            "  #"
                                            "###"
                                            "###"
                                            "  #"
                                            "###"
                                            "###"};

/* Stands before the middle of a tile so that a point of its number is about 4 pixels wide. */
static void stand_before(uint32_t texture, const SluiceTile *tile, uint32_t tile_width,
                         float texels[4])
{
    struct view_app *app = &show->app;
    app_look_at_tile(app, texture, tile);
    for (int i = 0; i < 2; i++) {
        const struct stage_pixel pixel = {app->camera, WIDTH, HEIGHT, 0.5f, 0.5f};
        const struct stage_pick pick =
            stage_pick(show->stage, &app->camera, (float)WIDTH / HEIGHT, 0.5f, 0.5f);
        assert_true(pick.hit && stage_pick_pixel(show->stage, &pick, &pixel, texels));
        const float wanted = (float)tile_width / 112, is = fabsf(texels[0]);
        const struct vec3 to = vec3_sub(app->camera.position, pick.position);
        if (i == 0)
            app->camera.position = vec3_add(pick.position, vec3_scale(to, wanted / is));
    }
}

/* Counts points of a digit that the picture has; `corner`: pixel of its upper left corner. */
static uint32_t count_points(const uint8_t *with, const uint8_t *without, uint32_t digit,
                             const float corner[2], const float step[2])
{
    uint32_t equal = 0;
    for (uint32_t row = 0; row < 5; row++)
        for (uint32_t column = 0; column < 3; column++) {
            const uint32_t x = (uint32_t)(corner[0] + ((float)column + 0.5f) * step[0]);
            const uint32_t y = (uint32_t)(corner[1] + ((float)row + 0.5f) * step[1]);
            assert_true(x < WIDTH && y < HEIGHT);
            const size_t at = 4 * ((size_t)y * WIDTH + x);
            const bool dark = memcmp(with + at, without + at, 3) != 0;
            equal += dark == (digit_points[row][3 * digit + column] == '#');
        }
    return equal;
}

static void tiles_show_their_column_and_row(void **state)
{
    (void)state;
    static uint8_t without[4 * WIDTH * HEIGHT];
    settle();
    struct view_app *app = &show->app;
    const struct view_camera before = app->camera;
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    const SluiceTextureId id = stage_texture(show->stage, 0)->id;
    CHECK_OK(sluiceGetTextureLayout(manager(), id, &layout));
    app->settings.view = VIEW_PICTURE;
    app->settings.panels = 1;
    app->settings.feedback = VIEW_FEEDBACK_OFF;
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t x = 1 + 3 * i, y = 9 - 2 * i;
        SluiceTile tile;
        float texels[4];
        CHECK_OK(
            sluiceGetTileState(manager(), id, y * layout.levelWidthInTiles[0] + x, NULL, &tile));
        stand_before(0, &tile, layout.desc.tileWidth, texels);
        app->settings.borders = VIEW_BORDERS;
        memcpy(without, draw(-1, -1), sizeof without);
        app->settings.borders = VIEW_NUMBERED_BORDERS;
        const uint8_t *with = draw(-1, -1);
        const float step[2] = {(float)layout.desc.tileWidth / 28 / texels[0],
                               (float)layout.desc.tileHeight / 28 / texels[3]};
        const float corner[2] = {WIDTH / 2.0f - 12.5f * step[0], HEIGHT / 2.0f - 12.5f * step[1]};
        const float below[2] = {corner[0], corner[1] + 7 * step[1]};
        assert_int_equal(count_points(with, without, x, corner, step), 15);
        assert_int_equal(count_points(with, without, y, below, step), 15);
    }
    app->settings.borders = VIEW_NO_BORDERS;
    app->settings.panels = 0;
    app->settings.feedback = VIEW_FEEDBACK_ON;
    app->camera = before;
}

static void a_wireframe_draws_thin_lines_and_nothing_else(void **state)
{
    (void)state;
    static uint8_t without[4 * WIDTH * HEIGHT];
    static const uint8_t blue[3] = {89, 225, 243}; /* sRGB of the color of scene_lines.frag */
    settle();
    struct view_app *app = &show->app;
    app->settings.view = VIEW_PICTURE;
    app->settings.panels = 1;
    draw(-1, -1);
    memcpy(without, draw(-1, -1), sizeof without);
    app->settings.wireframe = 1;
    const uint8_t *with = draw(-1, -1);
    uint32_t lines = 0;
    for (size_t i = 0; i < sizeof without; i += 4) {
        if (memcmp(with + i, without + i, 3) == 0)
            continue;
        lines++;
        for (int k = 0; k < 3; k++)
            assert_in_range(with[i + (size_t)k], blue[k] - 2, blue[k] + 2);
    }
    assert_in_range(lines, WIDTH / 2, WIDTH * HEIGHT / 8);
    app->settings.wireframe = 0;
    assert_memory_equal(draw(-1, -1), without, sizeof without);
    app->settings.panels = 0;
}

/* A cell of a square texture is the level of 32 x 32 texels, which are read here one by one. */
static void compare_cell(const struct thumbs *thumbs, uint32_t texture, SluiceImageSource *source,
                         uint32_t level)
{
    const uint32_t row = THUMBS_COLUMNS * THUMBS_CELL;
    const uint32_t left = texture % THUMBS_COLUMNS * THUMBS_CELL;
    const uint32_t top = texture / THUMBS_COLUMNS * THUMBS_CELL;
    for (uint32_t y = 0; y < THUMBS_CELL; y++)
        for (uint32_t x = 0; x < THUMBS_CELL; x++) {
            const uint8_t *pixel = thumbs->pixels + ((size_t)(top + y) * row + left + x) * 4;
            const SluiceImageRegion region = {
                .mipLevel = level, .x = x, .y = y, .width = 1, .height = 1};
            uint8_t texel[4];
            CHECK_OK(sluiceReadImageRegion(source, &region, texel, sizeof texel));
            assert_memory_equal(pixel, texel, 3);
            assert_int_equal(pixel[3], 255);
        }
}

static void thumbs_are_levels_of_their_textures(void **state)
{
    (void)state;
    struct thumbs thumbs = {0};
    uint32_t compared = 0;
    if (!show->stage)
        SKIP_TEST("no device");
    thumbs_begin(&thumbs, &show->gpu, show->stage, true);
    for (uint32_t i = 0; i < stage_texture_count(show->stage) && compared < 4; i++) {
        SluiceImageSource *source = (SluiceImageSource *)stage_source(show->stage, i);
        SluiceImageInfo info = {.structSize = sizeof info};
        uint32_t level = 0;
        CHECK_OK(sluiceGetImageInfo(source, &info));
        while (info.width >> level > THUMBS_CELL)
            level++;
        if (info.width != info.height || info.width >> level != THUMBS_CELL ||
            (info.format != SLUICE_FORMAT_R8G8B8A8_SRGB &&
             info.format != SLUICE_FORMAT_R8G8B8A8_UNORM))
            continue;
        assert_true(thumbs.known[i]);
        compare_cell(&thumbs, i, source, level);
        compared++;
    }
    assert_true(compared > 1);
    thumbs_end(&thumbs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(listed_events_are_those_of_their_reason_and_texture),
        cmocka_unit_test(levels_under_the_mouse_are_those_of_the_colors),
        cmocka_unit_test(levels_of_parallel_rays_are_those_of_the_colors),
        cmocka_unit_test(a_surface_without_a_resident_level_is_not_called_sharp),
        cmocka_unit_test(long_names_are_shortened_in_the_middle),
        cmocka_unit_test(rows_of_textures_and_their_sum_count_all_tiles),
        cmocka_unit_test(sums_of_memory_count_all_slots),
        cmocka_unit_test(a_camera_that_looks_at_a_tile_sees_it_in_the_color_of_its_texture),
        cmocka_unit_test(tiles_show_their_column_and_row),
        cmocka_unit_test(thumbs_are_levels_of_their_textures),
        cmocka_unit_test(a_wireframe_draws_thin_lines_and_nothing_else),
        cmocka_unit_test(reasons_of_a_mode_are_those_that_the_library_chooses_by),
        cmocka_unit_test(filters_and_files_take_names_with_blanks_quotes_and_commas),
    };
    return tap_filter_stdout(), cmocka_run_group_tests(tests, begin, end);
}
