/* mkdtemp */
#define _XOPEN_SOURCE 700

/* Views of traced scenes against a model of the camera's rays and against the loader's own answers.
 */
#include "support/test.h"

#include "controls.h"
#include "scene_load.h"
#include "stage.h"
#include "traced.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIZE 96u
#define FRAME 20000u /* microseconds */
#define TEXELS_PER_UNIT 64.0
#define WALL_AT 8.0

static const char text[] =
    "LookAt 0 0 0  0 1 0  0 0 1\nCamera \"perspective\" \"float fov\" [ 60 ]\n"
    "Film \"image\" \"integer xresolution\" [ 96 ] \"integer yresolution\" [ 96 ]\nWorldBegin\n"
    "LightSource \"distant\" \"point from\" [ 0 -1 0 ] \"point to\" [ 0 0 0 ]\n"
    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"wall.tga\"\n"
    "Material \"matte\" \"texture Kd\" \"t\"\n"
    "Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point P\" [ -8 8 -6  8 8 -6  8 8 "
    "6 "
    "-8 8 6 ] \"float uv\" [ 0 0 1 0 1 1 0 1 ]\nWorldEnd\n";

static char folder[] = "/tmp/sluice-view-traced-XXXXXX";

static struct {
    struct gpu gpu;
    struct view_settings settings;
    struct view_camera camera;
    struct stage *stage; /* NULL: no device */
    struct traced *traced;
    uint64_t frame;
} show;

