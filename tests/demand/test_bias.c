/** The LOD bias of demand loading alone: it settles for still views. */
#include "demand/lod_bias.h"

#include "demand/random.h"
#include "support/test.h"

#include <string.h>

enum { QUARTERS = SLC_MAX_BIAS_QUARTERS + 1, LAUNCHES = 3000, REST = 1000, MAX_CHANGES = 100 };

/* Pages that a view needs at each bias: any numbers that do not grow. */
struct view {
    uint64_t need[QUARTERS];
    uint64_t pinned;
    uint64_t room;   ///< places that the controller is told of
    uint64_t places; ///< places in memory
    uint64_t resident;
    uint32_t delay; ///< launches until a missing page is resident
    uint64_t pending[4];
    uint64_t broken;     ///< pages that never load and are requested repeatedly
    uint32_t broken_for; ///< launches since their last request
};

/* Makes a view. A bias step divides the need by 1 to 16, or by 1 for some steps, as with coarse
 * levels, few regions or one texture. */
static void make_view(struct view *v, uint64_t *state)
{
    memset(v, 0, sizeof *v);
    uint64_t need = 1 + random_below(state, 1u << (4 + random_below(state, 14)));
    uint32_t steps = 1 + random_below(state, 12);
    for (uint32_t q = 0; q < QUARTERS; q++) {
        if (random_below(state, steps) == 0)
            need = need * 16 / (16 + random_below(state, 1u << random_below(state, 9)));
        v->need[q] = need;
    }
    v->room = 1 + (uint64_t)random_below(state, 1000) * (v->need[0] + 10) / 900;
    v->places = random_below(state, 3) ? v->room : v->room - random_below(state, (uint32_t)v->room);
    v->pinned = random_below(state, 20);
    v->delay = random_below(state, 4);
    v->broken = random_below(state, 2) ? random_below(state, 1 + (uint32_t)v->need[0] / 8) : 0;
}

static struct slc_demand_need launch(struct view *v, uint32_t quarters)
{
    uint64_t arrived = v->pending[0];
    memmove(v->pending, v->pending + 1, sizeof v->pending - sizeof *v->pending);
    v->pending[3] = 0;
    v->resident = v->resident + arrived < v->places ? v->resident + arrived : v->places;
    uint64_t need = v->need[quarters];
    uint64_t broken = v->need[0] ? v->broken * need / v->need[0] : 0, whole = need - broken,
             failed = 0;
    uint64_t used = whole < v->resident ? whole : v->resident, under_way = 0;
    if (v->broken_for++ == v->delay) {
        v->broken_for = 0;
        failed = broken;
    }
    for (uint32_t i = 0; i < 4; i++)
        under_way += v->pending[i];
    uint64_t loads = whole - used > under_way ? whole - used - under_way : 0;
    v->pending[v->delay] += loads;
    loads += v->broken_for == 0 ? broken : 0;
    return (struct slc_demand_need){.room = v->room,
                                    .used = used,
                                    .missing = need - used,
                                    .used_pinned = v->pinned,
                                    .loads = loads,
                                    .failed_loads = failed,
                                    .fails = need > v->places};
}

static void views_that_stand_still_come_to_rest(void **state)
{
    (void)state;
    uint64_t seed = 1;
    uint32_t biased = 0, worst = 0;
    for (uint32_t run = 0; run < 3000; run++) {
        struct view v;
        struct slc_demand_bias bias;
        uint32_t changes = 0, last = 0;
        memset(&bias, 0, sizeof bias);
        make_view(&v, &seed);
        for (uint32_t i = 0; i < LAUNCHES; i++) {
            uint32_t before = bias.quarters;
            struct slc_demand_need need = launch(&v, bias.quarters);
            slc_demand_bias_update(&bias, &need);
            changes += bias.quarters != before;
            last = bias.quarters != before ? i : last;
        }
        if (last + REST > LAUNCHES || changes > MAX_CHANGES)
            fail_msg("run %u: %u changes, the last in launch %u; %u quarters", (unsigned)run,
                     (unsigned)changes, (unsigned)last, (unsigned)bias.quarters);
        biased += changes > 0;
        worst = changes > worst ? changes : worst;
    }
    print_message("# %u of 3000 views needed a bias, of %u changes at most\n", (unsigned)biased,
                  (unsigned)worst);
    assert_true(biased > 500);
}

/* A float has 24 bits. */
static void one_page_too_many_of_many_is_seen(void **state)
{
    (void)state;
    struct slc_demand_bias bias = {0};
    struct slc_demand_need need = {.room = 1u << 24, .used = 1u << 24};
    slc_demand_bias_update(&bias, &need);
    assert_int_equal(bias.quarters, 0);
    need.missing = 1;
    slc_demand_bias_update(&bias, &need);
    assert_int_not_equal(bias.quarters, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_page_too_many_of_many_is_seen),
        cmocka_unit_test(views_that_stand_still_come_to_rest),
    };
    return RUN_TESTS(tests);
}
