/*
 * UDIM sets in demand loading, compared with an oracle that lays the cells out as one large image
 * and filters it in double precision.
 */
#include "device/demand_runner.h"

#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

static struct harness h;

enum { COLUMNS = 3, ROWS = 2, CELLS = COLUMNS * ROWS };

/* Weights of shaders are steps of 1/256, along two axes and between two levels. */
#define TOLERANCE 0.01

static const float missing_color[4] = {0.25f, 0.5f, 0.75f, 1};
static const float failure_color[4] = {1, 0, 1, 1};

struct set {
    struct runner_image images[CELLS]; ///< width 0: empty cell
    struct runner_image base;
    SluiceDemandTextureId ids[CELLS], base_id, grid;
};

static const SluiceDemandSampler linear = {.structSize = sizeof linear, .maxAnisotropy = 4};

static SluiceDemandTextureId add_texture(struct runner *r, struct runner_image *image)
{
    SluiceDemandTextureId id;
    const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                .image = runner_image_desc(image),
                                                .pSampler = &linear,
                                                .failureColor = {1, 0, 1, 1}};
    CHECK_OK(sluiceAddDemandTexture(r->loader, &info, &id));
    return id;
}

static void add_grid(struct set *set, struct runner *r)
{
    const SluiceDemandGridCreateInfo info = {.structSize = sizeof info,
                                             .columnCount = COLUMNS,
                                             .rowCount = ROWS,
                                             .pTextureIds = set->ids,
                                             .missingColor = {0.25f, 0.5f, 0.75f, 1},
                                             .baseId = set->base_id};
    CHECK_OK(sluiceAddDemandGrid(r->loader, &info, &set->grid));
}

/* `sizes`: size of level 0 of each cell along both axes; 0: empty. */
static void set_init(struct set *set, struct runner *r, const uint32_t sizes[CELLS],
                     uint32_t base_width)
{
    memset(set, 0, sizeof *set);
    runner_init(r, &h, NULL);
    runner_sample_grids(r);
    for (uint32_t i = 0; i < CELLS; i++) {
        if (sizes[i] == 0)
            continue;
        runner_image_init(&set->images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, sizes[i], sizes[i],
                          90 + i);
        set->ids[i] = add_texture(r, &set->images[i]);
    }
    if (base_width) {
        runner_image_init(&set->base, SLUICE_FORMAT_R8G8B8A8_UNORM, base_width,
                          base_width / COLUMNS * ROWS, 98);
        set->base_id = add_texture(r, &set->base);
    }
    add_grid(set, r);
}

static void set_finish(struct set *set, struct runner *r)
{
    runner_finish(r);
    for (uint32_t i = 0; i < CELLS; i++)
        if (set->images[i].info.width)
            runner_image_finish(&set->images[i]);
    if (set->base.info.width)
        runner_image_finish(&set->base);
}

static void add_sample(struct runner *r, const struct set *set, double u, double v, double dx,
                       double dy)
{
    runner_add(r, (struct RunnerInput){.kind = RUNNER_UDIM_GRAD,
                                       .index = (uint32_t)set->grid,
                                       .uv = {(float)u, (float)v},
                                       .dx = {(float)dx},
                                       .dy = {0, (float)dy}});
}

/* --- the oracle --- */

struct sum {
    double color[4], weight;
};

static struct runner_image *cell_at(struct set *set, int64_t column, int64_t row)
{
    if (column < 0 || column >= COLUMNS || row < 0 || row >= ROWS)
        return NULL;
    struct runner_image *image = &set->images[row * COLUMNS + column];
    bool opens = image->info.width && image->open_result == SLUICE_SUCCESS;
    return opens ? image : NULL;
}

/* Adds texel (x, y) of a level of the large image, whose cells have n x n texels. */
static void add_texel(struct sum *sum, struct set *set, uint32_t level, int64_t n, int64_t x,
                      int64_t y, double weight)
{
    int64_t column = (x - (x % n + n) % n) / n, row = (y - (y % n + n) % n) / n;
    struct runner_image *image = cell_at(set, column, row);
    float texel[4];
    if (!image || weight == 0)
        return; /* edges to cells without a texture are clamped */
    runner_image_texel(image, level, (uint32_t)(x - column * n), (uint32_t)(y - row * n), texel);
    for (uint32_t c = 0; c < 4; c++)
        sum->color[c] += weight * (double)texel[c];
    sum->weight += weight;
}

