/* Tests the clairvoyant policy on tiny random traces of two sets, by exhaustive search. */
#include <clairvoyant.h>

#include "support/test.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SETS = 2, NODES = 7, FRAMES = 12, CASES = 400 };

struct tiny {
    struct workload w;
    uint32_t regions[FRAMES][NODES]; ///< regions that need a node in a frame
};

static uint64_t random_state = 1;

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * 6364136223846793005ull + 1442695040888963407ull;
    return (uint32_t)(random_state >> 33) % limit;
}

/** Every second node is of the same set. A region that needs a node needs its parent, too. */
static void tiny_fill(struct tiny *t, uint32_t nodes)
{
    struct workload *w = &t->w;
    uint32_t visits = 1 + random_below(3); /* in 4 frames */
    w->nodes = clv_alloc(nodes + 1, sizeof *w->nodes);
    for (uint32_t n = 0; n < nodes; n++) {
        uint32_t set = n % SETS, grandchild = n >= 2 * SETS && random_below(2);
        uint32_t parent = n < SETS ? NO_NODE : grandchild ? n - SETS : set;
        uint32_t level = n < SETS ? NODES : w->nodes[parent].level - 1u;
        w->nodes[n] = (struct node){.set = set,
                                    .parent = parent,
                                    .size = 1,
                                    .level = (uint8_t)level,
                                    .packed = n < SETS,
                                    .tile = n};
    }
    for (uint32_t f = 0; f < FRAMES; f++) {
        bool seen[SETS] = {random_below(4) < visits, random_below(4) < visits};
        for (uint32_t n = nodes; n-- > 0;) {
            if (seen[n % SETS])
                t->regions[f][n] += random_below(2) * random_below(4);
            if (n >= SETS)
                t->regions[f][w->nodes[n].parent] += t->regions[f][n];
        }
    }
}

/** Returns the frame of the set's last map before `frame` in which something was needed; -1:
 * none. */
static int last_visit(const struct tiny *t, uint32_t set, uint32_t frame)
{
    int f = (int)frame - 1;
    while (f >= 0 && t->regions[f][set] == 0)
        f--;
    return f;
}

static void tiny_init(struct tiny *t, uint32_t nodes)
{
    struct frame_use order[FRAMES * NODES];
    struct use uses[FRAMES * NODES];
    struct workload *w = &t->w;
    *t = (struct tiny){.w = {.frame_count = FRAMES, .set_count = SETS, .node_count = nodes}};
    tiny_fill(t, nodes);
    w->visit_first = clv_alloc(SETS + 1, sizeof *w->visit_first);
    w->visits = clv_alloc((size_t)SETS * FRAMES, sizeof *w->visits);
    w->set_texture = clv_alloc(SETS, sizeof *w->set_texture);
    for (uint32_t s = 0, count = 0; s < SETS; s++) {
        for (uint32_t f = 0; f < FRAMES; f++)
            if (t->regions[f][s])
                w->visits[count++] = f;
        w->visit_first[s + 1] = count;
    }
    for (uint32_t f = 0; f < FRAMES; f++)
        for (uint32_t n = 0; n < nodes; n++) {
            int last = last_visit(t, n % SETS, f);
            w->regions += n < SETS ? t->regions[f][n] : 0;
            if (t->regions[f][n] == 0)
                continue;
            order[w->use_count] = (struct frame_use){n, w->use_count};
            uses[w->use_count++] = (struct use){.frame = f & 0xff,
                                                .follows = last >= 0 && t->regions[last][n],
                                                .regions = (uint16_t)t->regions[f][n]};
        }
    w->packed_tiles = SETS;
    clv_workload_index(w, order, uses);
}

static uint32_t bit_count(uint32_t x)
{
    uint32_t count = 0;
    for (; x; x &= x - 1)
        count++;
    return count;
}

static uint32_t needed_in(const struct tiny *t, uint32_t frame)
{
    uint32_t set = 0;
    for (uint32_t n = SETS; n < NODES; n++)
        set |= (uint32_t)(t->regions[frame][n] > 0) << (n - SETS);
    return set;
}

