/*
 * Residency in samples: shown levels, requests and used bits if some pages are resident, some are
 * missing, and some are refused. Memory that must not be read holds NaN.
 */
#include "device/demand_expect.h"
#include "device/demand_images.h"
#include "device/demand_samples.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define TOLERANCE (2.0 / 255.0)

static struct demand_expectation expectation;
static uint32_t derivatives_checked;
static uint8_t expected_pages[DEMAND_EXPECT_PAGES];

static void set_word(struct harness_buffer *levels, uint32_t word, uint32_t value)
{
    ((uint32_t *)levels->mapped)[word] = value;
}

static void set_loader_bias(struct demand_scene *scene, float bias)
{
    uint32_t word;
    memcpy(&word, &bias, sizeof word);
    set_word(&scene->levels, SLUICE_DEMAND_PARAMETER_LOD_BIAS, word);
    expectation.loader_bias = (double)bias;
}

struct chance {
    struct demand_scene *scene;
    double resident, refused;
    bool filters; ///< true: some textures have bicubic filters
};

static bool by_chance(void *user, uint32_t page)
{
    const struct chance *c = user;
    double x = demand_random();
    if (x < c->refused)
        demand_scene_set_page(c->scene, page, SLUICE_DEMAND_PAGE_REFUSED, 0);
    return x >= c->refused && x < c->refused + c->resident;
}

static const uint32_t sizes[][2] = {{1300, 1000}, {257, 129}, {64, 64}, {65, 64}, {1, 1}, {3, 300}};
#define SIZES (sizeof sizes / sizeof sizes[0])

static void fill(struct demand_scene *scene, struct demand_texture textures[SIZES],
                 struct chance chance)
{
    demand_scene_clear(scene);
    set_loader_bias(scene, 0);
    chance.scene = scene;
    for (uint32_t t = 0; t < SIZES; t++) {
        textures[t] = demand_random_texture(sizes[t][0], sizes[t][1]);
        if (chance.filters)
            demand_randomize_filter(&textures[t]);
        demand_images_load(scene, demand_scene_add(scene, &textures[t]), by_chance, &chance);
    }
    demand_images_upload(scene);
    memset(expected_pages, 0, sizeof expected_pages);
}

static void expect(const struct DemandInput *in, uint8_t *pages)
{
    expectation.entry = demand_scene_entry(expectation.scene, in->index);
    expectation.index = in->index;
    demand_expect(&expectation, in, pages);
}

/* Makes an input whose result is certain. */
static struct DemandInput sure_input(const struct demand_texture textures[SIZES], bool slopes)
{
    for (;;) {
        uint32_t t = (uint32_t)roll() % SIZES;
        struct DemandInput in = demand_random_input(t, &textures[t], false);
        if (slopes && in.kind == DEMAND_GRAD && roll() % 2)
            in.kind = DEMAND_SLOPES;
        expect(&in, NULL);
        if (expectation.sure)
            return in;
    }
}

static void check_derivative(const struct DemandInput *in, const char *name, const float found[4],
                             const double expected[4], uint32_t size)
{
    uint32_t level = expectation.finest < 31 ? expectation.finest : 31;
    double texels = slc_max_u32(size >> level, 1); /* from texel to texel, times them */
    for (int c = 0; c < 4; c++)
        if (!(fabs(found[c] - expected[c]) < 0.03 * texels))
            fail_msg("texture %u, uv %.9g %.9g: channel %d of d%s is %g, not %g", in->index,
                     (double)in->uv[0], (double)in->uv[1], c, name, (double)found[c], expected[c]);
}

static void check_sample(struct demand_scene *scene, uint32_t i)
{
    const struct DemandInput *in = &demand_inputs(scene)[i];
    const struct DemandOutput *out = &demand_outputs(scene)[i];
    expect(in, expected_pages);
    assert_int_equal(out->resident, expectation.resident);
    for (int c = 0; c < 4; c++)
        if (!(fabs(out->color[c] - expectation.color[c]) < TOLERANCE))
            fail_msg("texture %u, kind %u, uv %.9g %.9g: channel %d is %g, not %g", in->index,
                     in->kind, (double)in->uv[0], (double)in->uv[1], c, (double)out->color[c],
                     expectation.color[c]);
    if (in->kind != DEMAND_SLOPES || expectation.jumps)
        return;
    check_derivative(in, "u", out->du, expectation.du, expectation.entry->width);
    check_derivative(in, "v", out->dv, expectation.dv, expectation.entry->height);
    derivatives_checked++;
}

