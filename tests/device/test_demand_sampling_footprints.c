/*
 * Requests of samples if nothing is resident: all their texels, and nothing else. Each sample has a
 * texture of its own, which identifies it.
 */
#include "device/demand_images.h"
#include "device/demand_oracle.h"
#include "device/demand_samples.h"

#include "base/checked.h"
#include "demand/tail_place.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define TILE_LOG2 7u

static const uint32_t sizes[][2] = {{2000, 1500}, {4095, 4095}, {16384, 1}, {1, 1},   {1, 16384},
                                    {1009, 2003}, {127, 131},   {64, 64},   {65, 64}, {300, 7}};
#define SIZES (sizeof sizes / sizeof sizes[0])
#define ROUNDS (SIZES + 5) /* the last ones use fragments */

struct sets {
    struct demand_scene *scene;
    uint32_t index, first; ///< index of the first page
    const struct SluiceDemandTexture *entry;
    struct demand_tap tap;
    uint8_t required[2048], may[2048], touched[2048]; ///< by page of the texture
};

static void add_touch(void *user, const struct demand_touch *touch)
{
    struct sets *s = user;
    if (touch->x < 0)
        return;
    uint32_t page =
        demand_scene_page(s->scene, s->index, s->tap.level, (uint32_t)touch->x, (uint32_t)touch->y);
    if (page == DEMAND_NO_PAGE)
        return;
    page -= s->first;
    s->may[page] = 1;
    s->required[page] |= s->tap.sure && touch->sure;
    s->touched[page] |= s->tap.weight * touch->weight > 1e-4;
}

static void add_tap(void *user, const struct demand_tap *tap)
{
    struct sets *s = user;
    s->tap = *tap;
    demand_oracle_touches(s->entry, tap, add_touch, s);
}

struct totals {
    uint64_t samples, requested, touched, nothing;
};

/* Checks the requests of one sample, and clears them. */
static void check_requests(struct sets *s, const struct DemandInput *in, uint32_t page_count,
                           struct totals *totals)
{
    memset(s->required, 0, page_count);
    memset(s->may, 0, page_count);
    memset(s->touched, 0, page_count);
    bool sure = demand_oracle_taps(s->entry, in, 0, add_tap, s);
    const struct DemandOutput *out = &demand_outputs(s->scene)[in - demand_inputs(s->scene)];
    bool any = false;
    for (uint32_t i = 0; i < page_count; i++) {
        bool asked = demand_requested(s->scene, s->first + i);
        if (asked ? !s->may[i] : s->required[i])
            fail_msg(
                "%ux%u, modes %u %u, anisotropy %g, kind %u, uv %.9g %.9g, dx %g %g, dy %g %g, "
                "lod %g: page %u is %s",
                s->entry->width, s->entry->height,
                s->entry->shape >> SLUICE_DEMAND_MODE_U_SHIFT & 7,
                s->entry->shape >> SLUICE_DEMAND_MODE_V_SHIFT & 7, (double)s->entry->maxAnisotropy,
                in->kind, (double)in->uv[0], (double)in->uv[1], (double)in->dx[0],
                (double)in->dx[1], (double)in->dy[0], (double)in->dy[1], (double)in->lod, i,
                asked ? "not touched" : "not asked for");
        any |= asked;
        totals->requested += sure && asked;
        totals->touched += sure && s->touched[i];
        ((uint32_t *)s->scene->requests.mapped)[(s->first + i) / 32] &=
            ~(1u << (s->first + i) % 32);
    }
    assert_int_equal(out->resident, !any);
    for (int c = 0; c < 4 && any; c++)
        assert_float_equal(out->color[c], 0, 0);
    totals->samples++;
    totals->nothing += !any;
}

static void fill(struct demand_scene *scene, enum demand_shader shader, uint32_t size,
                 uint32_t first_page[])
{
    demand_scene_clear(scene);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
        first_page[i] = scene->page_end;
        struct demand_texture t = demand_random_texture(sizes[size][0], sizes[size][1]);
        demand_inputs(scene)[i] = demand_random_input(demand_scene_add(scene, &t), &t, true);
        if (shader == DEMAND_SHADER_FRAGMENT)
            demand_inputs(scene)[i].kind = DEMAND_CUBIC;
    }
    first_page[DEMAND_SAMPLES] = scene->page_end;
}

