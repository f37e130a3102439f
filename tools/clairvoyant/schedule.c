/**
 * Plays a trace with full knowledge of it. In every frame, absent nodes bid for uploads; when slots
 * are short, resident nodes bid to stay. Without prices a bid is a deadline: earliest next use,
 * then coarse levels, then many regions. With prices a bid is the gain of acting now instead of
 * later or never.
 */
#include "clairvoyant.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WORTHLESS 1e-6

#define NONE UINT32_MAX
enum presence { ABSENT, COMING, THERE };

struct live {
    uint32_t next;     ///< first use after the current frame
    uint32_t usable;   ///< first use that it may be loaded for
    uint32_t held_at;  ///< last use that it was resident for; NONE after a drop that counts as none
    uint32_t children; ///< children that are resident or in flight
    uint8_t presence;
    bool served; ///< true: used since it arrived
};

struct bid {
    double amount;
    uint32_t node, use;
};

struct bid_heap {
    struct bid *bids;
    uint32_t count;
    double sign; ///< 1: greatest first; -1: least first
};

struct arrival {
    uint32_t node, frame; ///< the node is resident after this frame's maps
};

struct play {
    const struct workload *w;
    const struct limits *limits;
    const struct prices *prices;
    FILE *plan;
    struct live *live;
    uint32_t *seen; ///< by node: last frame + 1 in which it and all nodes over it were resident
    uint32_t *active, active_count;
    uint32_t *visit; ///< by set: its next visit
    struct bid_heap loads, stays;
    struct arrival *arrivals;
    uint32_t arrival_first, arrival_end, packed_next;
    uint64_t used, packed_used;
    int64_t room; ///< uploads left in this frame; below 0: taken from the next frames
    uint32_t frame;
    struct outcome out;
};

static void sift_down(struct bid_heap *h, uint32_t i)
{
    struct bid moved = h->bids[i];
    for (uint32_t child; (child = 2 * i + 1) < h->count; i = child) {
        if (child + 1 < h->count &&
            h->sign * h->bids[child + 1].amount > h->sign * h->bids[child].amount)
            child++;
        if (h->sign * h->bids[child].amount <= h->sign * moved.amount)
            break;
        h->bids[i] = h->bids[child];
    }
    h->bids[i] = moved;
}

static struct bid take_first(struct bid_heap *h)
{
    struct bid first = h->bids[0];
    h->bids[0] = h->bids[--h->count];
    if (h->count)
        sift_down(h, 0);
    return first;
}

static void put_back(struct bid_heap *h, struct bid bid)
{
    uint32_t i = h->count++;
    for (; i > 0 && h->sign * h->bids[(i - 1) / 2].amount < h->sign * bid.amount; i = (i - 1) / 2)
        h->bids[i] = h->bids[(i - 1) / 2];
    h->bids[i] = bid;
}

static void order_bids(struct bid_heap *h)
{
    for (uint32_t i = h->count / 2; i-- > 0;)
        sift_down(h, i);
}

static double deadline_bid(const struct play *p, const struct node *node, uint32_t use)
{
    const struct use *u = &p->w->uses[use];
    return u->regions - (u->frame * 64.0 + (63 - node->level)) * 65536.0;
}

static double kept_cost(const struct play *p, const struct node *node, uint32_t to)
{
    return node->packed ? 0 : node->size * (p->prices->held[to] - p->prices->held[p->frame + 1]);
}

/** Best gain of a node without a slot after this frame, from `use` on. */
static double gain_later(const struct play *p, const struct node *node, uint32_t first,
                         uint32_t use)
{
    const struct prices *prices = p->prices;
    const struct use *u = &p->w->uses[use];
    double gain = prices->after_free[use];
    if (use < first || u->frame <= p->frame + p->limits->latency + 1)
        return gain;
    uint32_t load =
        clv_cheapest_load(prices, node->packed, p->frame + 1, u->frame - p->limits->latency - 1);
    double held = node->packed ? 0 : prices->held[u->frame] - prices->held[load];
    double loaded =
        u->regions + prices->after_held[use] - node->size * (prices->upload[load] + held);
    return loaded > gain ? loaded : gain;
}