static void check_pages(struct demand_scene *scene, bool tracks)
{
    uint32_t asked = 0, used = 0;
    for (uint32_t page = 0; page < scene->page_end; page++) {
        assert_int_equal(demand_requested(scene, page), (expected_pages[page] & DEMAND_ASKED) != 0);
        bool marked = expected_pages[page] & DEMAND_MARKED && demand_has_block(scene, page);
        assert_int_equal(demand_used(scene, page),
                         tracks && (marked || (expected_pages[page] & DEMAND_USED) != 0));
        asked += demand_requested(scene, page);
        used += demand_used(scene, page);
    }
    demand_check_sections(scene);
    print_message("# %u pages asked for, %u used\n", asked, used);
}

/* Returns the number of resident samples. */
static uint32_t try_residency(struct demand_scene *scene, enum demand_shader shader,
                              struct chance chance)
{
    struct demand_texture textures[SIZES];
    expectation.scene = scene;
    expectation.preview = shader == DEMAND_SHADER_PREVIEW || shader == DEMAND_SHADER_CUBIC_PREVIEW;
    chance.filters = shader == DEMAND_SHADER_CUBIC || shader == DEMAND_SHADER_CUBIC_PREVIEW;
    fill(scene, textures, chance);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++)
        demand_inputs(scene)[i] = sure_input(textures, chance.filters);
    demand_scene_run(scene, shader, DEMAND_SAMPLES);
    uint32_t resident = 0;
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
        check_sample(scene, i);
        resident += demand_outputs(scene)[i].resident;
    }
    check_pages(scene, true);
    return resident;
}

static void samples_show_and_use_what_is_there_and_ask_for_the_rest(void **state)
{
    roll_seed(21);
    for (int round = 0; round < 4; round++) {
        uint32_t resident = try_residency(*state, DEMAND_SHADER_COMPUTE,
                                          (struct chance){.resident = 0.3 + 0.2 * round});
        assert_in_range(resident, DEMAND_SAMPLES / 4, DEMAND_SAMPLES - 10);
    }
}

static void previews_show_the_finest_coarser_level_that_is_there(void **state)
{
    roll_seed(22);
    for (int round = 0; round < 4; round++) {
        uint32_t resident =
            try_residency(*state, DEMAND_SHADER_PREVIEW,
                          (struct chance){.resident = 0.2 + 0.2 * round, .refused = 0.05 * round});
        assert_in_range(resident, DEMAND_SAMPLES / 4, DEMAND_SAMPLES - 1);
    }
}

static void coarser_levels_stand_in_for_what_is_refused_and_count_as_resident(void **state)
{
    roll_seed(23);
    assert_int_equal(try_residency(*state, DEMAND_SHADER_COMPUTE,
                                   (struct chance){.resident = 0.5, .refused = 0.5}),
                     DEMAND_SAMPLES);
    try_residency(*state, DEMAND_SHADER_COMPUTE, (struct chance){.resident = 0.4, .refused = 0.3});
    /* not even tails: the base color remains */
    assert_int_equal(try_residency(*state, DEMAND_SHADER_COMPUTE, (struct chance){.refused = 1}),
                     DEMAND_SAMPLES);
}

static void bicubic_samples_ask_for_all_their_texels(void **state)
{
    roll_seed(31);
    derivatives_checked = 0;
    for (int round = 0; round < 4; round++) {
        uint32_t resident = try_residency(*state, DEMAND_SHADER_CUBIC,
                                          (struct chance){.resident = 0.4 + 0.2 * round});
        assert_in_range(resident, DEMAND_SAMPLES / 4, DEMAND_SAMPLES);
    }
    assert_true(derivatives_checked > DEMAND_SAMPLES);
}

