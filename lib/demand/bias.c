#include "demand/bias.h"

#include "base/checked.h"

#include <string.h>

#define QUARTER 1.41421356f /* a level is a factor of 4 in texels */
#define ANOTHER_VIEW 0.75f
#define CALM_LAUNCHES 2u
#define MAX_FAILED_TRIALS 6u
#define TRIAL_PERIODS 8u

/* What was seen tells nothing any more: other places, other pages. */
static void forget(struct slc_demand_bias *bias)
{
    memset(bias->seen, 0, sizeof bias->seen);
    bias->loads = 0;
}

/* The view may be another by now: what was seen of other biases changes as the present one's did.
 */
static void learn(struct slc_demand_bias *bias, float need, float total)
{
    uint32_t now = bias->quarters;
    if (bias->seen[now].known) {
        float old = bias->seen[now].need, old_total = bias->seen[now].total, scale = 1;
        if (old > 0 && need > 0)
            scale = need / old;
        else if (old_total > 0)
            scale = total / old_total;
        for (uint32_t i = 0; i <= SLC_MAX_BIAS_QUARTERS; i++) {
            bias->seen[i].need *= scale;
            bias->seen[i].total *= scale;
            bias->seen[i].scale *= scale;
            bias->seen[i].old |= bias->seen[i].scale < ANOTHER_VIEW;
        }
    }
    bias->seen[now].known = true;
    bias->seen[now].scale = 1;
    bias->seen[now].old = bias->seen[now].fails = false;
    bias->seen[now].need = need;
    bias->seen[now].total = total;
}

static void change(struct slc_demand_bias *bias, uint32_t quarters)
{
    bias->quarters = quarters;
    bias->calm = 0;
    bias->settled = false;
    bias->loads = 0;
}

/* To where it should fit; further each time that it did not. */
static void raise(struct slc_demand_bias *bias, float need, float room)
{
    uint32_t to = bias->quarters, least = to + ++bias->raises;
    do {
        to = slc_min_u32(to + 1, SLC_MAX_BIAS_QUARTERS);
        need = bias->seen[to].known ? bias->seen[to].need : need / QUARTER;
    } while (to < SLC_MAX_BIAS_QUARTERS && (need > room || bias->seen[to].fails) && need >= 1);
    if (!bias->seen[to].known)
        to = slc_min_u32(slc_max_u32(to, least), SLC_MAX_BIAS_QUARTERS);
    if (bias->on_trial && bias->failed_trials < MAX_FAILED_TRIALS)
        bias->failed_trials++;
    bias->on_trial = false;
    if (to > bias->quarters)
        change(bias, to);
}

/* Whether the next finer bias may fit, if this one needs *need; that of the finer one then. What
 * was seen of a view that needed far more is no reason not to try. */
static bool may_fit(const struct slc_demand_bias *bias, uint32_t finer, float room, float *need)
{
    float guess = *need * QUARTER;
    const bool known = bias->seen[finer].known, old = bias->seen[finer].old;
    if (known && !old && bias->seen[finer].fails)
        return false;
    if (known && (!old || bias->seen[finer].need < guess))
        guess = bias->seen[finer].need;
    if (guess > room)
        return false;
    *need = guess > *need ? guess : *need;
    return true;
}

/* Half of the way to the finest bias that should fit, because estimates are rough. */
static void lower(struct slc_demand_bias *bias, float need, float room)
{
    uint32_t to = bias->quarters;
    need = need < 1 ? 1 : need;
    room -= room / 16;
    while (to > 0 && may_fit(bias, to - 1, room, &need))
        to--;
    if (to == bias->quarters)
        return;
    change(bias, bias->quarters - (bias->quarters - to + 1) / 2);
    bias->on_trial = true;
}

void slc_demand_bias_update(struct slc_demand_bias *bias, const struct slc_demand_need *need)
{
    float pages = (float)(need->used + need->missing), room = (float)need->room;
    float total = pages + (float)need->used_pinned;
    if (bias->settled)
        bias->loads += need->loads;
    if ((float)bias->loads > 2 * pages + 16)
        forget(bias); /* another view */
    if (pages > room || need->fails) {
        learn(bias, pages, total);
        bias->seen[bias->quarters].fails = true;
        raise(bias, pages, room);
        return;
    }
    bias->raises = 0;
    if (need->missing * 8 > need->used + need->missing) {
        bias->calm = 0; /* most of it is not known yet */
        return;
    }
    learn(bias, pages, total);
    bias->settled = true;
    if (++bias->calm < CALM_LAUNCHES << bias->failed_trials)
        return;
    if (bias->calm >= TRIAL_PERIODS * CALM_LAUNCHES << bias->failed_trials) {
        bias->on_trial = false;
        bias->failed_trials = 0;
    }
    lower(bias, pages, room);
}