static void write_file(const char *name, const void *bytes, size_t size)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static void write_scene(void)
{
    enum { WIDTH = 1024, HEIGHT = 768 };
    static uint8_t picture[18 + 3 * WIDTH * HEIGHT];
    const uint8_t header[18] = {[2] = 2,      [12] = WIDTH & 255, WIDTH >> 8,
                                HEIGHT & 255, HEIGHT >> 8,        24};
    memcpy(picture, header, sizeof header);
    for (uint32_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
        picture[18 + i] = (uint8_t)(90 + i / 48 % 97);
    write_file("wall.tga", picture, sizeof picture);
    write_file("scene.pbrt", text, sizeof text - 1);
}

static void open_scene(uint64_t budget, double bias)
{
    char path[128], cache[128];
    struct scene_data scene;
    snprintf(path, sizeof path, "%s/scene.pbrt", folder);
    snprintf(cache, sizeof cache, "%s/cache", folder);
    const char *const paths[] = {path};
    const struct scene_request request = {.paths = paths, .path_count = 1, .cache = cache};
    const struct stage_request stage = {.gpu = &show.gpu, .threads = 1, .waits = true};
    controls_set_defaults(&show.settings);
    show.settings.anisotropy = 1;
    show.settings.most_samples = 1;
    show.settings.budget = budget;
    show.settings.lod_bias = bias;
    show.settings.view = VIEW_RESIDENT;
    show.frame = 0;
    assert_true(scene_open_paths(&request, &scene));
    show.stage = stage_create(&stage, &show.settings, &scene);
    assert_non_null(show.stage);
    show.camera = stage_camera(show.stage);
    show.traced = stage_traced(show.stage);
}

static void close_scene(void)
{
    stage_destroy(show.stage);
    show.stage = NULL;
}

static void draw(void)
{
    struct frames_end end = {0};
    show.frame++;
    const struct stage_draw draw = {.settings = &show.settings,
                                    .camera = show.camera,
                                    .width = SIZE,
                                    .height = SIZE,
                                    .number = show.frame,
                                    .time_stamp = show.frame * FRAME};
    stage_apply(show.stage, &show.settings);
    assert_true(stage_record(show.stage, &draw, VK_NULL_HANDLE, &end));
}

static void draw_until_complete(void)
{
    for (int i = 0; i < 60; i++)
        draw();
    assert_true(traced_complete(show.traced) == 1.0);
}

static const struct TracedView *view_of(uint32_t x, uint32_t y)
{
    return traced_view_at(show.traced, (x + 0.5f) / SIZE, (y + 0.5f) / SIZE);
}

struct model {
    double u, v, lod, density; /* hit of the ray through a pixel's center */
    bool hits;
};

/* The camera looks along y, z is up and +x is left. The cone of a ray covers an ellipse on the
 * wall: its width across, and as much longer along as the ray is oblique. */
static struct model model_at(uint32_t x, uint32_t y)
{
    const double half = tan(3.14159265358979 / 6), side = 2 * half / SIZE;
    const double left = half - (x + 0.5) * side, up = half - (y + 0.5) * side;
    const double length = sqrt(1 + left * left + up * up), distance = WALL_AT * length;
    const double across = TEXELS_PER_UNIT * atan(side) * distance;
    const struct model model = {.u = (left * WALL_AT + 8) / 16,
                                .v = 1 - (up * WALL_AT + 6) / 12,
                                .lod = log2(across * length),
                                .density = across};
    return model;
}

static void what_is_wanted_is_the_footprint_of_the_rays_cone(void **state)
{
    (void)state;
    if (!show.gpu.device)
        SKIP_TEST("no device that loads on demand");
    for (int bias = 0; bias < 2; bias++) {
        open_scene(0, bias);
        draw_until_complete();
        for (uint32_t i = 0; i < SIZE * SIZE; i++) {
            const struct model model = model_at(i % SIZE, i / SIZE);
            const struct TracedView *v = view_of(i % SIZE, i / SIZE);
            assert_non_null(v);
            assert_int_equal(v->state, TRACED_OPEN);
            assert_int_equal(v->levelCount, 11);
            assert_true(fabs((double)v->uv[0] - model.u) < 1e-5 &&
                        fabs((double)v->uv[1] - model.v) < 1e-5);
            assert_true(fabs((double)v->lod - model.lod - bias) < 2e-3);
            assert_true(fabs((double)v->density / exp2(bias) / model.density - 1) < 2e-3);
            if (fabs(model.lod + bias - round(model.lod + bias)) > 4e-3)
                assert_int_equal(v->wanted, (uint32_t)floor(model.lod + bias));
            assert_int_equal(traced_picture_of(show.traced, v->texture), 0);
        }
        close_scene();
    }
}

/* The finest level whose tile at a texel is resident, as the loader tells it. */
static uint32_t resident_at(double u, double v, uint32_t *page)
{
    const SluiceDemandTextureId id = show.traced->textures.images[0]->id;
    for (uint32_t level = 0; level < 11; level++) {
        const uint32_t w = 1024u >> level ? 1024u >> level : 1,
                       h = 768u >> level ? 768u >> level : 1;
        SluiceDemandTileInfo info = {.structSize = sizeof info};
        CHECK_OK(sluiceGetDemandTileInfo(show.traced->loader, id, level, (uint32_t)(u * w),
                                         (uint32_t)(v * h), &info));
        assert_true(info.isOpen);
        *page = info.page;
        if (info.state == SLUICE_DEMAND_PAGE_RESIDENT)
            return info.level;
    }
    *page = UINT32_MAX;
    return 10;
}

/* Tiles of the last launch arrive after it: levels that it showed may be coarser by then. */
static void check_resident_levels(bool at_rest)
{
    for (uint32_t i = 0; i < SIZE * SIZE; i += 7) {
        const struct TracedView *v = view_of(i % SIZE, i / SIZE);
        uint32_t page;
        if (!v || v->state != TRACED_OPEN)
            continue;
        const uint32_t level = resident_at((double)v->uv[0], (double)v->uv[1], &page);
        if (at_rest)
            assert_true(v->resident == level && v->page == page);
        else
            assert_true(v->resident >= level);
    }
}

static void what_is_resident_is_what_the_loader_says(void **state)
{
    (void)state;
    if (!show.gpu.device)
        SKIP_TEST("no device that loads on demand");
    uint32_t different = 0;
    open_scene(0, 0);
    for (int i = 0; i < 12; i++) {
        draw();
        check_resident_levels(false);
    }
    draw_until_complete();
    check_resident_levels(true);
    const struct view_camera before = show.camera;
    show.camera.position = vec3_add(before.position, vec3_scale(view_camera_forward(&before), 6));
    draw_until_complete(); /* finer tiles of the middle */
    show.camera = before;
    draw_until_complete();
    check_resident_levels(true);
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        const struct TracedView *v = view_of(i % SIZE, i / SIZE);
        assert_true(v->resident <= v->wanted); /* nothing is missing */
        different |= 1u << v->resident;
    }
    assert_true((different & (different - 1)) != 0); /* more than one level */
    close_scene();
}