static void coarser_levels_stand_in_for_all_of_a_bicubic_sample(void **state)
{
    roll_seed(32);
    assert_int_equal(try_residency(*state, DEMAND_SHADER_CUBIC,
                                   (struct chance){.resident = 0.5, .refused = 0.5}),
                     DEMAND_SAMPLES);
    try_residency(*state, DEMAND_SHADER_CUBIC, (struct chance){.resident = 0.4, .refused = 0.3});
    for (int round = 0; round < 4; round++)
        try_residency(*state, DEMAND_SHADER_CUBIC_PREVIEW,
                      (struct chance){.resident = 0.2 + 0.2 * round, .refused = 0.05 * round});
}

static void bias_of_the_loader_adds_to_that_of_the_texture(void **state)
{
    struct demand_scene *scene = *state;
    struct demand_texture textures[SIZES];
    roll_seed(24);
    expectation.scene = scene;
    expectation.preview = false;
    fill(scene, textures, (struct chance){.resident = 1, .filters = true});
    set_loader_bias(scene, 1.75f);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++)
        demand_inputs(scene)[i] = sure_input(textures, true);
    demand_scene_run(scene, DEMAND_SHADER_CUBIC, DEMAND_SAMPLES);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++)
        check_sample(scene, i);
    check_pages(scene, true);
}

static void nothing_is_marked_as_used_while_that_is_not_wanted(void **state)
{
    struct demand_scene *scene = *state;
    struct demand_texture textures[SIZES];
    roll_seed(25);
    fill(scene, textures, (struct chance){.resident = 0.5});
    set_word(&scene->levels, SLUICE_DEMAND_PARAMETER_TRACKING, 0);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++)
        demand_inputs(scene)[i] = sure_input(textures, false);
    demand_scene_run(scene, DEMAND_SHADER_COMPUTE, DEMAND_SAMPLES);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++)
        check_sample(scene, i);
    check_pages(scene, false);
}

static void unknown_textures_ask_to_be_opened_and_failed_ones_have_one_color(void **state)
{
    struct demand_scene *scene = *state;
    struct demand_texture t = {.width = 700, .height = 500, .base_color = {1, 0, 0.5f, 1}};
    roll_seed(26);
    demand_scene_clear(scene);
    for (uint32_t i = 0; i < 64; i++) {
        demand_scene_entry(scene, demand_scene_add(scene, &t))->state =
            i % 2 ? SLUICE_DEMAND_TEXTURE_UNKNOWN : SLUICE_DEMAND_TEXTURE_FAILED;
        for (uint32_t j = 0; j < 32; j++)
            demand_inputs(scene)[i * 32 + j] = demand_random_input(i, &t, true);
    }
    for (uint32_t shader = 0; shader < 2; shader++) {
        demand_scene_run(scene, shader ? DEMAND_SHADER_PREVIEW : DEMAND_SHADER_COMPUTE, 64 * 32);
        for (uint32_t i = 0; i < 64 * 32; i++) {
            const struct DemandOutput *out = &demand_outputs(scene)[i];
            bool failed = i / 32 % 2 == 0;
            assert_int_equal(out->resident, failed);
            for (int c = 0; c < 4; c++)
                assert_float_equal(out->color[c], failed ? t.base_color[c] : 0, 0);
        }
        for (uint32_t page = 0; page < scene->page_end; page++)
            assert_int_equal(demand_requested(scene, page), page < 64 && page % 2 == 1);
        demand_check_sections(scene);
    }
}

static void textures_inside_a_pixel_are_one_color_without_any_page(void **state)
{
    struct demand_scene *scene = *state;
    roll_seed(27);
    demand_scene_clear(scene);
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
        struct demand_texture t = demand_random_texture(4095, 4095);
        t.bias = 0;
        t.mode_u %= 3; /* without borders */
        t.mode_v %= 3;
        struct DemandInput in = demand_random_input(demand_scene_add(scene, &t), &t, false);
        in.lod = (float)(11 + 20 * demand_random());
        float turn = (float)(6.28 * demand_random()), length = exp2f(in.lod) * 64 / 4095;
        in.dx[0] = length * cosf(turn), in.dx[1] = length * sinf(turn);
        in.dy[0] = -length * sinf(turn) * 1.01f, in.dy[1] = length * cosf(turn) * 1.01f;
        demand_inputs(scene)[i] = in;
    }
    demand_scene_run(scene, DEMAND_SHADER_COMPUTE, DEMAND_SAMPLES);
    const float base[4] = {0.25f, 0.5f, 0.75f, 1};
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++) {
        assert_int_equal(demand_outputs(scene)[i].resident, 1);
        assert_memory_equal(demand_outputs(scene)[i].color, base, sizeof base);
    }
    for (uint32_t page = 0; page < scene->page_end; page++)
        assert_false(demand_requested(scene, page));
}