static uint32_t largest_need(const struct tiny *t)
{
    uint32_t most = 1;
    for (uint32_t f = 0; f < FRAMES; f++) {
        uint32_t count = bit_count(needed_in(t, f));
        most = count > most ? count : most;
    }
    return most;
}

/** Searches the fewest uploads over all sequences of cache contents that serve every frame. */
static uint32_t fewest_uploads(const struct tiny *t, uint32_t cap)
{
    enum { CONTENTS = 1 << (NODES - SETS), FAR = 1000000 };
    uint32_t cost[CONTENTS], next[CONTENTS], least = FAR;
    for (uint32_t s = 0; s < CONTENTS; s++)
        cost[s] = s ? FAR : 0;
    for (uint32_t f = 0; f < FRAMES; f++) {
        uint32_t need = needed_in(t, f);
        for (uint32_t to = 0; to < CONTENTS; to++) {
            next[to] = FAR;
            for (uint32_t s = 0; (to & need) == need && bit_count(to) <= cap && s < CONTENTS; s++) {
                uint32_t sum = cost[s] + bit_count(to & ~s);
                next[to] = sum < next[to] ? sum : next[to];
            }
        }
        memcpy(cost, next, sizeof cost);
    }
    for (uint32_t s = 0; s < CONTENTS; s++)
        least = cost[s] < least ? cost[s] : least;
    return least;
}

/** State of the cache, a bit per node. `coming`: handed out in the previous frame, with latency
 * 1. */
struct contents {
    uint32_t there, coming;
    uint32_t held; ///< resident since the last map that needed it, with all nodes over it
    uint32_t lost; ///< dropped; must not return for the next map that needs it
};

enum { PACKED = (1 << SETS) - 1, BITS = 5, STATES = 1 << 4 * BITS, FAR_OFF = 1000000 };

static struct contents unpack(uint32_t state)
{
    uint32_t mask = (1u << BITS) - 1;
    return (struct contents){state & mask, state >> BITS & mask, state >> 2 * BITS & mask,
                             state >> 3 * BITS & mask};
}

static uint32_t pack(struct contents c)
{
    return c.there | c.coming << BITS | c.held << 2 * BITS | c.lost << 3 * BITS;
}

/** Samples the maps of a frame. Returns the levels too coarse. */
static uint32_t sample_tiny(const struct tiny *t, uint32_t frame, struct contents *c)
{
    uint32_t sum = 0, seen = 0;
    for (uint32_t n = 0; n < t->w.node_count; n++) {
        uint32_t bit = 1u << n, parent = t->w.nodes[n].parent;
        if (c->there & bit && (n < SETS || seen >> parent & 1))
            seen |= bit;
        if (t->regions[frame][n] == 0)
            continue;
        sum += seen & bit ? 0 : t->regions[frame][n];
        c->held = (c->held & ~bit) | (seen & bit);
        c->lost &= ~bit;
    }
    return sum;
}

static const struct use *next_use(const struct tiny *t, uint32_t node, uint32_t frame)
{
    for (uint32_t i = t->w.nodes[node].first_use; i < t->w.nodes[node + 1].first_use; i++)
        if (t->w.uses[i].frame > frame)
            return &t->w.uses[i];
    return NULL;
}

/** Drops and hands out nodes after the maps of a frame. Returns false if that exceeds the
 * limits. */
static bool act(const struct tiny *t, const struct limits *limits, uint32_t frame, uint32_t kept,
                uint32_t loaded, struct contents *c)
{
    uint32_t dropped = c->there & ~kept, slots = bit_count((kept | c->coming | loaded) & ~PACKED);
    if (kept & ~c->there || loaded & (c->there | c->coming) || dropped & PACKED ||
        bit_count(loaded) > limits->budget || slots > limits->cap)
        return false;
    for (uint32_t n = 0; limits->hold && n < t->w.node_count; n++) {
        const struct use *next = next_use(t, n, frame);
        if (dropped & c->held & 1u << n && next && next->follows)
            c->lost |= 1u << n;
        if (loaded & c->lost & 1u << n && frame + limits->latency < next->frame)
            return false;
    }
    c->held &= kept;
    c->there = kept | c->coming | (limits->latency ? 0 : loaded);
    c->coming = limits->latency ? loaded : 0;
    return true;
}

