#include "device/demand_expect.h"

#include "device/demand_images.h"

#include <math.h>
#include <string.h>

static uint32_t field(uint32_t shape, uint32_t shift)
{
    return shape >> shift & 31;
}

static void add_page(uint32_t *pages, uint32_t *count, uint32_t page)
{
    for (uint32_t i = 0; i < *count; i++)
        if (pages[i] == page)
            return;
    if (*count < DEMAND_TAP_PAGES)
        pages[(*count)++] = page;
}

static void add_to_sums(struct demand_expectation *e, const struct demand_touch *touch,
                        uint32_t channel, double value)
{
    e->sum[0][channel] += touch->weight * value;
    e->sum[1][channel] += touch->du * value;
    e->sum[2][channel] += touch->dv * value;
}

static void add_touch(void *user, const struct demand_touch *touch)
{
    struct demand_expectation *e = user;
    float texel[4];
    uint32_t components = e->entry->shape >> SLUICE_DEMAND_COMPONENTS_SHIFT & 7;
    if (touch->x < 0) {
        for (uint32_t i = 0; i < 4; i++)
            add_to_sums(e, touch, i, i < components ? (double)e->entry->borderColor[i] : i == 3);
        return;
    }
    uint32_t x = (uint32_t)touch->x, y = (uint32_t)touch->y;
    uint32_t page = demand_scene_page(e->scene, e->index, e->tap.level, x, y);
    demand_texel(e->scene, e->index, e->tap.level, x, y, texel);
    for (uint32_t i = 0; i < 4; i++)
        add_to_sums(e, touch, i,
                    (double)(page == DEMAND_NO_PAGE ? e->entry->baseColor[i] : texel[i]));
    if (page == DEMAND_NO_PAGE)
        return;
    if (touch->sure)
        add_page(e->here, &e->here_count, page);
    else
        add_page(e->unsure, &e->unsure_count, page);
}

static void note(struct demand_expectation *e, uint32_t page, uint8_t what)
{
    if (!e->notes[page])
        e->noted[e->noted_count++] = page;
    e->notes[page] |= what;
}

/* Looks up all pages that a filter touches in a level. */
static void look_up(struct demand_expectation *e)
{
    memset(e->sum, 0, sizeof e->sum);
    e->here_count = e->unsure_count = e->worst = 0;
    demand_oracle_touches(e->entry, &e->tap, add_touch, e);
    uint32_t sure_count = e->here_count;
    for (uint32_t i = 0; i < e->unsure_count; i++)
        add_page(e->here, &e->here_count, e->unsure[i]);
    e->sure = e->sure && e->here_count == sure_count; /* no page by a breath of weight */
    for (uint32_t i = 0; i < sure_count; i++) {
        uint32_t page = e->here[i];
        bool refused = demand_refused(e->scene, page), there = demand_resident(e->scene, page);
        uint32_t state = there ? 0 : refused ? 1 : 2;
        e->worst = state > e->worst ? state : e->worst;
        if (state < 2)
            note(e, page, DEMAND_USED);
        else if (e->ask)
            note(e, page, DEMAND_ASKED);
    }
}

static void add_tap(void *user, const struct demand_tap *tap)
{
    struct demand_expectation *e = user;
    uint32_t regular = field(e->entry->shape, SLUICE_DEMAND_REGULAR_SHIFT);
    uint32_t last = field(e->entry->shape, SLUICE_DEMAND_LEVEL_COUNT_SHIFT) - 1;
    bool ask = true;
    e->sure = e->sure && tap->sure;
    e->finest = tap->level < e->finest ? tap->level : e->finest;
    e->tap = *tap;
    for (;;) {
        e->ask = ask || e->tap.level >= regular;
        look_up(e);
        if (e->worst == 2) {
            e->resident = ask = false;
            if (!e->preview)
                return;
        }
        if (e->worst == 0)
            break;
        e->tap.level = e->tap.level < regular ? e->tap.level + 1 : last;
        e->tap.cubic = fmax(e->tap.cubic, demand_oracle_share(&e->tap, e->tap.level));
    }
    e->jumps = e->jumps || demand_oracle_jumps(e->entry, &e->tap);
    for (int i = 0; i < 4; i++) {
        e->color[i] += tap->weight * e->sum[0][i];
        e->du[i] += tap->weight * e->sum[1][i];
        e->dv[i] += tap->weight * e->sum[2][i];
    }
}

void demand_expect(struct demand_expectation *e, const struct DemandInput *in, uint8_t *pages)
{
    e->resident = e->sure = true;
    e->noted_count = 0;
    e->finest = UINT32_MAX;
    e->jumps = false;
    memset(e->color, 0, sizeof e->color);
    memset(e->du, 0, sizeof e->du);
    memset(e->dv, 0, sizeof e->dv);
    if (!demand_oracle_taps(e->entry, in, e->loader_bias, add_tap, e))
        e->sure = false;
    if (e->finest == field(e->entry->shape, SLUICE_DEMAND_LEVEL_COUNT_SHIFT) - 1)
        note(e, e->entry->tailPage, DEMAND_MARKED);
    if (!e->resident && !e->preview) {
        memset(e->color, 0, sizeof e->color);
        memset(e->du, 0, sizeof e->du);
        memset(e->dv, 0, sizeof e->dv);
    }
    for (uint32_t i = 0; i < e->noted_count; i++) {
        if (e->sure && pages)
            pages[e->noted[i]] |= e->notes[e->noted[i]];
        e->notes[e->noted[i]] = 0;
    }
}