static void samples_ask_for_all_that_they_touch_and_no_more(void **state)
{
    struct demand_scene *scene = *state;
    static struct sets sets;
    static uint32_t first_page[DEMAND_SAMPLES + 1];
    roll_seed(1);
    struct totals totals = {0};
    for (uint32_t round = 0; round < ROUNDS; round++) {
        enum demand_shader shader =
            round < ROUNDS - 5 ? DEMAND_SHADER_COMPUTE : DEMAND_SHADER_FRAGMENT;
        fill(scene, shader, round % SIZES, first_page);
        demand_scene_run(scene, shader, DEMAND_SAMPLES);
        demand_check_sections(scene);
        for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
            sets.scene = scene;
            sets.index = i;
            sets.first = first_page[i];
            sets.entry = demand_scene_entry(scene, i);
            check_requests(&sets, &demand_inputs(scene)[i], first_page[i + 1] - first_page[i],
                           &totals);
        }
        const uint32_t *words = scene->requests.mapped;
        for (uint32_t i = 0; i < DEMAND_PAGES / 32; i++)
            assert_int_equal(words[i], 0); /* no other requests */
    }
    print_message("# %llu samples asked for %llu pages and touched %llu: %.4f; %llu for none\n",
                  (unsigned long long)totals.samples, (unsigned long long)totals.requested,
                  (unsigned long long)totals.touched,
                  (double)totals.requested / (double)totals.touched,
                  (unsigned long long)totals.nothing);
    assert_true(totals.requested < totals.touched + totals.touched / 50);
    assert_true(totals.nothing > totals.samples / 20 && totals.nothing < totals.samples / 2);
}

/* Magnitudes of 2^-40 to 2^40. One derivative is up to 1e6 times as long as the other. */
static void lod_is_that_of_long_double(void **state)
{
    struct demand_scene *scene = *state;
    roll_seed(2);
    double worst = 0;
    for (int round = 0; round < 16; round++) {
        for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
            struct DemandInput *in = &demand_inputs(scene)[i];
            double length = exp2(80 * demand_random() - 40), other = length;
            if (roll() % 4)
                other *= pow(10, 12 * demand_random() - 6);
            double angle = 6.2832 * demand_random();
            double lean = roll() % 2 ? 6.2832 * demand_random() : 1.5708 + 1e-3 * demand_random();
            *in = (struct DemandInput){
                .kind = DEMAND_FORMULA,
                .dx = {(float)(length * cos(angle)), (float)(length * sin(angle))},
                .dy = {(float)(other * cos(angle + lean)), (float)(other * sin(angle + lean))},
                .lod = roll() % 4 ? 1 + (float)(63 * demand_random()) : 1};
        }
        demand_scene_run(scene, DEMAND_SHADER_COMPUTE, DEMAND_SAMPLES);
        for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
            const struct DemandInput *in = &demand_inputs(scene)[i];
            double expected = (double)demand_oracle_lod(in->dx, in->dy, in->lod);
            worst = fmax(worst, fabs(demand_outputs(scene)[i].lod - expected));
        }
    }
    print_message("# levels are off by %.2g at most\n", worst);
    assert_true(worst < 1e-4);
}

/* Marks the texels of all tails in a page, each as large as its cut allows. */
static void fill_page(const SluiceFormatInfo *info, const uint32_t tile[2], uint32_t width,
                      uint32_t height, uint32_t levels)
{
    static uint8_t taken[512][512];
    bool blocks = info->blockWidth > 1;
    struct slc_tail_cut cut = slc_tail_cut(tile[0], tile[1], blocks, width, height, levels);
    memset(taken, 0, sizeof taken);
    for (uint32_t i = 0; i < slc_tail_slot_count(&cut) * levels; i++) {
        uint32_t slot = i / levels, k = i % levels, word = slc_tail_slot_bits(&cut, slot);
        assert_int_equal(slc_tail_slot_of(&cut, word), slot);
        assert_int_equal(word & SLUICE_DEMAND_PLACE_MASK, 0);
        assert_true(slc_is_tail_word(word));
        struct slc_demand_place at = slc_demand_tail_place(tile[0], tile[1], blocks, word, k);
        assert_true(!blocks || (at.x % 4 == 0 && at.y % 4 == 0));
        uint32_t w = slc_div_up_u32(slc_mip_size(width, k), info->blockWidth) * info->blockWidth;
        uint32_t h = slc_div_up_u32(slc_mip_size(height, k), info->blockHeight) * info->blockHeight;
        assert_true(at.x + w <= tile[0] && at.y + h <= tile[1]);
        for (uint32_t j = 0; j < w * h; j++)
            assert_int_equal(taken[at.y + j / w][at.x + j % w]++, 0);
    }
}

/* Every format's tile, and sizes up to half a tile with full and cut chains. */
static void tails_fit_side_by_side(void **state)
{
    (void)state;
    for (uint32_t format = 1; format < SLUICE_FORMAT_COUNT; format++) {
        SluiceFormatInfo info = {.structSize = sizeof info};
        uint32_t tile[2];
        CHECK_OK(sluiceGetFormatInfo((SluiceFormat)format, &info));
        CHECK_OK(sluiceGetStandardTileShape((SluiceFormat)format, &tile[0], &tile[1]));
        if (info.blockWidth > 4)
            continue; /* refused by demand loaders */
        for (uint32_t w = 0; tile[0] / 2 >> w; w++)
            for (uint32_t h = 0; tile[1] / 2 >> h; h++) {
                uint32_t width = tile[0] / 2 >> w, height = tile[1] / 2 >> h;
                uint32_t levels = slc_mip_count(slc_max_u32(width, height));
                fill_page(&info, tile, width, height, levels);
                fill_page(&info, tile, width, height, (levels + 1) / 2);
                fill_page(
                    &info, tile, slc_max_u32(1, width - 1), height,
                    levels - (width > 1 && slc_mip_count(slc_max_u32(width - 1, height)) < levels));
            }
    }
}