static void try_actions(const struct tiny *t, const struct limits *limits, uint32_t frame,
                        struct contents from, uint32_t sum, uint32_t *next)
{
    uint32_t sets = 1u << t->w.node_count;
    sum += sample_tiny(t, frame, &from);
    for (uint32_t i = 0; i < sets * sets; i++) {
        struct contents to = from;
        if (act(t, limits, frame, i / sets, i % sets, &to)) {
            uint32_t *least = &next[pack(to)];
            *least = sum < *least ? sum : *least;
        }
    }
}

/** Searches the fewest levels too coarse over all schedules, for latency 0 and 1. */
static uint32_t least_deficit(const struct tiny *t, const struct limits *limits)
{
    static uint32_t cost[STATES], next[STATES];
    uint32_t least = FAR_OFF;
    for (uint32_t i = 0; i < STATES; i++)
        cost[i] = i ? FAR_OFF : 0;
    for (uint32_t f = 0; f < FRAMES; f++) {
        for (uint32_t i = 0; i < STATES; i++)
            next[i] = FAR_OFF;
        for (uint32_t i = 0; i < STATES; i++)
            if (cost[i] != FAR_OFF)
                try_actions(t, limits, f, unpack(i), cost[i], next);
        memcpy(cost, next, sizeof cost);
    }
    for (uint32_t i = 0; i < STATES; i++)
        least = cost[i] < least ? cost[i] : least;
    return least;
}

static void belady_needs_no_more_uploads_than_the_best_of_all(void **state)
{
    (void)state;
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < CASES; i++) {
        struct tiny t;
        tiny_init(&t, NODES);
        uint32_t cap = largest_need(&t) + random_below(2);
        struct belady result = clv_belady(&t.w, cap);
        wrong += result.uploads != fewest_uploads(&t, cap) + t.w.packed_tiles || result.unserved;
        result = clv_belady(&t.w, UINT64_MAX);
        wrong += result.uploads != result.distinct;
        clv_workload_finish(&t.w);
    }
    assert_int_equal(wrong, 0);
}

static void belady_tells_how_much_an_instant_exceeds_the_cap(void **state)
{
    (void)state;
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < CASES; i++) {
        struct tiny t;
        tiny_init(&t, NODES);
        uint32_t over = 0, unserved = 0;
        for (uint32_t f = 0; f < FRAMES; f++) {
            uint32_t need = bit_count(needed_in(&t, f));
            over += need > 2;
            unserved += need > 2 ? need - 2 : 0;
        }
        struct belady result = clv_belady(&t.w, 2);
        wrong += result.frames_over_cap != over || result.unserved != unserved;
        clv_workload_finish(&t.w);
    }
    assert_int_equal(wrong, 0);
}

/** Plays a written schedule by the rules of the exhaustive search. */
static bool plan_is_legal(const struct tiny *t, const struct limits *limits, FILE *plan,
                          uint64_t *deficit)
{
    uint32_t frame = NO_NODE, node = 0;
    bool legal = true;
    char what = 0;
    struct contents c = {0};
    rewind(plan);
    bool more = fscanf(plan, "%u %c %*u %u %*u", &frame, &what, &node) == 3;
    for (uint32_t f = 0; f < FRAMES; f++) {
        *deficit += sample_tiny(t, f, &c);
        uint32_t kept = c.there, loaded = 0;
        while (more && frame == f && node < t->w.node_count) {
            if (what == '+')
                loaded |= 1u << node;
            else
                kept &= ~(1u << node);
            more = fscanf(plan, "%u %c %*u %u %*u", &frame, &what, &node) == 3;
        }
        legal &= act(t, limits, f, kept, loaded, &c);
    }
    return legal && !more;
}

