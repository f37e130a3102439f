/**
 * A lower bound on the levels too coarse under budget, cap and latency, by Lagrangian relaxation.
 * Every frame has a price per upload and per slot. Every node plays its best game at these prices.
 * The sum of the nodes' gains and the value of the limits bounds the gain of any schedule. The
 * bound holds for all non-negative prices; subgradient steps search good ones. The rule that a tile
 * counts only with its coarser tiles is relaxed, too.
 */
#include "clairvoyant.h"

#include <stdlib.h>
#include <string.h>

struct ascent {
    const struct workload *w;
    const struct limits *limits;
    double *uploads, *slots; ///< uploads and slots that the nodes take at the current prices
    double total;            ///< levels too coarse if nothing is ever resident
};

static uint32_t log2_floor(uint32_t x)
{
    uint32_t k = 0;
    while (x >>= 1)
        k++;
    return k;
}

static void range_least_build(struct range_least *r)
{
    for (uint32_t i = 0; i < r->count; i++)
        r->places[i] = i;
    for (uint32_t k = 1; 1u << k <= r->count; k++) {
        const uint32_t *below = r->places + (size_t)(k - 1) * r->count;
        uint32_t *row = r->places + (size_t)k * r->count;
        for (uint32_t i = 0; i + (1u << k) <= r->count; i++) {
            uint32_t a = below[i], b = below[i + (1u << (k - 1))];
            row[i] = r->values[a] < r->values[b] ? a : b; /* the later one of equals */
        }
    }
}

uint32_t clv_cheapest_load(const struct prices *p, bool packed, uint32_t from, uint32_t to)
{
    const struct range_least *r = &p->least[packed];
    uint32_t k = log2_floor(to - from + 1);
    const uint32_t *row = r->places + (size_t)k * r->count;
    uint32_t a = row[from], b = row[to + 1 - (1u << k)];
    return r->values[a] < r->values[b] ? a : b;
}

static void prices_init(struct prices *p, const struct workload *w)
{
    uint32_t frames = w->frame_count;
    *p = (struct prices){.frame_count = frames};
    p->upload = clv_alloc(frames, sizeof *p->upload);
    p->slot = clv_alloc(frames, sizeof *p->slot);
    p->held = clv_alloc((size_t)frames + 1, sizeof *p->held);
    for (uint32_t i = 0; i < 2; i++) {
        p->load[i] = i ? p->upload : clv_alloc(frames, sizeof *p->load[i]);
        p->least[i] = (struct range_least){p->load[i], NULL, frames};
        p->least[i].places =
            clv_alloc((size_t)frames * (log2_floor(frames) + 1), sizeof *p->least[i].places);
    }
    p->after_free = clv_alloc(w->use_count, sizeof *p->after_free);
    p->after_held = clv_alloc(w->use_count, sizeof *p->after_held);
}

void clv_prices_finish(struct prices *p)
{
    free(p->upload);
    free(p->slot);
    free(p->held);
    free(p->load[0]);
    free(p->least[0].places);
    free(p->least[1].places);
    free(p->after_free);
    free(p->after_held);
}

static void sum_up(struct prices *p)
{
    for (uint32_t f = 0; f < p->frame_count; f++) {
        p->load[0][f] = p->upload[f] - p->held[f];
        p->held[f + 1] = p->held[f] + p->slot[f];
    }
    range_least_build(&p->least[0]);
    range_least_build(&p->least[1]);
}

struct game {
    const struct ascent *a;
    struct prices *p;
    const struct node *node;
    uint32_t first, end;
};

/** Chooses the frame in which to load for `use`, for a node that was absent at the previous use. */
static bool load_frame(const struct game *g, uint32_t use, uint32_t *frame)
{
    const struct use *uses = g->a->w->uses;
    uint32_t latency = g->a->limits->latency, from = 0;
    if (uses[use].frame <= latency)
        return false;
    if (use > g->first && uses[use - 1].frame > latency)
        from = uses[use - 1].frame - latency;
    *frame = clv_cheapest_load(g->p, g->node->packed, from, uses[use].frame - latency - 1);
    return true;
}

static double held_between(const struct game *g, uint32_t from, uint32_t to)
{
    return g->node->packed ? 0 : g->node->size * (g->p->held[to] - g->p->held[from]);
}

/** Best gain from `use` on if the node is loaded for it. */
static double gain_loaded(const struct game *g, uint32_t use)
{
    const struct use *u = &g->a->w->uses[use];
    uint32_t frame;
    if (!load_frame(g, use, &frame))
        return -1;
    return u->regions + g->p->after_held[use] - g->node->size * g->p->upload[frame] -
           held_between(g, frame, u->frame);
}

static double gain_kept(const struct game *g, uint32_t use)
{
    const struct use *u = &g->a->w->uses[use];
    return u->regions + g->p->after_held[use] - held_between(g, u[-1].frame, u->frame);
}

static double gain_dropped(const struct game *g, uint32_t use)
{
    bool lost = g->a->limits->hold && g->a->w->uses[use].follows;
    return lost ? g->p->after_free[use] : g->p->after_free[use - 1];
}