static void add_bilinear(struct sum *sum, struct set *set, uint32_t size, uint32_t level, double u,
                         double v, double weight)
{
    int64_t n = size >> level ? size >> level : 1;
    double x = u * (double)n - 0.5, y = v * (double)n - 0.5;
    int64_t left = (int64_t)floor(x), top = (int64_t)floor(y);
    double right = x - floor(x), below = y - floor(y);
    for (int64_t i = 0; i < 4; i++)
        add_texel(sum, set, level, n, left + i % 2, top + i / 2,
                  weight * (i % 2 ? right : 1 - right) * (i / 2 ? below : 1 - below));
}

/* Computes the color for cells of one size. Derivatives are (dx, 0) and (0, dy), above 0. */
static void expect(struct set *set, uint32_t size, const struct RunnerInput *in, double color[4])
{
    double u = (double)in->uv[0], v = (double)in->uv[1];
    double dx = (double)in->dx[0], dy = (double)in->dy[1];
    double major = fmax(dx, dy), minor = fmax(fmin(dx, dy), major / 4);
    double last = log2(size), lod = fmin(fmax(log2(minor * size), 0), last);
    double count = log2(minor * size) >= last ? 1 : ceil(major / (exp2(lod) / size) - 0.01);
    count = fmin(fmax(count, 1), 4);
    int64_t column = (int64_t)floor(u), row = (int64_t)floor(v);
    memset(color, 0, 4 * sizeof *color);
    for (uint32_t i = 0; i < (uint32_t)count; i++) {
        double along = (i + 0.5) / count - 0.5;
        double at[2] = {u + (dx >= dy ? along * dx : 0), v + (dx >= dy ? 0 : along * dy)};
        if (!cell_at(set, (int64_t)floor(at[0]), (int64_t)floor(at[1]))) {
            at[0] = fmin(fmax(at[0], (double)column), (double)column + 1);
            at[1] = fmin(fmax(at[1], (double)row), (double)row + 1);
        }
        struct sum sum = {0};
        uint32_t fine = (uint32_t)lod;
        add_bilinear(&sum, set, size, fine, at[0], at[1], 1 - (lod - fine));
        if (lod > fine)
            add_bilinear(&sum, set, size, fine + 1, at[0], at[1], lod - fine);
        for (uint32_t c = 0; c < 4; c++)
            color[c] += sum.color[c] / sum.weight / count;
    }
}

static void check_color(const struct runner *r, uint32_t sample, const double color[4],
                        double tolerance)
{
    const struct RunnerInput *in = &((const struct RunnerInput *)r->inputs.mapped)[sample];
    struct RunnerOutput out = runner_output(r, sample);
    for (uint32_t c = 0; c < 4; c++)
        if (!out.resident || !(fabs((double)out.color[c] - color[c]) <= tolerance))
            fail_msg("sample %u at (%.9g, %.9g), derivatives %g and %g, channel %u: %s, %g instead "
                     "of %g",
                     sample, (double)in->uv[0], (double)in->uv[1], (double)in->dx[0],
                     (double)in->dy[1], c, out.resident ? "resident" : "missing",
                     (double)out.color[c], color[c]);
}

static void check_fixed(const struct runner *r, uint32_t sample, const float color[4])
{
    const double expected[4] = {(double)color[0], (double)color[1], (double)color[2],
                                (double)color[3]};
    check_color(r, sample, expected, 1e-6);
}

/* --- draws --- */

static uint32_t draw(void)
{
    static uint32_t state = 20261123;
    state ^= state << 13;
    state ^= state >> 17;
    state ^= state << 5;
    return state;
}

static double draw_unit(void)
{
    return draw() / 4294967296.0;
}

/* Draws a coordinate, often near the edge of a cell, in texels of a level. */
static double draw_near_edge(uint32_t cells, uint32_t size, double lod)
{
    double texel = exp2(fmax(lod, 0)) / size;
    double edge = (double)(draw() % (cells + 1));
    double offset = (4 * draw_unit() - 2) * texel;
    double anywhere = draw_unit() * cells;
    double at = draw() % 4 ? edge + offset : anywhere;
    return fmin(fmax(at, 1e-4), cells - 1e-4);
}

/* --- tests --- */