static void check_legal(bool hold)
{
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < 2 * CASES; i++) {
        struct tiny t;
        tiny_init(&t, BITS);
        struct limits limits = {1 + random_below(2), 1 + random_below(2), random_below(2), hold};
        struct prices prices;
        clv_prices_find(&prices, &t.w, &limits, 0, 30, 4);
        FILE *plan = tmpfile();
        uint64_t deficit = 0;
        struct outcome outcome = {0};
        if (plan)
            outcome = clv_schedule(&t.w, &limits, i % 2 ? &prices : NULL, plan);
        wrong += !plan || !plan_is_legal(&t, &limits, plan, &deficit) || deficit != outcome.deficit;
        if (plan)
            fclose(plan);
        clv_prices_finish(&prices);
        clv_workload_finish(&t.w);
    }
    assert_int_equal(wrong, 0);
}

/** Checks that schedules are between the optimum and 1.1 times the optimum, summed over all
 * cases. */
static void check_optimum(bool hold)
{
    uint32_t wrong = 0, cases = CASES / 8;
    uint64_t optimum = 0, reached = 0;
    double bounds = 0;
    for (uint32_t i = 0; i < cases; i++) {
        struct tiny t;
        tiny_init(&t, BITS);
        struct limits limits = {1 + random_below(2), 1 + random_below(2), random_below(2), hold};
        uint32_t least = least_deficit(&t, &limits);
        struct outcome deadline = clv_schedule(&t.w, &limits, NULL, NULL);
        struct prices prices;
        clv_prices_find(&prices, &t.w, &limits, deadline.deficit, 200, 1e6);
        struct outcome priced = clv_schedule(&t.w, &limits, &prices, NULL);
        wrong += prices.bound > least + 1e-6 || deadline.deficit < least ||
                 priced.deficit < least || priced.peak > limits.cap + SETS ||
                 deadline.peak > limits.cap + SETS;
        optimum += least;
        bounds += prices.bound;
        reached += priced.deficit < deadline.deficit ? priced.deficit : deadline.deficit;
        clv_prices_finish(&prices);
        clv_workload_finish(&t.w);
    }
    assert_int_equal(wrong, 0);
    assert_true(10 * reached <= 11 * optimum);
    assert_true(bounds >= 0.9 * (double)optimum);
}

/** Nothing is loaded before frame 0, so only the maps of frame 0 can be too coarse. */
static void without_limits_only_the_first_frame_is_too_coarse(void **state)
{
    (void)state;
    uint32_t wrong = 0;
    struct limits limits = {UINT64_MAX, 1000, 0, false};
    for (uint32_t i = 0; i < CASES; i++) {
        struct tiny t;
        tiny_init(&t, NODES);
        struct outcome deadline = clv_schedule(&t.w, &limits, NULL, NULL);
        struct prices prices;
        clv_prices_find(&prices, &t.w, &limits, deadline.deficit, 20, 1e6);
        struct outcome priced = clv_schedule(&t.w, &limits, &prices, NULL);
        struct contents empty = {0};
        uint64_t first = sample_tiny(&t, 0, &empty),
                 distinct = clv_belady(&t.w, UINT64_MAX).distinct;
        wrong += deadline.deficit != first || priced.deficit != first ||
                 fabs(prices.bound - (double)first) > 1e-6 || deadline.uploads > distinct ||
                 priced.uploads > distinct;
        clv_prices_finish(&prices);
        clv_workload_finish(&t.w);
    }
    assert_int_equal(wrong, 0);
}

static void no_schedule_beats_the_optimum_and_no_bound_exceeds_it(void **state)
{
    (void)state;
    check_optimum(false);
    check_optimum(true);
}

static void schedules_keep_to_the_limits_and_their_deficits_add_up(void **state)
{
    (void)state;
    check_legal(false);
    check_legal(true);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(belady_needs_no_more_uploads_than_the_best_of_all),
        cmocka_unit_test(belady_tells_how_much_an_instant_exceeds_the_cap),
        cmocka_unit_test(no_schedule_beats_the_optimum_and_no_bound_exceeds_it),
        cmocka_unit_test(schedules_keep_to_the_limits_and_their_deficits_add_up),
        cmocka_unit_test(without_limits_only_the_first_frame_is_too_coarse),
    };
    return RUN_TESTS(tests);
}
