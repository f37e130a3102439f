#include "demand/random.h"
#include "demand/renderer.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

/* A static view of random textures, with a budget from 4 places to all that it needs. */
struct setup {
    uint32_t kinds, chunk_size, in_flight, slowest_load, list_limit;
    bool no_eviction, no_lod_bias;
};

static uint32_t tails_of_views(struct renderer *r)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < r->texture_count; t++)
        count += r->shown[r->textures[t].tail] == SLC_SHOW_RESIDENT;
    return count;
}

static uint32_t start(struct renderer *r, uint64_t seed, const struct setup *setup)
{
    uint64_t random = seed * 77777u + 1;
    const struct slc_page_residency_create_info info = {
        .class_count = 2, .no_eviction = setup->no_eviction, .no_lod_bias = setup->no_lod_bias};
    renderer_init(r, seed, 1 + random_below(&random, RENDERER_TEXTURES), setup->kinds);
    renderer_random_views(r, 1 + random_below(&random, RENDERER_VIEWS));
    r->in_flight = setup->in_flight;
    r->slowest_load = setup->slowest_load;
    if (setup->list_limit)
        r->list_limit = setup->list_limit;
    uint32_t all = renderer_need(r, 0, false) + renderer_need(r, 0, true);
    uint32_t limit = 4 + random_below(&random, seed % 2 ? all / 8 + 1 : all);
    renderer_start(r, &info, limit, limit, setup->chunk_size ? setup->chunk_size : limit);
    return limit;
}

/* Returns the last of `count` launches that missed or loaded a page, or changed the sharpness. */
static uint32_t last_unrest(struct renderer *r, uint32_t count)
{
    uint32_t last = 0;
    for (uint32_t launch = 1; launch <= count; launch++) {
        float bias = slc_residency_lod_bias(r->residency);
        renderer_launch(r);
        assert_true(slc_residency_check(r->residency));
        if (r->missing || r->loads || slc_residency_lod_bias(r->residency) != bias)
            last = launch;
    }
    return last;
}

static struct renderer *create_renderer(void)
{
    struct renderer *r = malloc(sizeof *r);
    assert_non_null(r);
    return r;
}

static void expect_rest(const struct setup *setup, uint32_t seeds, uint32_t within)
{
    struct renderer *r = create_renderer();
    uint32_t worst = 0;
    for (uint64_t seed = 1; seed <= seeds; seed++) {
        start(r, seed, setup);
        uint32_t last = last_unrest(r, 2 * within);
        assert_in_range(last, 0, within);
        worst = last > worst ? last : worst;
        renderer_finish(r);
    }
    print_message("# complete and at rest after %u launches at most\n", worst);
    free(r);
}

static void a_static_view_is_complete_and_at_rest_within_30_launches(void **state)
{
    (void)state;
    expect_rest(&(struct setup){.kinds = 1, .in_flight = 1}, 300, 30);
    expect_rest(&(struct setup){.kinds = 1, .in_flight = 1, .slowest_load = 2}, 300, 30);
}

static void launches_in_flight_come_to_rest_later(void **state)
{
    (void)state;
    expect_rest(&(struct setup){.kinds = 1, .in_flight = 2}, 200, 30);
    expect_rest(&(struct setup){.kinds = 1, .in_flight = 3, .slowest_load = 3}, 200, 60);
}

static void short_lists_come_to_rest(void **state)
{
    (void)state;
    struct renderer *r = create_renderer();
    for (uint64_t seed = 1; seed <= 300; seed++) {
        uint32_t limit =
            start(r, seed, &(struct setup){.kinds = 1, .in_flight = 1, .list_limit = 40});
        /* enough launches to request a budget of pages a few times */
        uint32_t within = 40 + 4 * limit / 40;
        assert_in_range(last_unrest(r, 2 * within), 0, within);
        renderer_finish(r);
    }
    free(r);
}

static void kinds_that_take_places_from_each_other_come_to_rest(void **state)
{
    (void)state;
    expect_rest(&(struct setup){.kinds = 3, .in_flight = 1, .chunk_size = 4}, 200, 60);
}

static void refusing_pages_comes_to_rest(void **state)
{
    (void)state;
    expect_rest(&(struct setup){.kinds = 1, .in_flight = 1, .no_lod_bias = true}, 200, 60);
    expect_rest(&(struct setup){.kinds = 1, .in_flight = 1, .no_eviction = true}, 200, 60);
}

static float sharpest_that_fits(struct renderer *r, uint32_t room)
{
    float bias = 0;
    while (renderer_need(r, bias, false) > room)
        bias += 0.25f;
    return bias;
}

static void the_picture_is_hardly_blurrier_than_it_must_be(void **state)
{
    (void)state;
    enum { SEEDS = 300 };
    struct renderer *r = create_renderer();
    float sum = 0, worst = 0;
    uint32_t count = 0;
    for (uint64_t seed = 1; seed <= SEEDS; seed++) {
        uint32_t limit = start(r, seed, &(struct setup){.kinds = 1, .in_flight = 1});
        last_unrest(r, 40);
        uint32_t tails = tails_of_views(r);
        if (limit > tails) {
            float excess =
                slc_residency_lod_bias(r->residency) - sharpest_that_fits(r, limit - tails);
            assert_true(excess >= 0);
            worst = fmaxf(worst, excess);
            sum += excess;
            count++;
        }
        renderer_finish(r);
    }
    print_message("# levels blurrier than necessary: %.3f on average, %.2f at worst\n",
                  (double)(sum / (float)count), (double)worst);
    assert_true(sum / (float)count < 0.125f);
    free(r);
}