static double priced_bid(const struct play *p, const struct node *node, uint32_t use,
                         uint32_t later)
{
    const struct use *u = &p->w->uses[use];
    double now = u->regions + p->prices->after_held[use] - kept_cost(p, node, u->frame);
    return (now - gain_later(p, node, later, use)) / node->size;
}

/** Returns whether limits.hold forbids a load: the node would be back for the map that its drop has
 * cost. */
static bool is_barred(const struct play *p, uint32_t n)
{
    const struct live *live = &p->live[n];
    return live->usable > live->next &&
           p->frame + p->limits->latency < p->w->uses[live->next].frame;
}

static void bid_to_load(struct play *p, uint32_t n, uint32_t end)
{
    const struct live *live = &p->live[n];
    uint32_t use = live->next > live->usable ? live->next : live->usable;
    while (use < end && p->w->uses[use].frame <= p->frame + p->limits->latency)
        use++;
    if (use == end || is_barred(p, n))
        return;
    const struct node *node = &p->w->nodes[n];
    double amount = p->prices ? priced_bid(p, node, use, 0) : 0;
    if (amount <= WORTHLESS) /* later is as good: load only if nothing must be dropped for it */
        amount = deadline_bid(p, node, use);
    p->loads.bids[p->loads.count++] = (struct bid){amount, n, use};
}

/** First use that a node may be loaded for if it is dropped now. */
static uint32_t usable_after_drop(const struct play *p, uint32_t n)
{
    const struct live *live = &p->live[n];
    bool next = live->next < p->w->nodes[n + 1].first_use;
    bool lost = p->limits->hold && next && p->w->uses[live->next].follows &&
                live->held_at + 1 == live->next;
    return lost ? live->next + 1 : live->next;
}

static void bid_to_stay(struct play *p, uint32_t n)
{
    const struct live *live = &p->live[n];
    const struct node *node = &p->w->nodes[n];
    if (live->children || node->packed)
        return;
    double amount = -INFINITY;
    if (live->next < p->w->nodes[n + 1].first_use)
        amount = p->prices ? fmax(0, priced_bid(p, node, live->next, usable_after_drop(p, n)))
                           : deadline_bid(p, node, live->next);
    p->stays.bids[p->stays.count++] = (struct bid){amount, n, live->next};
}

static void write_plan(const struct play *p, uint32_t n, char what)
{
    const struct node *node = &p->w->nodes[n];
    if (p->plan)
        fprintf(p->plan, "%u %c %u %u %u\n", p->frame, what, p->w->set_texture[node->set],
                node->tile, node->size);
}

static void drop(struct play *p, uint32_t n)
{
    struct live *live = &p->live[n];
    const struct node *node = &p->w->nodes[n];
    live->usable = usable_after_drop(p, n);
    live->presence = ABSENT;
    if (!live->served)
        p->out.unused += node->size;
    p->used -= node->size;
    write_plan(p, n, '-');
    if (node->parent == NO_NODE || p->w->nodes[node->parent].packed)
        return;
    if (--p->live[node->parent].children == 0 && p->live[node->parent].presence == THERE)
        for (uint32_t count = p->stays.count;;) {
            bid_to_stay(p, node->parent);
            if (p->stays.count > count)
                put_back(&p->stays, p->stays.bids[--p->stays.count]);
            break;
        }
}

/** Frees slots by dropping nodes that bid less than `amount`. */
static bool make_room(struct play *p, uint32_t size, double amount)
{
    while (p->limits->cap != UINT64_MAX && p->used + size > p->limits->cap) {
        if (p->stays.count == 0)
            return false;
        struct bid least = take_first(&p->stays);
        const struct live *live = &p->live[least.node];
        if (live->presence != THERE || live->children || live->next != least.use)
            continue;
        if (least.amount >= amount) {
            put_back(&p->stays, least);
            return false;
        }
        drop(p, least.node);
    }
    return true;
}