/** Fills in the gains of a node's uses from the last to the first. Returns the total gain. */
static double play_backward(const struct game *g)
{
    struct prices *p = g->p;
    p->after_free[g->end - 1] = p->after_held[g->end - 1] = 0;
    for (uint32_t i = g->end - 1; i > g->first; i--) {
        double loaded = gain_loaded(g, i), skipped = p->after_free[i];
        p->after_free[i - 1] = loaded > skipped ? loaded : skipped;
        double kept = gain_kept(g, i), dropped = gain_dropped(g, i);
        p->after_held[i - 1] = kept > dropped ? kept : dropped;
    }
    double loaded = gain_loaded(g, g->first), skipped = p->after_free[g->first];
    return loaded > skipped ? loaded : skipped;
}

/** Adds up what the best game takes. Slots are differences between frames. */
static void play_forward(const struct game *g, struct ascent *a)
{
    enum { FREE, LOST, HELD } state = FREE;
    const struct use *uses = a->w->uses;
    double size = g->node->size, slot = g->node->packed ? 0 : size;
    for (uint32_t i = g->first; i < g->end; i++) {
        uint32_t frame;
        if (state == HELD && gain_kept(g, i) < gain_dropped(g, i)) {
            a->slots[uses[i - 1].frame] -= slot;
            state = a->limits->hold && uses[i].follows ? LOST : FREE;
        }
        if (state == LOST) {
            state = FREE;
        } else if (state == FREE && load_frame(g, i, &frame) &&
                   gain_loaded(g, i) > g->p->after_free[i]) {
            a->uploads[frame] += size;
            a->slots[frame] += slot;
            state = HELD;
        }
    }
    if (state == HELD)
        a->slots[uses[g->end - 1].frame] -= slot;
}

/** Returns the bound on the gain of any schedule at these prices. */
static double play_all(struct ascent *a, struct prices *p)
{
    const struct workload *w = a->w;
    double gain = 0, taken = 0;
    memset(a->uploads, 0, w->frame_count * sizeof *a->uploads);
    memset(a->slots, 0, w->frame_count * sizeof *a->slots);
    sum_up(p);
    for (uint32_t n = 0; n < w->node_count; n++) {
        struct game g = {a, p, &w->nodes[n], w->nodes[n].first_use, w->nodes[n + 1].first_use};
        if (g.first == g.end)
            continue;
        gain += play_backward(&g);
        play_forward(&g, a);
    }
    for (uint32_t f = 0; f < w->frame_count; f++) {
        taken += a->slots[f];
        a->slots[f] = taken;
        gain += p->upload[f] * a->limits->budget;
        if (a->limits->cap != UINT64_MAX)
            gain += p->slot[f] * (double)a->limits->cap;
    }
    return gain;
}

/** Component of the subgradient, limited to a crowd of `crowd` times the limit per frame. */
static double excess(double taken, double limit, double price, double crowd)
{
    double over = taken - limit;
    if (over < 0 && price <= 0)
        return 0;
    return over < crowd * limit ? over : crowd * limit;
}

/** Steps along the smoothed subgradient, with a length by Polyak's rule. */
static void step(struct ascent *a, struct prices *p, double *direction, double length, double crowd)
{
    uint32_t frames = p->frame_count;
    bool capped = a->limits->cap != UINT64_MAX;
    double square = 0;
    for (uint32_t f = 0; f < frames; f++) {
        double over = excess(a->uploads[f], a->limits->budget, p->upload[f], crowd);
        direction[f] = 0.7 * direction[f] + 0.3 * over;
        over = capped ? excess(a->slots[f], (double)a->limits->cap, p->slot[f], crowd) : 0;
        direction[frames + f] = 0.7 * direction[frames + f] + 0.3 * over;
    }
    for (uint32_t f = 0; f < 2 * frames; f++)
        square += direction[f] * direction[f];
    if (square <= 0)
        return;
    for (uint32_t f = 0; f < 2 * frames; f++) {
        double *price = f < frames ? &p->upload[f] : &p->slot[f - frames];
        *price += length / square * direction[f];
        *price = *price > 0 ? *price : 0;
    }
}

void clv_prices_find(struct prices *p, const struct workload *w, const struct limits *limits,
                     uint64_t known, uint32_t rounds, double crowd)
{
    uint32_t frames = w->frame_count;
    struct ascent a = {.w = w, .limits = limits};
    a.uploads = clv_alloc(frames, sizeof *a.uploads);
    a.slots = clv_alloc(frames, sizeof *a.slots);
    double *direction = clv_alloc((size_t)2 * frames, sizeof *direction);
    double *best = clv_alloc((size_t)2 * frames, sizeof *best);
    for (uint32_t i = 0; i < w->use_count; i++)
        a.total += w->uses[i].regions;
    double least = a.total, theta = 0.3, target = a.total - (double)known;
    uint32_t since = 0;
    prices_init(p, w);
    for (uint32_t round = 0; round < rounds; round++) {
        double gain = play_all(&a, p);
        since = gain < least ? 0 : since + 1;
        if (gain < least) {
            least = gain;
            memcpy(best, p->upload, frames * sizeof *best);
            memcpy(best + frames, p->slot, frames * sizeof *best);
        }
        if (since == 10) { /* overshooting */
            theta *= 0.8;
            since = 0;
        }
        step(&a, p, direction, theta * (gain - target), crowd);
    }
    memcpy(p->upload, best, frames * sizeof *best);
    memcpy(p->slot, best + frames, frames * sizeof *best);
    play_all(&a, p);
    p->bound = a.total - least;
    free(a.uploads);
    free(a.slots);
    free(direction);
    free(best);
}
