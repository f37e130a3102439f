/* Layers of arrays in demand loading. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <math.h>
#include <string.h>

static struct harness h;

enum { LAYERS = 3 };

/* An array of three layers with levels of tiles and a mip tail, and its grid. */
struct layered {
    struct runner_image images[LAYERS];
    SluiceImageSource *source;
    SluiceDemandTextureId ids[LAYERS], grid;
};

static void add_layers(struct layered *a, struct runner *r)
{
    for (uint32_t i = 0; i < LAYERS; i++) {
        const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                    .image = {.source = a->source, .arrayLayer = i},
                                                    .pSampler = &runner_nearest,
                                                    .failureColor = {1, 0, 1, 1}};
        CHECK_OK(sluiceAddDemandTexture(r->loader, &info, &a->ids[i]));
    }
    const SluiceDemandGridCreateInfo grid = {.structSize = sizeof grid,
                                             .columnCount = LAYERS,
                                             .rowCount = 1,
                                             .pTextureIds = a->ids,
                                             .missingColor = {0.25f, 0.5f, 0.75f, 1}};
    CHECK_OK(sluiceAddDemandGrid(r->loader, &grid, &a->grid));
}

static void layered_init(struct layered *a)
{
    SluiceImageSource *layers[LAYERS];
    for (uint32_t i = 0; i < LAYERS; i++) {
        runner_image_init(&a->images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, 600, 300, 70 + i);
        layers[i] = &a->images[i].source.base;
    }
    CHECK_OK(sluiceCreateArrayImageSource(layers, LAYERS, NULL, &a->source));
}

static void layered_finish(struct layered *a)
{
    sluiceDestroyImageSource(a->source);
    for (uint32_t i = 0; i < LAYERS; i++)
        runner_image_finish(&a->images[i]);
}

static void add_layer_texel(struct runner *r, SluiceDemandTextureId grid, uint32_t layer,
                            uint32_t level, uint32_t x, uint32_t y)
{
    uint32_t width = 600u >> level, height = 300u >> level;
    struct RunnerInput in = {
        .kind = r->count % 2 ? RUNNER_LAYER_LOD : RUNNER_LAYER_GRAD,
        .index = (uint32_t)grid,
        .uv = {((float)x + 0.5f) / (float)width, ((float)y + 0.5f) / (float)(height ? height : 1)},
        .dx = {(float)level},
        .cell = layer};
    if (in.kind == RUNNER_LAYER_GRAD)
        in.dx[0] = in.dy[1] = 0.9f * (float)(1u << level) / 600;
    runner_add(r, in);
}

/* Places in tiles, in the mip tail, and in the last level. */
static const uint32_t texels[][3] = {{0, 599, 299}, {0, 130, 5}, {1, 299, 149}, {2, 140, 70},
                                     {3, 10, 20},   {4, 36, 17}, {9, 0, 0}};
enum { TEXELS = sizeof texels / sizeof texels[0] };

static void add_every_layer(struct runner *r, const struct layered *a)
{
    for (uint32_t i = 0; i < TEXELS * LAYERS; i++)
        add_layer_texel(r, a->grid, i / TEXELS, texels[i % TEXELS][0], texels[i % TEXELS][1],
                        texels[i % TEXELS][2]);
}

static void check_every_layer(struct runner *r, struct layered *a)
{
    for (uint32_t i = 0; i < TEXELS * LAYERS; i++)
        runner_check_texel(r, i, &a->images[i / TEXELS], texels[i % TEXELS][0],
                           texels[i % TEXELS][1], texels[i % TEXELS][2]);
}

static void a_layer_shows_the_texels_of_that_layer_in_all_levels(void **state)
{
    (void)state;
    struct runner r;
    struct layered a;
    runner_init(&r, &h, NULL);
    runner_sample_grids(&r);
    layered_init(&a);
    add_layers(&a, &r);
    add_every_layer(&r, &a);
    runner_load(&r, 20);
    assert_int_equal(r.requests.missingCount, 0);
    check_every_layer(&r, &a);
    runner_finish(&r);
    layered_finish(&a);
}