static void hand_out(struct play *p, uint32_t n)
{
    struct live *live = &p->live[n];
    const struct node *node = &p->w->nodes[n];
    uint32_t budget = p->limits->budget, wait = p->limits->latency;
    p->room -= node->size;
    if (p->room < 0)
        wait += (uint32_t)((-p->room + budget - 1) / budget);
    p->arrivals[p->arrival_end++] = (struct arrival){n, p->frame + wait};
    if (p->arrival_end ==
        p->w->node_count) { /* far fewer loads are in flight, so the array can be compacted */
        p->arrival_end -= p->arrival_first;
        memmove(p->arrivals, p->arrivals + p->arrival_first, p->arrival_end * sizeof *p->arrivals);
        p->arrival_first = 0;
    }
    live->presence = COMING;
    live->served = false;
    p->out.uploads += node->size;
    if (node->packed)
        p->packed_used += node->size;
    else
        p->used += node->size;
    write_plan(p, n, '+');
}

/** Hands out a node after its parents. Returns false without a free slot or upload. */
static bool admit(struct play *p, uint32_t n, double amount)
{
    const struct node *node = &p->w->nodes[n];
    if (p->live[n].presence != ABSENT)
        return true;
    if (node->parent != NO_NODE && !admit(p, node->parent, amount))
        return false;
    if (p->room <= 0 || is_barred(p, n))
        return false;
    if (node->parent != NO_NODE)
        p->live[node->parent].children++; /* keeps the parent from being dropped to make room */
    if (!node->packed && !make_room(p, node->size, amount)) {
        p->live[node->parent].children--;
        return false;
    }
    hand_out(p, n);
    return true;
}

static void count_return(struct play *p, uint32_t n, uint32_t use)
{
    bool gap = p->live[n].held_at != NONE && p->live[n].held_at + 1 == use;
    if (p->live[n].presence == COMING && gap && p->w->uses[use].follows)
        p->out.returned += p->w->nodes[n].size;
}

static void gather_bids(struct play *p)
{
    const struct node *nodes = p->w->nodes;
    uint32_t kept = 0;
    p->loads.count = p->stays.count = 0;
    for (uint32_t i = 0; i < p->active_count; i++) {
        uint32_t n = p->active[i], end = nodes[n + 1].first_use;
        if (p->live[n].presence == ABSENT && p->live[n].next == end)
            continue;
        p->active[kept++] = n;
        if (p->live[n].presence == ABSENT)
            bid_to_load(p, n, end);
        else if (p->live[n].presence == THERE && p->limits->cap != UINT64_MAX)
            bid_to_stay(p, n);
    }
    p->active_count = kept;
    order_bids(&p->loads);
    order_bids(&p->stays);
}

static void hand_out_frame(struct play *p)
{
    p->room = (p->room < 0 ? p->room : 0) + p->limits->budget;
    gather_bids(p);
    while (p->loads.count && p->room > 0) {
        struct bid bid = take_first(&p->loads);
        bool absent = p->live[bid.node].presence == ABSENT;
        if (absent && admit(p, bid.node, bid.amount))
            count_return(p, bid.node, bid.use);
    }
    /* packed tiles are always loaded, even without any map */
    for (; p->packed_next < p->w->set_count && p->room > 0; p->packed_next++)
        admit(p, p->packed_next, 0);
    uint64_t slots = p->used + p->packed_used;
    p->out.peak = slots > p->out.peak ? slots : p->out.peak;
}

/** Returns whether the set's latest map does not need the arrived tile. */
static bool is_stale(const struct play *p, uint32_t n)
{
    const struct workload *w = p->w;
    uint32_t set = w->nodes[n].set, next = p->live[n].next;
    if (w->nodes[n].packed || p->visit[set] == w->visit_first[set])
        return false;
    return next == w->nodes[n].first_use || w->uses[next - 1].frame != w->visits[p->visit[set] - 1];
}