static void pages_of_resources_hold_64_bits(void **state)
{
    struct demand_scene *scene = *state;
    const uint32_t first = 3 * SLUICE_DEMAND_SECTION_PAGES, count = 1024;
    demand_scene_clear(scene);
    for (uint32_t i = 0; i < count; i++) {
        if (i % 3)
            demand_scene_set_page(scene, first + i, i % 7 ? i : UINT32_MAX - i % 2, ~i);
        demand_inputs(scene)[i] = (struct DemandInput){.kind = DEMAND_MAP, .index = first + i};
    }
    demand_scene_run(scene, DEMAND_SHADER_COMPUTE, count);
    for (uint32_t i = 0; i < count; i++) {
        const struct DemandOutput *out = &demand_outputs(scene)[i];
        bool there = i % 3;
        assert_int_equal(out->resident, there);
        assert_int_equal(out->value[0], there ? i % 7 ? i : UINT32_MAX - i % 2 : 0);
        assert_int_equal(out->value[1], there ? ~i : 0);
        assert_int_equal(demand_requested(scene, first + i), !there);
        assert_int_equal(demand_used(scene, first + i), there);
    }
    demand_check_sections(scene);
}

/* Also if bits are already set, by this launch or left by the last one. */
static void a_page_that_all_miss_is_asked_for_once(void **state)
{
    struct demand_scene *scene = *state;
    const uint32_t page = 5 * SLUICE_DEMAND_SECTION_PAGES + 77;
    demand_scene_clear(scene);
    ((uint32_t *)scene->requests.mapped)[page / 32] = 1;
    ((uint32_t *)scene->sections.mapped)[0] = 1 << 5;
    for (uint32_t i = 0; i < DEMAND_SAMPLES; i++)
        demand_inputs(scene)[i] = (struct DemandInput){.kind = DEMAND_MAP, .index = page};
    for (int launch = 0; launch < 2; launch++) {
        demand_scene_run(scene, DEMAND_SHADER_COMPUTE, DEMAND_SAMPLES);
        for (uint32_t i = 0; i < DEMAND_PAGES / 32; i++)
            assert_int_equal(((const uint32_t *)scene->requests.mapped)[i],
                             i == page / 32 ? 1 | 1u << page % 32 : 0);
        demand_check_sections(scene);
    }
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    static struct demand_scene scene;
    demand_scene_init(&scene, &h, VK_FORMAT_R32_SFLOAT, 7, 7);
    struct CMUnitTest tests[] = {
        cmocka_unit_test(samples_show_and_use_what_is_there_and_ask_for_the_rest),
        cmocka_unit_test(previews_show_the_finest_coarser_level_that_is_there),
        cmocka_unit_test(coarser_levels_stand_in_for_what_is_refused_and_count_as_resident),
        cmocka_unit_test(bicubic_samples_ask_for_all_their_texels),
        cmocka_unit_test(coarser_levels_stand_in_for_all_of_a_bicubic_sample),
        cmocka_unit_test(bias_of_the_loader_adds_to_that_of_the_texture),
        cmocka_unit_test(nothing_is_marked_as_used_while_that_is_not_wanted),
        cmocka_unit_test(unknown_textures_ask_to_be_opened_and_failed_ones_have_one_color),
        cmocka_unit_test(textures_inside_a_pixel_are_one_color_without_any_page),
        cmocka_unit_test(pages_of_resources_hold_64_bits),
        cmocka_unit_test(a_page_that_all_miss_is_asked_for_once),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &scene;
    status = RUN_TESTS(tests);
    demand_scene_finish(&scene);
    return harness_finish(&h, status);
}
