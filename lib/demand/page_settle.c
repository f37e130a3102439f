#include "demand/page_settle.h"

#include "demand/page_changes.h"
#include "demand/page_eviction.h"
#include "demand/page_lru.h"

#include <assert.h>

#define LIFT_SHARE 8u /* 1 / share of places that must be idle before refusals are lifted */

void slc_residency_begin(struct slc_demand_residency *residency, uint64_t launch)
{
    struct slc_demand_residency *r = residency;
    assert(launch > r->launch);
    r->used = true;
    r->launch = launch;
    r->use = (struct slc_launch_use){.full_at = UINT64_MAX};
    if (!r->bias_shown && r->prepared < launch) {
        r->bias_shown = true;
        r->bias_from = launch;
    }
    while (r->unseen.head != SLC_NO_NODE) {
        uint32_t index = r->unseen.head;
        struct slc_page_node *node = slc_node(r, index);
        if (node->visible_from > launch)
            break;
        slc_residency_leave_home(r, index);
        slc_residency_enter_lru(r, index, launch - 1);
    }
    SLC_TELL_PAGES(r, .kind = SLC_PAGE_CALL_BEGIN, .launch = launch);
}

float slc_residency_prepare(struct slc_demand_residency *residency, uint64_t launch)
{
    assert(launch > residency->launch && launch >= residency->prepared);
    residency->used = true;
    residency->prepared = launch;
    if (!residency->bias_shown) {
        residency->bias_shown = true;
        residency->bias_from = launch;
    }
    float bias = slc_residency_lod_bias(residency);
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_PREPARE, .launch = launch, .bias = bias);
    return bias;
}

void slc_residency_abandon(struct slc_demand_residency *residency, uint64_t launch)
{
    assert(launch > residency->launch);
    if (residency->prepared >= launch)
        residency->prepared = launch - 1;
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_ABANDON, .launch = launch);
}

float slc_residency_lod_bias(const struct slc_demand_residency *residency)
{
    return (float)residency->bias.quarters * 0.25f;
}

bool slc_residency_is_hopeless(const struct slc_demand_residency *r, uint32_t class_index)
{
    if (class_index != SLC_TILES)
        return false;
    return r->no_eviction || r->no_lod_bias || r->bias.quarters == SLC_MAX_BIAS_QUARTERS ||
           r->classes[SLC_TILES].pinned >= r->classes[SLC_TILES].limit;
}

static uint64_t less(uint64_t a, uint64_t b)
{
    return a > b ? a - b : 0;
}

static void decide_bias(struct slc_demand_residency *r, uint64_t missing)
{
    const struct slc_page_class *tiles = &r->classes[SLC_TILES];
    uint64_t fixed = tiles->pinned + r->use.pinned_waiting;
    uint32_t before = r->bias.quarters;
    struct slc_demand_need need = {
        .room = less(tiles->limit, fixed),
        .used = r->use.used,
        .missing =
            r->use.asked + less(missing, r->use.requests), /* unlisted pages count as tiles */
        .used_pinned = r->use.used_pinned,
        .loads = r->use.loads,
        .failed_loads = r->failed_loads,
    };
    r->failed_loads = 0;
    if (r->no_eviction || r->no_lod_bias || !r->bias_shown || r->launch < r->bias_from)
        return;
    need.fails = need.used + need.missing + fixed > r->use.full_at;
    if (tiles->pinned >= tiles->limit)
        return; /* pinned pages alone fill memory: a coarser bias would not help */
    slc_demand_bias_update(&r->bias, &need);
    r->bias_shown = r->bias.quarters == before;
}

/* Lifts refusals for lack of memory, oldest first, if more places are idle than when pages were
 * refused: half as many pages as places that the launch left idle. */
static void lift_refusals(struct slc_demand_residency *r)
{
    struct slc_page_class *tiles = &r->classes[SLC_TILES];
    uint64_t needed = tiles->pinned + r->use.touched + tiles->counts.loading;
    uint64_t idle = less(tiles->limit, r->no_eviction ? tiles->held : needed);
    if (r->use.refused)
        r->refused_idle = idle; /* so many idle places do not suffice */
    if (idle <= r->refused_idle || idle * LIFT_SHARE < tiles->limit)
        return;
    for (idle = (idle + 1) / 2; idle > 0 && r->overflow.head != SLC_NO_NODE; idle--) {
        uint32_t index = r->overflow.head;
        slc_residency_leave_home(r, index);
        slc_node(r, index)->state = SLC_PAGE_ABSENT;
        tiles->counts.refused--;
        slc_residency_note(r, index);
    }
}

static void trim_classes(struct slc_demand_residency *residency)
{
    residency->over_limit = false;
    for (uint32_t i = 0; i < residency->class_count; i++) {
        slc_residency_trim(residency, i);
        residency->over_limit |= residency->classes[i].held > residency->classes[i].limit;
    }
}

void slc_residency_settle(struct slc_demand_residency *residency, uint64_t missing)
{
    decide_bias(residency, missing);
    lift_refusals(residency);
    if (residency->over_limit)
        trim_classes(residency);
    SLC_TELL_PAGES(residency, .kind = SLC_PAGE_CALL_SETTLE, .value = missing);
}