static void land(struct play *p)
{
    while (p->arrival_first < p->arrival_end && p->arrivals[p->arrival_first].frame <= p->frame) {
        uint32_t n = p->arrivals[p->arrival_first++].node;
        p->live[n].presence = THERE;
        if (is_stale(p, n))
            p->out.stale += p->w->nodes[n].size;
    }
}

static void sample(struct play *p)
{
    const struct workload *w = p->w;
    for (uint32_t i = w->frame_first[p->frame]; i < w->frame_first[p->frame + 1]; i++) {
        uint32_t n = w->frame_uses[i].node, use = w->frame_uses[i].use;
        uint32_t parent = w->nodes[n].parent;
        struct live *live = &p->live[n];
        live->next = use + 1;
        if (live->presence == THERE && (parent == NO_NODE || p->seen[parent] == p->frame + 1)) {
            p->seen[n] = p->frame + 1;
            live->served = true;
            live->held_at = use;
        } else {
            p->out.deficit += w->uses[use].regions;
            p->out.too_coarse += w->uses[use].exact;
        }
    }
}

static void see_visits(struct play *p)
{
    const struct workload *w = p->w;
    for (uint32_t i = 0; i < w->set_count; i++)
        while (p->visit[i] < w->visit_first[i + 1] && w->visits[p->visit[i]] <= p->frame)
            p->visit[i]++;
}

static void play_init(struct play *p)
{
    const struct workload *w = p->w;
    p->live = clv_alloc(w->node_count, sizeof *p->live);
    p->seen = clv_alloc(w->node_count, sizeof *p->seen);
    p->active = clv_alloc(w->node_count, sizeof *p->active);
    p->visit = clv_alloc(w->set_count, sizeof *p->visit);
    p->loads = (struct bid_heap){clv_alloc(w->node_count, sizeof *p->loads.bids), 0, 1};
    p->stays =
        (struct bid_heap){clv_alloc((size_t)w->node_count + 1, sizeof *p->stays.bids), 0, -1};
    p->arrivals = clv_alloc(w->node_count, sizeof *p->arrivals);
    p->active_count = w->node_count;
    for (uint32_t n = 0; n < w->node_count; n++) {
        p->live[n] = (struct live){.next = w->nodes[n].first_use, .held_at = NONE};
        p->active[n] = n;
    }
    if (w->set_count)
        memcpy(p->visit, w->visit_first, w->set_count * sizeof *p->visit);
}

struct outcome clv_schedule(const struct workload *w, const struct limits *limits,
                            const struct prices *prices, FILE *plan)
{
    struct play p = {.w = w, .limits = limits, .prices = prices, .plan = plan};
    play_init(&p);
    for (p.frame = 0; p.frame < w->frame_count; p.frame++) {
        sample(&p);
        see_visits(&p);
        hand_out_frame(&p);
        land(&p);
    }
    for (uint32_t n = 0; n < w->node_count; n++)
        if (!w->nodes[n].packed && p.live[n].presence == THERE && !p.live[n].served)
            p.out.unused += w->nodes[n].size;
    free(p.live);
    free(p.seen);
    free(p.active);
    free(p.visit);
    free(p.loads.bids);
    free(p.stays.bids);
    free(p.arrivals);
    return p.out;
}

struct outcome clv_schedule_best(const struct workload *w, const struct limits *limits,
                                 uint64_t known, uint32_t rounds, struct prices *best)
{
    static const double crowds[] = {1e6, 4};
    struct outcome least = {.deficit = UINT64_MAX};
    double bound = 0;
    *best = (struct prices){0};
    for (uint32_t i = 0; i < sizeof crowds / sizeof *crowds; i++) {
        struct prices prices;
        clv_prices_find(&prices, w, limits, known, rounds, crowds[i]);
        bound = prices.bound > bound ? prices.bound : bound;
        struct outcome outcome = clv_schedule(w, limits, &prices, NULL);
        bool better = outcome.deficit < least.deficit;
        clv_prices_finish(better ? best : &prices);
        if (better) {
            least = outcome;
            *best = prices;
        }
    }
    best->bound = bound;
    return least;
}