static void layers_beyond_the_last_are_the_last_and_empty_cells_have_the_missing_color(void **state)
{
    (void)state;
    struct runner r;
    struct layered a;
    runner_init(&r, &h, NULL);
    runner_sample_grids(&r);
    layered_init(&a);
    add_layers(&a, &r);
    add_layer_texel(&r, a.grid, LAYERS, 0, 17, 33);
    add_layer_texel(&r, a.grid, UINT32_MAX, 0, 17, 33);
    add_layer_texel(&r, a.ids[1], 2, 0, 17, 33); /* no grid: its own only layer */
    add_layer_texel(&r, a.grid, 0, 0, 17, 33);
    runner_load(&r, 20);
    runner_check_texel(&r, 0, &a.images[2], 0, 17, 33);
    runner_check_texel(&r, 1, &a.images[2], 0, 17, 33);
    runner_check_texel(&r, 2, &a.images[1], 0, 17, 33);
    runner_check_texel(&r, 3, &a.images[0], 0, 17, 33);
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, a.ids[0]));
    runner_launch(&r);
    const float missing[4] = {0.25f, 0.5f, 0.75f, 1};
    struct RunnerOutput out = runner_output(&r, 3);
    assert_true(out.resident);
    assert_memory_equal(out.color, missing, sizeof missing);
    runner_check_texel(&r, 2, &a.images[1], 0, 17, 33);
    runner_finish(&r);
    layered_finish(&a);
}

static void an_image_without_the_layer_shows_its_failure_color(void **state)
{
    (void)state;
    struct runner r;
    struct layered a;
    SluiceDemandTextureId ids[2];
    h.quiet = true;
    runner_init(&r, &h, NULL);
    layered_init(&a);
    for (uint32_t i = 0; i < 2; i++) {
        const SluiceDemandTextureCreateInfo info = {
            .structSize = sizeof info,
            .image = {.source = i ? &a.images[0].source.base : a.source,
                      .arrayLayer = i ? 1 : LAYERS},
            .failureColor = {1, 0, 1, 1}};
        CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &ids[i]));
        runner_add_texel(&r, ids[i], 600, 300, 0, 1, 1);
    }
    uint32_t errors = h.log_count[SLUICE_LOG_ERROR];
    runner_load(&r, 9);
    assert_int_equal(h.log_count[SLUICE_LOG_ERROR], errors + 2);
    for (uint32_t i = 0; i < 2; i++) {
        struct RunnerOutput out = runner_output(&r, i);
        const float failure[4] = {1, 0, 1, 1};
        assert_true(out.resident);
        assert_memory_equal(out.color, failure, sizeof failure);
    }
    runner_finish(&r);
    layered_finish(&a);
    h.quiet = false;
}

/* A second loader of the context finds the tiles of each layer, not those of another one. */
static void front_ends_share_the_tiles_of_layers(void **state)
{
    (void)state;
    struct runner r[2];
    struct layered a;
    uint64_t reads = 0;
    layered_init(&a);
    for (uint32_t i = 0; i < 2; i++) {
        runner_init(&r[i], &h, NULL);
        runner_sample_grids(&r[i]);
        add_layers(&a, &r[i]);
        add_every_layer(&r[i], &a);
    }
    runner_load(&r[0], 20);
    for (uint32_t i = 0; i < LAYERS; i++)
        reads += a.images[i].source.read_count;
    runner_load(&r[1], 40);
    check_every_layer(&r[0], &a);
    check_every_layer(&r[1], &a);
    uint64_t tiles = runner_statistics(&r[1]).sharedCount;
    assert_in_range(tiles, 4 * LAYERS, 5 * LAYERS);
    for (uint32_t i = 0; i < LAYERS; i++)
        reads -= a.images[i].source.read_count;
    /* The second loader read base colors and mip tails alone. */
    assert_in_range(0 - reads, 2 * LAYERS, 9 * LAYERS);
    runner_finish(&r[1]);
    runner_finish(&r[0]);
    layered_finish(&a);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_layer_shows_the_texels_of_that_layer_in_all_levels),
        cmocka_unit_test(
            layers_beyond_the_last_are_the_last_and_empty_cells_have_the_missing_color),
        cmocka_unit_test(an_image_without_the_layer_shows_its_failure_color),
        cmocka_unit_test(front_ends_share_the_tiles_of_layers),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