static void cells_are_filtered_as_one_large_image(void **state)
{
    (void)state;
    enum { SAMPLES = 6000, SIZE = 256 };
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {SIZE, SIZE, SIZE, SIZE, 0, SIZE};
    uint32_t checked = 0;
    set_init(&set, &r, sizes, 0);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double lod = draw_unit() * 11 - 1;
        double u = draw_near_edge(COLUMNS, SIZE, lod), v = draw_near_edge(ROWS, SIZE, lod);
        double width = exp2(lod) / SIZE, ratio = i % 3 ? 1 : 1.5 + (draw() % 4);
        bool across = draw() % 2;
        add_sample(&r, &set, u, v, across ? width * ratio : width, across ? width : width * ratio);
    }
    assert_in_range(runner_load(&r, 30), 3, 29);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const struct RunnerInput *in = &((const struct RunnerInput *)r.inputs.mapped)[i];
        double color[4];
        if (cell_at(&set, (int64_t)in->uv[0], (int64_t)in->uv[1])) {
            expect(&set, SIZE, in, color);
            check_color(&r, i, color, TOLERANCE);
            checked++;
        } else {
            check_fixed(&r, i, missing_color);
        }
    }
    assert_in_range(checked, SAMPLES / 2, SAMPLES - SAMPLES / 20);
    set_finish(&set, &r);
}

static void outside_and_in_empty_cells_is_the_missing_color(void **state)
{
    (void)state;
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {64, 0, 64, 64, 64, 64};
    static const double at[][2] = {{-0.001, 0.5}, {3, 0.5},    {0.5, -1e-6}, {0.5, 2},
                                   {1.5, 0.5},    {1e30, 0.5}, {1.001, 0.5}};
    set_init(&set, &r, sizes, 0);
    for (uint32_t i = 0; i < 7; i++)
        add_sample(&r, &set, at[i][0], at[i][1], 0.01, 0.01);
    add_sample(&r, &set, (double)NAN, 0.5, 0.01, 0.01); /* like (0, 0) */
    add_sample(&r, &set, 0, 0, 0.01, 0.01);
    add_sample(&r, &set, 0.3, 0.3, (double)INFINITY, 0.01);
    add_sample(&r, &set, 0.5, 0.5, 100, 100);
    runner_load(&r, 20);
    assert_int_equal(r.requests.missingCount, 0);
    for (uint32_t i = 0; i < 7; i++)
        check_fixed(&r, i, missing_color);
    for (uint32_t c = 0; c < 4; c++)
        assert_true(runner_output(&r, 7).color[c] == runner_output(&r, 8).color[c]);
    for (uint32_t i = 9; i < 11; i++) {
        struct RunnerOutput out = runner_output(&r, i);
        assert_true(out.resident && out.color[0] >= 0 && out.color[0] <= 1);
    }
    set_finish(&set, &r);
}

/* Sizes from 1 texel to several tiles: the colors on both sides of an edge must meet. */
static void edges_between_cells_of_different_sizes_do_not_show(void **state)
{
    (void)state;
    enum { SAMPLES = 1000 };
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {512, 64, 1, 256, 300, 16};
    set_init(&set, &r, sizes, 0);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        /* Corners are excluded: where four cells of different sizes meet, the edge may show. */
        double width = exp2(draw_unit() * 9 - 11), room = fmin(fmax(0.04, 2 * width), 0.45);
        bool across = draw() % 3 == 0;
        double edge = across ? 1 : 1 + (draw() % 2), along = draw() % (across ? COLUMNS : ROWS);
        along += room + draw_unit() * (1 - 2 * room);
        for (uint32_t side = 0; side < 2; side++) {
            double at = edge + (side ? 2e-7 : -2e-7);
            add_sample(&r, &set, across ? along : at, across ? at : along, width, width);
        }
    }
    assert_in_range(runner_load(&r, 30), 3, 29);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        struct RunnerOutput out = runner_output(&r, 2 * i + 1);
        const double other[4] = {(double)out.color[0], (double)out.color[1], (double)out.color[2],
                                 (double)out.color[3]};
        check_color(&r, 2 * i, other, TOLERANCE);
    }
    set_finish(&set, &r);
}

/* sluiceDemandGrad shows the edge, so the test above can fail. */
static void cells_by_themselves_are_clamped(void **state)
{
    (void)state;
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {64, 64, 64, 64, 64, 64};
    set_init(&set, &r, sizes, 0);
    for (uint32_t i = 0; i < 2; i++) {
        add_sample(&r, &set, i ? 1.00001 : 0.99999, 0.4, 1.0 / 64, 1.0 / 64);
        ((struct RunnerInput *)r.inputs.mapped)[i].kind = RUNNER_LAYER_GRAD;
        ((struct RunnerInput *)r.inputs.mapped)[i].uv[0] = i ? 0 : 1;
        ((struct RunnerInput *)r.inputs.mapped)[i].cell = i;
    }
    runner_load(&r, 20);
    struct RunnerOutput left = runner_output(&r, 0), right = runner_output(&r, 1);
    assert_true(left.resident && right.resident);
    assert_true(fabsf(left.color[0] - right.color[0]) > 2 * (float)TOLERANCE);
    set_finish(&set, &r);
}

