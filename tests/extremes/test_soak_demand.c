/* Ten million launches of a ray tracer whose views move. The memory of the residency stays
 * constant. */
#include "demand/random.h"
#include "demand/renderer.h"
#include "extremes/note.h"
#include "support/failing_allocator.h"

#include <math.h>
#include <stdlib.h>

enum { TEXTURES = 16, PLACES = 600, VIEWS = 6 };

static uint64_t launch_count = 10000;

/* Maximum growth of the memory after the first tenth of a run. */
static const double GROWTH = 1.02;

/* Moves each view over its texture, nearer and farther. Sometimes it changes to another texture. */
static void move_views(struct renderer *r, uint64_t launch)
{
    r->view_count = VIEWS;
    for (uint32_t i = 0; i < VIEWS; i++) {
        double t = (double)launch / (40 + 7 * i);
        struct view *v = &r->views[i];
        v->texture = (uint32_t)(launch / (300 + 37 * i) + i * 5) % r->texture_count;
        v->width = v->height = (float)(0.3 + 0.2 * sin(t / 3.1));
        v->x = (float)((1 - v->width) * (0.5 + 0.5 * sin(t)));
        v->y = (float)((1 - v->height) * (0.5 + 0.5 * cos(t * 1.37)));
        v->lod = (float)(1.2 + 1.2 * sin(t / 5.3));
    }
}

/* Forgets all pages of a texture, also those that are being read. */
static void forget_texture(struct renderer *r)
{
    const struct pyramid *t = &r->textures[random_below(&r->random, r->texture_count)];
    slc_residency_forget(r->residency, t->first[0], t->tail - t->first[0] + 1);
}

static void open_renderer(struct renderer *r, struct failing_allocator *memory)
{
    const struct slc_page_residency_create_info info = {.cb = &memory->callbacks, .class_count = 2};
    failing_allocator_init(memory, UINT64_MAX);
    renderer_init(r, 7, TEXTURES, 3);
    r->slowest_load = 3;
    r->in_flight = 2;
    r->list_limit = 64;
    renderer_start(r, &info, PLACES, PLACES - 40, 32);
}

static void launches_without_end_take_no_more_memory_than_the_first_ones(void **state)
{
    (void)state;
    static struct renderer r;
    struct failing_allocator memory;
    uint64_t early = 0, late = 0, resident = 0, loads = 0;
    open_renderer(&r, &memory);
    for (uint64_t i = 0; i < launch_count; i++) {
        move_views(&r, i);
        renderer_launch(&r);
        loads += r.loads;
        if (i % 1009 == 1008)
            forget_texture(&r);
        uint64_t *peak = i < launch_count / 10 ? &early : &late;
        *peak = memory.live_bytes > *peak ? memory.live_bytes : *peak;
        if (i == launch_count / 10)
            resident = resident_size();
        if (i % (launch_count / 100) == 0)
            assert_true(slc_residency_check(r.residency));
    }
    struct slc_residency_counts counts;
    slc_residency_get_counts(r.residency, 0, &counts);
    assert_true(loads > launch_count && counts.evicted > launch_count / 10);
    assert_true(counts.restored > 0 && counts.resident + counts.loading <= PLACES);
    uint64_t grown = resident_size();
    note("demand soak: bytes of the residency, against the first tenth", launch_count, (double)late,
         GROWTH * (double)early);
    note("demand soak: bytes of the process, against the first tenth", launch_count, (double)grown,
         (double)resident + (1 << 20));
    assert_true((double)late <= GROWTH * (double)early);
    assert_true(grown <= resident + (1 << 20));
    renderer_finish(&r);
    assert_int_equal(memory.live_count, 0);
}

/* Numbers of launches near the end of 64 bits are numbers as others are. */
static void the_last_launches_of_all_evict_what_the_first_ones_do(void **state)
{
    (void)state;
    static const uint64_t starts[] = {0, UINT64_C(1) << 32, UINT64_C(1) << 63, UINT64_MAX - 2000};
    uint64_t first = 0, wrong = 0;
    for (uint32_t s = 0; s < 4; s++) {
        static struct renderer r;
        struct failing_allocator memory;
        struct slc_residency_counts counts;
        uint64_t h = 1;
        open_renderer(&r, &memory);
        r.in_flight = 1;
        r.launch = starts[s];
        for (uint64_t i = 0; i < 1500; i++) {
            move_views(&r, i);
            renderer_launch(&r);
            slc_residency_get_counts(r.residency, 0, &counts);
            h = (h ^ (counts.resident + counts.evicted * 1000 + r.loads * 77)) *
                0x9E3779B97F4A7C15u;
        }
        assert_true(slc_residency_check(r.residency) && counts.evicted > 100);
        first = s == 0 ? h : first;
        wrong += h != first;
        renderer_finish(&r);
    }
    note("numbers of launches: starts that decide otherwise", 4, (double)wrong, 0);
    assert_int_equal(wrong, 0);
}

int main(int argc, char **argv)
{
    if (is_long(argc, argv))
        launch_count = 10000000;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(launches_without_end_take_no_more_memory_than_the_first_ones),
        cmocka_unit_test(the_last_launches_of_all_evict_what_the_first_ones_do),
    };
    return RUN_TESTS(tests);
}
