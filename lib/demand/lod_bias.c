#include "demand/lod_bias.h"

#include "base/checked.h"

#include <string.h>

/* Pages are counted in 256ths, to 2^23 pages, which is 512 GiB of tiles: products fit 64 bits. */
#define PAGE 256u
#define MOST (UINT32_C(1) << 31)
#define UNSCALED 65536u
#define ANOTHER_VIEW (UNSCALED / 4 * 3)
#define CALM_LAUNCHES 2u
#define MAX_FAILED_TRIALS 6u
#define TRIAL_PERIODS 8u

static uint32_t pages_of(uint64_t count)
{
    return count < MOST / PAGE ? (uint32_t)count * PAGE : MOST;
}

/* Returns value * to / from, for values up to MOST. */
static uint32_t scaled(uint32_t value, uint32_t to, uint32_t from)
{
    uint64_t product = ((uint64_t)value * to + from / 2) / from;
    return product < MOST ? (uint32_t)product : MOST;
}

/* A level is a factor of 4 in texels, so a quarter of a level is a factor of sqrt(2). */
static uint32_t quarter_finer(uint32_t pages)
{
    return scaled(pages, 46341, 32768);
}

static uint32_t quarter_coarser(uint32_t pages)
{
    return scaled(pages, 32768, 46341);
}

/* Forgets the statistics of all biases, because the view has changed. */
static void forget(struct slc_demand_bias *bias)
{
    memset(bias->seen, 0, sizeof bias->seen);
    bias->loads = 0;
}

/* Learns the need of the present bias. Scales the needs of other biases by its change, because the
 * view may have changed. */
static void learn(struct slc_demand_bias *bias, uint32_t need, uint32_t total)
{
    uint32_t now = bias->quarters;
    if (bias->seen[now].known) {
        uint32_t to = 1, from = 1;
        if (bias->seen[now].need > 0 && need > 0)
            to = need, from = bias->seen[now].need;
        else if (bias->seen[now].total > 0)
            to = total, from = bias->seen[now].total;
        for (uint32_t i = 0; i <= SLC_MAX_BIAS_QUARTERS; i++) {
            bias->seen[i].need = scaled(bias->seen[i].need, to, from);
            bias->seen[i].total = scaled(bias->seen[i].total, to, from);
            bias->seen[i].scale = scaled(bias->seen[i].scale, to, from);
            bias->seen[i].old |= bias->seen[i].scale < ANOTHER_VIEW;
        }
    }
    bias->seen[now].known = true;
    bias->seen[now].scale = UNSCALED;
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

/* Raises the bias until the need should fit. Raises it further after each consecutive failure. */
static void raise(struct slc_demand_bias *bias, uint32_t need, uint32_t room)
{
    uint32_t to = bias->quarters, least = to + ++bias->raises;
    do {
        to = slc_min_u32(to + 1, SLC_MAX_BIAS_QUARTERS);
        need = bias->seen[to].known ? bias->seen[to].need : quarter_coarser(need);
    } while (to < SLC_MAX_BIAS_QUARTERS && (need > room || bias->seen[to].fails) && need >= PAGE);
    if (!bias->seen[to].known)
        to = slc_min_u32(slc_max_u32(to, least), SLC_MAX_BIAS_QUARTERS);
    if (bias->on_trial && bias->failed_trials < MAX_FAILED_TRIALS)
        bias->failed_trials++;
    bias->on_trial = false;
    if (to > bias->quarters)
        change(bias, to);
}

/* True if the next finer bias may fit. On entry, *need is the need of the present bias. If true,
 * sets *need to the need of the finer bias. Old statistics do not forbid a trial. */
static bool may_fit(const struct slc_demand_bias *bias, uint32_t finer, uint32_t room,
                    uint32_t *need)
{
    uint32_t guess = quarter_finer(*need);
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

/* Lowers the bias half of the way to the finest one that should fit, because estimates are rough.
 */
static void lower(struct slc_demand_bias *bias, uint32_t need, uint32_t room)
{
    uint32_t to = bias->quarters;
    need = slc_max_u32(need, PAGE);
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
    uint64_t count = need->used + need->missing;
    uint32_t pages = pages_of(count), room = pages_of(need->room);
    uint32_t total = pages_of(count + need->used_pinned);
    if (bias->settled)
        bias->loads += need->loads;
    /* Failed loads do not count: a page that cannot be read is requested in each launch. */
    bias->loads -= need->failed_loads < bias->loads ? need->failed_loads : bias->loads;
    if (bias->loads > 2 * count + 16)
        forget(bias); /* another view */
    if (count > need->room || need->fails) {
        learn(bias, pages, total);
        bias->seen[bias->quarters].fails = true;
        raise(bias, pages, room);
        return;
    }
    bias->raises = 0;
    if (need->missing * 8 > count) {
        bias->calm = 0; /* much is missing, so the need is not known yet */
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