static void add_base_sample(struct runner *r, const struct set *set, double u, double v,
                            double width)
{
    add_sample(r, set, u, v, width, width);
    /* sample the base alone, between its edges */
    runner_add(r, (struct RunnerInput){.kind = RUNNER_GRAD,
                                       .index = (uint32_t)set->base_id,
                                       .uv = {(float)(u / COLUMNS), (float)(v / ROWS)},
                                       .dx = {(float)(width / COLUMNS)},
                                       .dy = {0, (float)(width / ROWS)}});
}

static void the_base_shows_where_it_is_sharp_enough_and_in_empty_cells(void **state)
{
    (void)state;
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {256, 256, 0, 256, 256, 256};
    set_init(&set, &r, sizes, 96); /* 32 x 32 texels for each cell */
    add_base_sample(&r, &set, 0.7, 0.6, 1.01 / 32);
    add_base_sample(&r, &set, 1.001, 0.999, 1.0 / 8); /* across cells */
    add_base_sample(&r, &set, 1.5, 1.5, 0.8);
    add_base_sample(&r, &set, 2.5, 0.5, 1.0 / 256); /* an empty cell: magnified */
    runner_load(&r, 20);
    assert_int_equal(r.requests.missingCount, 0);
    for (uint32_t i = 0; i < 8; i += 2) {
        struct RunnerOutput out = runner_output(&r, i + 1);
        const double alone[4] = {(double)out.color[0], (double)out.color[1], (double)out.color[2],
                                 (double)out.color[3]};
        check_color(&r, i, alone, 0.005);
    }
    for (uint32_t i = 0; i < CELLS; i++)
        assert_int_equal(set.images[i].opened, 0);
    /* At a slightly finer level the sample's cells are read, and no others. */
    add_sample(&r, &set, 0.7, 0.6, 0.9 / 32, 0.9 / 32);
    runner_load(&r, 20);
    double color[4];
    expect(&set, 256, &((struct RunnerInput *)r.inputs.mapped)[8], color);
    check_color(&r, 8, color, TOLERANCE);
    assert_int_equal(set.images[0].opened, 1);
    assert_int_equal(set.images[1].opened, 0);
    /* The grid loses its base, and behaves as if it never had one. */
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, set.base_id));
    runner_load(&r, 20);
    expect(&set, 256, &((struct RunnerInput *)r.inputs.mapped)[0], color);
    check_color(&r, 0, color, TOLERANCE);
    check_fixed(&r, 6, missing_color);
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, set.grid));
    runner_load(&r, 20);
    for (uint32_t i = 0; i < 8; i += 2)
        check_fixed(&r, i, missing_color);
    set_finish(&set, &r);
}

static void a_damaged_file_spoils_its_cell_alone(void **state)
{
    (void)state;
    enum { SIZE = 128, SAMPLES = 400 };
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {SIZE, SIZE, SIZE, SIZE, SIZE, SIZE};
    h.quiet = true;
    set_init(&set, &r, sizes, 48); /* 16 x 16 texels for each cell */
    set.images[1].open_result = SLUICE_ERROR_UNSUPPORTED;
    for (uint32_t i = 0; i < SAMPLES; i++) {
        double width = exp2(draw_unit() * 2.9) / SIZE; /* the base has an eighth */
        double u = draw_near_edge(COLUMNS, SIZE, 2);
        double v = draw_near_edge(ROWS, SIZE, 2);
        add_sample(&r, &set, u, v, width, width);
    }
    add_base_sample(&r, &set, 1.5, 0.5, 1.0 / 8);
    runner_load(&r, 30);
    assert_int_equal(r.requests.missingCount, 0);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        const struct RunnerInput *in = &((const struct RunnerInput *)r.inputs.mapped)[i];
        double color[4];
        if (!cell_at(&set, (int64_t)in->uv[0], (int64_t)in->uv[1])) {
            check_fixed(&r, i, failure_color);
            continue;
        }
        expect(&set, SIZE, in, color);
        check_color(&r, i, color, TOLERANCE);
    }
    struct RunnerOutput out = runner_output(&r, SAMPLES + 1);
    const double alone[4] = {(double)out.color[0], (double)out.color[1], (double)out.color[2],
                             (double)out.color[3]};
    check_color(&r, SAMPLES, alone, 0.005);
    set_finish(&set, &r);
    h.quiet = false;
}

