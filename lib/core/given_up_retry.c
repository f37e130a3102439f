/*
 * GIVEN_UP tiles are tried again: a few per texture as a probe, all as soon as one of them loads.
 * See docs/manager-specification.md, "Loads that fail".
 *
 * A texture with GIVEN_UP tiles rests, becomes due, is probed, and rests again. Each of these
 * states has a list of textures, in the order in which they entered it. A texture without GIVEN_UP
 * tiles leaves the lists when its turn to be probed comes.
 */
#include "core/given_up_retry.h"

#include "residency/node.h"

#define PROBED_TEXTURES 16u /* most textures that are probed at a time */
#define TILES_PER_PROBE 4u  /* more than one, because some may be damaged for good */
#define DEFAULT_FACTOR 120u /* default delay / retryDelayTicks */
#define EARLY_PART 8u       /* delay / time after which a load that succeeds starts a probe */
#define LONGEST (UINT64_C(1) << 62)

/* Delay until GIVEN_UP tiles are tried again. 0: never. */
static uint64_t retry_interval(const slc_manager *m)
{
    uint64_t given = m->config.givenUpRetryDelayTicks, delay = m->config.retryDelayTicks;
    if (given == UINT64_MAX)
        return 0;
    if (given)
        return given;
    return delay < LONGEST / DEFAULT_FACTOR ? delay * DEFAULT_FACTOR : LONGEST;
}

void slc_trouble_move(slc_manager *m, struct slc_managed_texture *t, enum slc_trouble to)
{
    struct slc_texture_list *list = &m->troubles[t->trouble];
    if (t->trouble != SLC_TROUBLE_NONE) {
        if (t->trouble_prev != SLC_NONE)
            slc_texture_at(m, t->trouble_prev)->trouble_next = t->trouble_next;
        else
            list->first = t->trouble_next;
        if (t->trouble_next != SLC_NONE)
            slc_texture_at(m, t->trouble_next)->trouble_prev = t->trouble_prev;
        else
            list->last = t->trouble_prev;
        list->count--;
        m->trouble_count--;
    }
    t->trouble = (uint8_t)to;
    t->trouble_time = m->time;
    if (to == SLC_TROUBLE_NONE)
        return;
    list = &m->troubles[to];
    t->trouble_prev = list->count ? list->last : SLC_NONE;
    t->trouble_next = SLC_NONE;
    if (list->count)
        slc_texture_at(m, list->last)->trouble_next = t->index;
    else
        list->first = t->index;
    list->last = t->index;
    list->count++;
    m->trouble_count++;
}

/* The first texture of a list if it has been there for the whole interval, or NULL. */
static struct slc_managed_texture *first_due(const slc_manager *m, enum slc_trouble state,
                                             uint64_t interval)
{
    const struct slc_texture_list *list = &m->troubles[state];
    struct slc_managed_texture *t = list->count ? slc_texture_at(m, list->first) : NULL;
    return t && m->time - t->trouble_time >= interval ? t : NULL;
}

static bool is_packed(const slc_manager *m, uint32_t node)
{
    return slc_is_packed_class(slc_node_at(&m->residency, node)->level);
}

/* Requests `count` GIVEN_UP tiles. Tiles keep their failures: one more makes them GIVEN_UP again.
 * Packed tiles are loaded together, so they do not count. */
static void request_tiles(slc_manager *m, struct slc_managed_texture *t, uint32_t count)
{
    m->events.reason = SLUICE_TILE_EVENT_RETRIED;
    for (uint32_t node; (node = t->given_up_first) && (count > 0 || is_packed(m, node));) {
        count -= count > 0;
        slc_node_request_again(&m->residency, node);
        m->given_up_retried_total++;
    }
}

static void probe(slc_manager *m, struct slc_managed_texture *t)
{
    slc_trouble_move(m, t, t->given_up_first ? SLC_TROUBLE_PROBED : SLC_TROUBLE_NONE);
    t->retried_all = false;
    request_tiles(m, t, TILES_PER_PROBE);
}

void slc_given_up_advance(slc_manager *m)
{
    uint64_t interval = retry_interval(m);
    if (interval == 0)
        return;
    for (struct slc_managed_texture *t; (t = first_due(m, SLC_TROUBLE_PROBED, interval));)
        slc_trouble_move(m, t, SLC_TROUBLE_RESTING); /* no answer: other textures are next */
    for (struct slc_managed_texture *t; (t = first_due(m, SLC_TROUBLE_RESTING, interval));)
        slc_trouble_move(m, t, SLC_TROUBLE_DUE);
    while (m->troubles[SLC_TROUBLE_DUE].count > 0 &&
           m->troubles[SLC_TROUBLE_PROBED].count < PROBED_TEXTURES)
        probe(m, slc_texture_at(m, m->troubles[SLC_TROUBLE_DUE].first));
}

void slc_given_up_again(slc_manager *m, struct slc_managed_texture *t)
{
    if (t->trouble == SLC_TROUBLE_NONE || t->trouble == SLC_TROUBLE_PROBED)
        slc_trouble_move(m, t, SLC_TROUBLE_RESTING);
}

void slc_given_up_note_success(slc_manager *m, struct slc_managed_texture *t, bool had_failed)
{
    uint64_t interval = retry_interval(m);
    if (!t->given_up_first || interval == 0)
        return;
    if (had_failed && !t->retried_all) {
        request_tiles(m, t, UINT32_MAX);
        slc_trouble_move(m, t, SLC_TROUBLE_NONE);
        t->retried_all = true;
    } else if (t->trouble == SLC_TROUBLE_RESTING &&
               m->time - t->trouble_time >= interval / EARLY_PART) {
        slc_trouble_move(m, t, SLC_TROUBLE_DUE);
    }
}