static void dots_are_the_pixels_whose_rays_requested_something(void **state)
{
    (void)state;
    if (!show.gpu.device)
        SKIP_TEST("no device that loads on demand");
    uint32_t frames = 0;
    open_scene(0, 0);
    show.settings.view = VIEW_WRITTEN;
    for (int i = 0; i < 40; i++) {
        const struct traced *t = show.traced;
        uint32_t dots = 0;
        draw();
        const struct PbrtProbe *probes = t->parts->view.probes.mapped;
        for (uint32_t k = 0; k < SIZE * SIZE; k++)
            dots += t->rays > 0 && probes[k].launch == t->rays;
        assert_int_equal(dots, t->rays > 0 && t->sample == 0 ? t->missing : 0);
        frames += dots > 0;
    }
    assert_true(frames >= 2 && show.traced->rays == 0);
    close_scene();
}

static void ages_begin_when_the_loader_says_resident(void **state)
{
    (void)state;
    if (!show.gpu.device)
        SKIP_TEST("no device that loads on demand");
    enum { MOST = 4096 };
    static uint64_t first[MOST];
    uint32_t known = 0;
    memset(first, 0, sizeof first);
    open_scene(0, 0);
    show.settings.view = VIEW_AGE;
    for (int i = 0; i < 40; i++) {
        draw();
        for (uint32_t k = 0; k < SIZE * SIZE; k += 5) {
            const struct TracedView *v = view_of(k % SIZE, k / SIZE);
            if (!v || v->page == UINT32_MAX)
                continue;
            const struct traced_tile *tile = traced_tiles_find(&show.traced->tiles, v->page);
            assert_non_null(tile);
            assert_true(tile->here && tile->loads == 1);
            uint64_t *since = &first[v->page % MOST];
            /* Seen in the frame in which it came, or the next one. */
            if (*since == 0)
                *since = show.frame * FRAME;
            assert_true(tile->loaded[0] <= *since && *since - tile->loaded[0] <= 2 * FRAME);
            known++;
        }
    }
    assert_true(known > 0);
    close_scene();
}

static void frozen_wants_request_nothing_while_the_camera_moves(void **state)
{
    (void)state;
    if (!show.gpu.device)
        SKIP_TEST("no device that loads on demand");
    open_scene(0, 2);
    draw_until_complete();
    const uint64_t served = show.traced->now.servedCount;
    show.settings.freeze_wants = 1;
    show.settings.lod_bias = 0;
    for (int i = 0; i < 10; i++)
        draw();
    assert_true(show.traced->now.servedCount == served);
    assert_true(traced_complete(show.traced) < 1.0); /* finer levels are missing */
    show.settings.freeze_wants = 0;
    draw_until_complete();
    assert_true(show.traced->now.servedCount > served);
    close_scene();
}