static void three_tails_of_64x64_fill_a_page_of_128x128(void **state)
{
    (void)state;
    const struct {
        uint32_t width, height;
        bool blocks;
        uint32_t size, slots;
    } cases[] = {{128, 128, false, 64, 3},  {128, 128, false, 32, 12}, {128, 128, false, 33, 3},
                 {128, 128, false, 16, 48}, {128, 128, false, 1, 48},  {256, 128, false, 64, 6},
                 {256, 256, true, 64, 8},   {512, 256, true, 64, 16},  {512, 256, true, 128, 4}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct slc_tail_cut cut =
            slc_tail_cut(cases[i].width, cases[i].height, cases[i].blocks, cases[i].size,
                         cases[i].size, slc_mip_count(cases[i].size));
        assert_int_equal(slc_tail_slot_count(&cut), cases[i].slots);
    }
}

/* Random cuts and slots: probe i tests one level. */
static void shaders_find_the_same_places_in_a_tail(void **state)
{
    struct demand_scene *scene = *state;
    demand_scene_clear(scene);
    const uint32_t shapes[][3] = {{8, 8, 0}, {8, 7, 0}, {7, 7, 0}, {7, 6, 0},
                                  {6, 6, 0}, {9, 8, 1}, {8, 8, 1}};
    const uint32_t count = sizeof shapes / sizeof shapes[0], levels = 9, words = 12;
    for (uint32_t i = 0; i < count; i++)
        demand_scene_entry(scene, i)->shape = shapes[i][0] |
                                              shapes[i][1] << SLUICE_DEMAND_TILE_HEIGHT_SHIFT |
                                              (shapes[i][2] ? SLUICE_DEMAND_BLOCKS : 0);
    for (uint32_t i = 0; i < count * levels * words; i++) {
        const uint32_t *shape = shapes[i % count];
        uint32_t half = 1u << (shape[0] - 1), size = half >> roll() % 6;
        size = slc_max_u32(1, size);
        struct slc_tail_cut cut =
            slc_tail_cut(1u << shape[0], 1u << shape[1], shape[2], size,
                         slc_min_u32(size, 1u << (shape[1] - 1)), slc_mip_count(size));
        uint32_t slot = roll() % slc_tail_slot_count(&cut);
        demand_inputs(scene)[i] =
            (struct DemandInput){.kind = DEMAND_PLACE,
                                 .index = i % count,
                                 .word = slc_tail_slot_bits(&cut, slot),
                                 .lod = (float)(i / count % slc_mip_count(size))};
    }
    demand_scene_run(scene, DEMAND_SHADER_COMPUTE, count * levels * words);
    for (uint32_t i = 0; i < count * levels * words; i++) {
        const uint32_t *shape = shapes[i % count];
        const struct DemandInput *in = &demand_inputs(scene)[i];
        struct slc_demand_place place = slc_demand_tail_place(
            1u << shape[0], 1u << shape[1], shape[2], in->word, (uint32_t)in->lod);
        assert_int_equal(demand_outputs(scene)[i].value[0], place.x);
        assert_int_equal(demand_outputs(scene)[i].value[1], place.y);
    }
}

static void every_level_with_tiles_is_larger_than_half_a_tile(void **state)
{
    (void)state;
    assert_int_equal(slc_demand_regular_count(1, 1, 128, 128), 0);
    assert_int_equal(slc_demand_regular_count(64, 64, 128, 128), 0);
    assert_int_equal(slc_demand_regular_count(65, 1, 128, 128), 1);
    assert_int_equal(slc_demand_regular_count(64, 65, 128, 128), 1);
    assert_int_equal(slc_demand_regular_count(128, 64, 256, 128), 0);
    assert_int_equal(slc_demand_regular_count(16384, 1, 128, 128), 8);
    assert_int_equal(slc_demand_regular_count(4095, 4095, 256, 256), 5);
    assert_int_equal(slc_demand_regular_count(1u << 20, 1u << 20, 64, 64), 15);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    static struct demand_scene scene;
    demand_scene_init(&scene, &h, VK_FORMAT_R8G8B8A8_UNORM, TILE_LOG2, TILE_LOG2);
    struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_ask_for_all_that_they_touch_and_no_more),
        cmocka_unit_test(lod_is_that_of_long_double),
        cmocka_unit_test(tails_fit_side_by_side),
        cmocka_unit_test(three_tails_of_64x64_fill_a_page_of_128x128),
        cmocka_unit_test(shaders_find_the_same_places_in_a_tail),
        cmocka_unit_test(every_level_with_tiles_is_larger_than_half_a_tile),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &scene;
    status = RUN_TESTS(tests);
    demand_scene_finish(&scene);
    return harness_finish(&h, status);
}