static void a_view_that_needs_less_becomes_sharp_again(void **state)
{
    (void)state;
    struct renderer *r = create_renderer();
    uint32_t worst = 0, count = 0;
    for (uint64_t seed = 1; seed <= 300; seed++) {
        uint32_t limit = start(r, seed, &(struct setup){.kinds = 1, .in_flight = 1});
        last_unrest(r, 30);
        uint32_t tails = tails_of_views(r), launches = 0;
        bool blurred = slc_residency_lod_bias(r->residency) > 0;
        r->view_count = 1;
        r->views[0].width = r->views[0].height = 0.05f;
        if (blurred && limit > tails + 8 && 2 * renderer_need(r, 0, false) <= limit - tails) {
            for (; slc_residency_lod_bias(r->residency) > 0 && launches <= 40; launches++)
                renderer_launch(r);
            assert_in_range(launches, 0, 40);
            assert_in_range(last_unrest(r, 40), 0, 3);
            worst = launches > worst ? launches : worst;
            count++;
        }
        renderer_finish(r);
    }
    assert_true(count > 50);
    print_message("# sharp again after %u launches at most, %u views\n", worst, count);
    free(r);
}

/* Each launch samples slightly different places and levels. */
static uint32_t tremble(struct renderer *r, uint32_t launches)
{
    struct view views[RENDERER_VIEWS];
    uint32_t changes = 0;
    for (uint32_t i = 0; i < r->view_count; i++) {
        r->views[i].width *= 0.9f;
        views[i] = r->views[i];
    }
    for (uint32_t launch = 0; launch < launches; launch++) {
        float bias = slc_residency_lod_bias(r->residency);
        for (uint32_t i = 0; i < r->view_count; i++) {
            r->views[i].x = views[i].x + 0.05f * (float)random_below(&r->random, 100) / 100;
            r->views[i].lod = views[i].lod + 0.1f * (float)random_below(&r->random, 100) / 100;
        }
        renderer_launch(r);
        changes += slc_residency_lod_bias(r->residency) != bias;
    }
    return changes;
}

static void a_view_that_trembles_does_not_make_the_bias_swing(void **state)
{
    (void)state;
    struct renderer *r = create_renderer();
    uint32_t worst = 0;
    for (uint64_t seed = 1; seed <= 100; seed++) {
        start(r, seed, &(struct setup){.kinds = 1, .in_flight = 1});
        tremble(r, 100);
        uint32_t changes = tremble(r, 300);
        worst = changes > worst ? changes : worst;
        renderer_finish(r);
    }
    print_message("# the bias changes %u times in 300 launches at most\n", worst);
    assert_in_range(worst, 0, 20);
    free(r);
}

static void what_fits_is_sharp_and_loaded_once(void **state)
{
    (void)state;
    struct renderer *r = create_renderer();
    for (uint64_t seed = 1; seed <= 100; seed++) {
        const struct slc_page_residency_create_info info = {.class_count = 2};
        renderer_init(r, seed, 1 + (uint32_t)seed % RENDERER_TEXTURES, 2);
        renderer_random_views(r, 1 + (uint32_t)seed % RENDERER_VIEWS);
        uint32_t need = renderer_need(r, 0, false) + renderer_need(r, 0, true), loads = 0;
        bool opened[RENDERER_TEXTURES] = {false};
        for (uint32_t i = 0; i < r->view_count; i++)
            need += !opened[r->views[i].texture], opened[r->views[i].texture] = true;
        renderer_start(r, &info, need, need, 1);
        for (uint32_t launch = 0; launch < 4; launch++) {
            renderer_launch(r);
            loads += r->loads;
            assert_true(slc_residency_lod_bias(r->residency) == 0);
        }
        assert_int_equal(r->missing, 0);
        assert_int_equal(loads, need);
        renderer_finish(r);
    }
    free(r);
}

static void tails_beyond_the_budget_are_refused(void **state)
{
    (void)state;
    struct renderer *r = create_renderer();
    const struct slc_page_residency_create_info info = {.class_count = 2};
    renderer_init(r, 5, RENDERER_TEXTURES, 1);
    r->view_count = RENDERER_TEXTURES;
    for (uint32_t i = 0; i < r->view_count; i++)
        r->views[i] = (struct view){i, 0, 0, 1, 1, 3.5f};
    renderer_start(r, &info, RENDERER_TEXTURES / 2, RENDERER_TEXTURES / 2, 1);
    assert_in_range(last_unrest(r, 60), 0, 30);
    assert_int_equal(tails_of_views(r), RENDERER_TEXTURES / 2);
    /* one texture goes: its place is for one that was refused */
    for (uint32_t t = 0; t < r->texture_count; t++)
        if (r->shown[r->textures[t].tail] == SLC_SHOW_RESIDENT) {
            slc_residency_forget(r->residency, r->textures[t].tail, 1);
            r->views[t].texture = (t + 1) % r->texture_count;
        }
    assert_in_range(last_unrest(r, 120), 0, 60);
    assert_true(tails_of_views(r) > 0);
    renderer_finish(r);
    free(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_static_view_is_complete_and_at_rest_within_30_launches),
        cmocka_unit_test(launches_in_flight_come_to_rest_later),
        cmocka_unit_test(short_lists_come_to_rest),
        cmocka_unit_test(kinds_that_take_places_from_each_other_come_to_rest),
        cmocka_unit_test(refusing_pages_comes_to_rest),
        cmocka_unit_test(the_picture_is_hardly_blurrier_than_it_must_be),
        cmocka_unit_test(a_view_that_needs_less_becomes_sharp_again),
        cmocka_unit_test(a_view_that_trembles_does_not_make_the_bias_swing),
        cmocka_unit_test(what_fits_is_sharp_and_loaded_once),
        cmocka_unit_test(tails_beyond_the_budget_are_refused),
    };
    return RUN_TESTS(tests);
}