/* All tiles of the map are tiles of the picture, and each resident one is in the map. */
static void the_map_of_memory_has_each_resident_tile(void **state)
{
    (void)state;
    if (!show.gpu.device)
        SKIP_TEST("no device that loads on demand");
    uint32_t resident = 0, placed = 0;
    open_scene(0, 0);
    draw_until_complete();
    draw();
    const struct traced_tiles *tiles = &show.traced->tiles;
    for (uint32_t i = 0; i < tiles->slot_count; i++)
        resident += tiles->slots[i].state == SLUICE_DEMAND_SLOT_RESIDENT;
    assert_true(resident == show.traced->now.residentTileCount && resident > 4);
    for (uint32_t i = 0; i < tiles->image_count; i++)
        for (uint32_t k = 0; k < tiles->images[i].slotCount; k++) {
            const SluiceDemandSlot *slot = traced_tiles_at(tiles, i, k);
            assert_true(!slot || (slot->image == tiles->images[i].image && slot->layer == k));
            placed += slot != NULL;
        }
    assert_int_equal(placed, resident);
    const struct traced_tile_sums sums = traced_tiles_sums(tiles);
    assert_true(sums.used == resident && sums.slots >= sums.used && sums.fragmentation < 1);
    close_scene();
}

/* The window's thread uses programs that the thread that opens the scene has compiled. */
static void programs_are_compiled_by_the_thread_that_opens_the_scene(void **state)
{
    (void)state;
    if (!show.gpu.device)
        SKIP_TEST("no device that loads on demand");
    char path[128], cache[128];
    struct scene_data scene;
    struct file_list paths = {0};
    snprintf(path, sizeof path, "%s/scene.pbrt", folder);
    snprintf(cache, sizeof cache, "%s/cache", folder);
    assert_true(files_add(path, &paths));
    for (uint32_t threads = 1; threads <= 2; threads++) {
        const struct scene_request how = {.cache = cache, .gpu = &show.gpu, .threads = threads};
        const struct stage_request request = {.gpu = &show.gpu, .threads = 1, .waits = true};
        struct scene_load *load = scene_load_begin(&paths, &how);
        assert_non_null(load);
        assert_true(scene_load_end(load, &scene, &paths));
        const struct traced_parts *parts = scene.pbrt->parts;
        assert_true(parts && (parts->tracing.compute || parts->tracing.rays.pipeline));
        controls_set_defaults(&show.settings);
        show.stage = stage_create(&request, &show.settings, &scene);
        assert_non_null(show.stage);
        assert_int_equal(stage_traced(show.stage)->parts == parts, threads == 1);
        close_scene();
    }
    struct scene_load *canceled = NULL;
    const struct scene_request how = {.cache = cache, .gpu = &show.gpu, .threads = 1};
    struct scene_load *load = scene_load_begin(&paths, &how);
    assert_non_null(load);
    scene_load_keep_canceled(load, &canceled);
    scene_load_drop_canceled(&canceled, true);
    assert_null(canceled);
}

static int begin(void **state)
{
    (void)state;
    bool unsupported = false;
    const struct gpu_request request = {
        .modes = {SLUICE_RESIDENCY_MODE_PAGED, SLUICE_RESIDENCY_MODE_AUTO},
        .ray_tracing = true,
        .build_queue = true,
        .buffer_addresses = true,
        .byte_pages = true};
    if (!mkdtemp(folder))
        return -1;
    write_scene();
    if (!gpu_create(&request, &show.gpu, &unsupported))
        return unsupported ? 0 : -1;
    if (show.gpu.buffer_addresses && show.gpu.byte_pages)
        return 0;
    gpu_destroy(&show.gpu);
    show.gpu = (struct gpu){0};
    return 0;
}

static int end(void **state)
{
    char command[128];
    (void)state;
    if (show.gpu.device)
        gpu_destroy(&show.gpu);
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_wanted_is_the_footprint_of_the_rays_cone),
        cmocka_unit_test(what_is_resident_is_what_the_loader_says),
        cmocka_unit_test(dots_are_the_pixels_whose_rays_requested_something),
        cmocka_unit_test(ages_begin_when_the_loader_says_resident),
        cmocka_unit_test(frozen_wants_request_nothing_while_the_camera_moves),
        cmocka_unit_test(the_map_of_memory_has_each_resident_tile),
        cmocka_unit_test(programs_are_compiled_by_the_thread_that_opens_the_scene),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