static void a_base_that_cannot_be_opened_is_as_none(void **state)
{
    (void)state;
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {64, 64, 0, 64, 64, 64};
    h.quiet = true;
    set_init(&set, &r, sizes, 48);
    set.base.open_result = SLUICE_ERROR_UNSUPPORTED;
    add_sample(&r, &set, 0.99, 0.5, 0.3, 0.3);
    add_sample(&r, &set, 2.5, 0.5, 0.3, 0.3);
    runner_load(&r, 20);
    double color[4];
    expect(&set, 64, (struct RunnerInput *)r.inputs.mapped, color);
    check_color(&r, 0, color, TOLERANCE);
    check_fixed(&r, 1, missing_color);
    set_finish(&set, &r);
    h.quiet = false;
}

enum { COMPARED = 600, COMPARED_LAUNCHES = 8 };

/* Runs launches in one language, and records outputs and misses. Cells have two sizes; one is
 * empty, one fails. */
static void run_launches(bool hlsl, struct RunnerOutput outputs[][COMPARED],
                         uint32_t missing[COMPARED_LAUNCHES])
{
    struct runner r;
    static struct set set;
    const uint32_t sizes[CELLS] = {256, 64, 256, 256, 0, 64};
    set_init(&set, &r, sizes, 48);
    set.images[3].open_result = SLUICE_ERROR_CORRUPT_DATA;
    if (hlsl)
        runner_sample_in_hlsl(&r, false);
    roll_seed(81);
    for (uint32_t i = 0; i < COMPARED; i++) {
        static const uint32_t kinds[] = {RUNNER_UDIM_GRAD, RUNNER_UDIM_GRAD, RUNNER_LAYER_GRAD,
                                         RUNNER_LAYER_LOD};
        struct RunnerInput in = {.kind = kinds[i % 4], .index = (uint32_t)set.grid};
        double width = exp2(11.0 * roll() / ROLL_MAX - 9);
        in.cell = (uint32_t)roll() % (CELLS + 2);
        in.uv[0] = (float)(roll() % 385 / 128.0 + (roll() % 5 - 2.0) / 1024);
        in.uv[1] = (float)(roll() % 257 / 128.0 + (roll() % 5 - 2.0) / 1024);
        in.dx[0] = in.kind == RUNNER_LAYER_LOD ? (float)(roll() % 80) / 8 : (float)width;
        in.dy[1] = (float)(width * (1 + roll() % 4));
        runner_add(&r, in);
    }
    for (uint32_t k = 0; k < COMPARED_LAUNCHES; k++) {
        runner_launch(&r);
        missing[k] = r.requests.missingCount;
        memcpy(outputs[k], r.outputs.mapped, sizeof outputs[k]);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
    set_finish(&set, &r);
}

static void hlsl_samples_and_requests_what_glsl_does(void **state)
{
    static struct RunnerOutput glsl[COMPARED_LAUNCHES][COMPARED], hlsl[COMPARED_LAUNCHES][COMPARED];
    uint32_t misses[2][COMPARED_LAUNCHES];
    (void)state;
    run_launches(false, glsl, misses[0]);
    run_launches(true, hlsl, misses[1]);
    for (uint32_t k = 0; k < COMPARED_LAUNCHES; k++) {
        assert_int_equal(misses[1][k], misses[0][k]);
        for (uint32_t i = 0; i < COMPARED; i++)
            if (memcmp(&glsl[k][i], &hlsl[k][i], sizeof glsl[k][i]) != 0)
                fail_msg("launch %u, sample %u: HLSL %.9g, resident %u; GLSL %.9g, resident %u", k,
                         i, (double)hlsl[k][i].color[1], hlsl[k][i].resident,
                         (double)glsl[k][i].color[1], glsl[k][i].resident);
    }
    assert_true(misses[0][0] > 0 && misses[0][1] > 0);
    assert_int_equal(misses[0][COMPARED_LAUNCHES - 1], 0);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_are_filtered_as_one_large_image),
        cmocka_unit_test(outside_and_in_empty_cells_is_the_missing_color),
        cmocka_unit_test(edges_between_cells_of_different_sizes_do_not_show),
        cmocka_unit_test(cells_by_themselves_are_clamped),
        cmocka_unit_test(the_base_shows_where_it_is_sharp_enough_and_in_empty_cells),
        cmocka_unit_test(a_damaged_file_spoils_its_cell_alone),
        cmocka_unit_test(a_base_that_cannot_be_opened_is_as_none),
        cmocka_unit_test(hlsl_samples_and_requests_what_glsl_does),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
