#include "demand/page_space.h"

#include "demand/random.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/shared/demand.h>

#include <stdlib.h>
#include <string.h>

#define SECTION SLUICE_DEMAND_SECTION_PAGES
#define BLOCK SLUICE_DEMAND_BLOCK_PAGES
#define SECTION_BLOCKS (SECTION / BLOCK)

/* The naive model: an owner per block and a rank per section. */
enum { SECTIONS = 40, BLOCKS = SECTIONS * SECTION_BLOCKS, RANGES = 600, NOBODY = -1 };

struct range {
    uint32_t first, count, rank;
    uint64_t launch; /* launch after which the freed range can be reused; else 0 */
    bool used;
};

struct model {
    int owners[BLOCKS];
    uint32_t ranks[SECTIONS];
    struct range ranges[RANGES];
    uint64_t used, end, launch, completed;
};

static uint32_t blocks_of(uint32_t count)
{
    return (count + BLOCK - 1) / BLOCK;
}

static uint32_t free_blocks(const struct model *m, uint32_t section)
{
    uint32_t free = 0;
    for (uint32_t b = 0; b < SECTION_BLOCKS; b++)
        free += m->owners[section * SECTION_BLOCKS + b] == NOBODY;
    return free;
}

static uint32_t longest_run(const struct model *m, uint32_t section)
{
    uint32_t longest = 0, length = 0;
    for (uint32_t b = 0; b < SECTION_BLOCKS; b++) {
        length = m->owners[section * SECTION_BLOCKS + b] == NOBODY ? length + 1 : 0;
        longest = length > longest ? length : longest;
    }
    return longest;
}

/* Rule of page_space.h: needs free consecutive sections, or room within a section of the rank. */
static bool is_possible(const struct model *m, uint32_t rank, uint32_t count)
{
    uint32_t blocks = blocks_of(count), in_a_row = 0;
    uint32_t sections = (blocks + SECTION_BLOCKS - 1) / SECTION_BLOCKS;
    for (uint32_t s = 0; s < SECTIONS; s++) {
        bool empty = free_blocks(m, s) == SECTION_BLOCKS;
        in_a_row = empty ? in_a_row + 1 : 0;
        if (in_a_row == sections)
            return true;
        if (blocks < SECTION_BLOCKS && !empty && m->ranks[s] == rank && longest_run(m, s) >= blocks)
            return true;
    }
    return false;
}

static void allocate(struct slc_page_space *space, struct model *m, int index, uint32_t rank,
                     uint32_t count)
{
    uint32_t first;
    SluiceResult result = slc_page_space_allocate(space, rank, count, &first);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return;
    CHECK_RESULT(result,
                 is_possible(m, rank, count) ? SLUICE_SUCCESS : SLUICE_ERROR_LIMIT_EXCEEDED);
    if (result != SLUICE_SUCCESS)
        return;
    assert_int_equal(first % BLOCK, 0);
    for (uint32_t b = first / BLOCK; b < first / BLOCK + blocks_of(count); b++) {
        assert_true(b < BLOCKS);
        assert_int_equal(m->owners[b], NOBODY);
        if (free_blocks(m, b / SECTION_BLOCKS) == SECTION_BLOCKS)
            m->ranks[b / SECTION_BLOCKS] = rank;
        assert_int_equal(m->ranks[b / SECTION_BLOCKS], rank);
        m->owners[b] = index;
    }
    m->ranges[index] = (struct range){first, count, rank, 0, true};
    m->used += count;
    m->end = m->end > first + count ? m->end : first + count;
}

static void free_range(struct slc_page_space *space, struct model *m, int index)
{
    struct range *r = &m->ranges[index];
    r->launch = m->launch;
    slc_page_space_free(space, r->first, r->count, r->launch);
    m->used -= r->count;
}

static void complete(struct slc_page_space *space, struct model *m)
{
    slc_page_space_complete(space, m->completed);
    for (int i = 0; i < RANGES; i++) {
        struct range *r = &m->ranges[i];
        if (!r->used || r->launch == 0 || r->launch > m->completed)
            continue;
        for (uint32_t b = r->first / BLOCK; b < r->first / BLOCK + blocks_of(r->count); b++)
            m->owners[b] = NOBODY;
        r->used = false;
    }
}

static uint32_t random_count(uint64_t *random)
{
    switch (random_below(random, 8)) {
    case 0: return 1 + random_below(random, 6 * SECTION);
    case 1: return SECTION * (1 + random_below(random, 3));
    case 2: return 1 + random_below(random, SECTIONS * SECTION);
    default: return 1 + random_below(random, SECTION);
    }
}

static void check_ranks(struct slc_page_space *space, const struct model *m, uint8_t *mirror)
{
    uint32_t first, count;
    const uint8_t *ranks = slc_page_space_ranks(space);
    if (slc_page_space_take_changes(space, &first, &count))
        memcpy(mirror + first, ranks + first, count);
    for (uint32_t s = 0; s < SECTIONS; s++) {
        assert_int_equal(ranks[s], m->ranks[s]);
        assert_int_equal(mirror[s],
                         m->ranks[s]); /* ranks outside the reported range have not changed */
    }
}

static void random_calls(uint64_t seed, uint64_t refuse_from)
{
    struct failing_allocator a;
    failing_allocator_init(&a, UINT64_MAX);
    struct slc_page_space *space;
    CHECK_OK(slc_page_space_create(&a.callbacks, SECTIONS * SECTION, &space));
    a.refuse_from = refuse_from == UINT64_MAX ? UINT64_MAX : a.calls + refuse_from;
    struct model m = {.launch = 1};
    memset(m.owners, 0xFF, sizeof m.owners);
    uint8_t mirror[SECTIONS] = {0};
    for (uint32_t step = 0; step < 4000; step++) {
        int index = (int)random_below(&seed, RANGES);
        struct range *r = &m.ranges[index];
        if (!r->used)
            allocate(space, &m, index, random_below(&seed, SLUICE_DEMAND_RANKS),
                     random_count(&seed));
        else if (r->launch == 0)
            free_range(space, &m, index);
        if (random_below(&seed, 4) == 0)
            m.launch++;
        if (random_below(&seed, 8) == 0) {
            m.completed = m.launch - random_below(&seed, 3);
            complete(space, &m);
        }
        if (a.calls > a.refuse_from && random_below(&seed, 4) == 0)
            a.refuse_from = a.calls + 1;
        assert_int_equal(slc_page_space_used(space), m.used);
        assert_int_equal(slc_page_space_end(space), m.end);
        check_ranks(space, &m, mirror);
    }
    slc_page_space_destroy(space);
    assert_int_equal(a.live_count, 0);
}

static void random_ranges_agree_with_a_naive_model(void **state)
{
    (void)state;
    for (uint64_t seed = 1; seed <= 12; seed++)
        random_calls(seed * 7919, UINT64_MAX);
}

static void nothing_changes_when_memory_runs_out(void **state)
{
    (void)state;
    for (uint64_t n = 0; n < 5; n++)
        random_calls(n + 99, n);
}

static void creation_survives_every_allocation_failure(void **state)
{
    (void)state;
    for (uint64_t n = 0;; n++) {
        struct failing_allocator a;
        failing_allocator_init(&a, n);
        struct slc_page_space *space;
        SluiceResult result = slc_page_space_create(&a.callbacks, 10 * SECTION, &space);
        if (result == SLUICE_SUCCESS)
            slc_page_space_destroy(space);
        assert_int_equal(a.live_count, 0);
        if (result == SLUICE_SUCCESS)
            break;
        CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
}

static void a_range_may_be_as_large_as_the_capacity(void **state)
{
    (void)state;
    const uint64_t capacity = UINT64_C(1) << 31;
    struct slc_page_space *space;
    CHECK_OK(slc_page_space_create(NULL, capacity, &space));
    uint32_t first = 1;
    CHECK_RESULT(slc_page_space_allocate(space, 3, capacity + 1, &first),
                 SLUICE_ERROR_LIMIT_EXCEEDED);
    CHECK_RESULT(slc_page_space_allocate(space, 3, UINT64_MAX, &first),
                 SLUICE_ERROR_LIMIT_EXCEEDED);
    CHECK_OK(slc_page_space_allocate(space, 3, capacity, &first));
    assert_int_equal(first, 0);
    assert_int_equal(slc_page_space_end(space), capacity);
    assert_int_equal(slc_page_space_ranks(space)[capacity / SECTION - 1], 3);
    CHECK_RESULT(slc_page_space_allocate(space, 3, 1, &first), SLUICE_ERROR_LIMIT_EXCEEDED);
    slc_page_space_free(space, 0, capacity, 5);
    slc_page_space_complete(space, 5);
    CHECK_OK(slc_page_space_allocate(space, 1, capacity - BLOCK, &first));
    CHECK_OK(slc_page_space_allocate(space, 1, 1, &first));
    assert_int_equal(first, INT32_MAX - BLOCK + 1); /* the last block of all */
    slc_page_space_destroy(space);
}

static void a_freed_range_waits_for_its_launch(void **state)
{
    (void)state;
    struct slc_page_space *space;
    CHECK_OK(slc_page_space_create(NULL, SECTION, &space));
    uint32_t first;
    CHECK_OK(slc_page_space_allocate(space, 0, SECTION, &first));
    slc_page_space_free(space, first, SECTION, 7);
    assert_int_equal(slc_page_space_used(space), 0);
    slc_page_space_complete(space, 6);
    CHECK_RESULT(slc_page_space_allocate(space, 0, 1, &first), SLUICE_ERROR_LIMIT_EXCEEDED);
    slc_page_space_complete(space, 7);
    CHECK_OK(slc_page_space_allocate(space, 9, 1, &first));
    assert_int_equal(slc_page_space_ranks(space)[0], 9);
    slc_page_space_destroy(space);
}

/* Tiles of the regular levels of a texture of random size, as texture sets have them. */
static uint32_t level_counts(uint64_t *random, uint32_t *counts)
{
    uint32_t width = 1 + random_below(random, 64), height = 1 + random_below(random, 64), n = 0;
    for (; width > 0 && height > 0 && n < 7; width /= 2, height /= 2)
        counts[n++] = width * height;
    counts[n++] = 1; /* the tail */
    return n;
}

static uint32_t rank_of(uint32_t count)
{
    uint32_t rank = 1;
    for (; count > 1; count = (count + 3) / 4)
        rank++;
    return rank < 15 ? rank : 15;
}

struct owned {
    uint32_t first, count;
};

/* Sections in use: for all ids that exist, and a share for what small ranges leave over. */
static void fragmentation_stays_bounded(void **state)
{
    (void)state;
    enum { TEXTURES = 3000, LEVELS = 8 };
    static struct owned owned[TEXTURES][LEVELS];
    static uint32_t level_count[TEXTURES];
    memset(level_count, 0, sizeof level_count);
    struct slc_page_space *space;
    CHECK_OK(slc_page_space_create(NULL, UINT64_C(1) << 26, &space));
    uint64_t random = 42, blocks = 0, launch = 0, most = 0;
    for (uint32_t step = 0; step < 60000; step++) {
        uint32_t t = step < TEXTURES ? step : random_below(&random, TEXTURES), counts[LEVELS];
        for (uint32_t l = 0; l < level_count[t]; l++) {
            slc_page_space_free(space, owned[t][l].first, owned[t][l].count, launch);
            blocks -= blocks_of(owned[t][l].count);
        }
        slc_page_space_complete(space, launch++);
        level_count[t] = level_counts(&random, counts);
        for (uint32_t l = 0; l < level_count[t]; l++) {
            owned[t][l].count = counts[l];
            CHECK_OK(
                slc_page_space_allocate(space, rank_of(counts[l]), counts[l], &owned[t][l].first));
            blocks += blocks_of(counts[l]);
        }
        most = blocks > most ? blocks : most;
    }
    /* 20 times everything was replaced: ids reach no further than half as far again */
    assert_true(slc_page_space_end(space) <= most * BLOCK * 3 / 2);
    print_message("# ids given / ids in use at most: %.3f\n",
                  (double)slc_page_space_end(space) / (double)(most * BLOCK));
    slc_page_space_destroy(space);
}

static void hundred_thousand_textures_come_and_go(void **state)
{
    (void)state;
    enum { TEXTURES = 100000, RANGES_EACH = 12 };
    uint32_t(*firsts)[RANGES_EACH] = malloc(sizeof(uint32_t[TEXTURES][RANGES_EACH]));
    assert_non_null(firsts);
    struct slc_page_space *space;
    CHECK_OK(slc_page_space_create(NULL, UINT64_C(1) << 30, &space));
    uint64_t end = 0;
    for (uint64_t round = 1; round <= 2; round++) {
        for (uint32_t t = 0; t < TEXTURES; t++)
            for (uint32_t l = 0; l < RANGES_EACH; l++)
                CHECK_OK(slc_page_space_allocate(space, l, 1u << l, &firsts[t][l]));
        assert_int_equal(slc_page_space_used(space), TEXTURES * ((1u << RANGES_EACH) - 1));
        for (uint32_t t = 0; t < TEXTURES; t++)
            for (uint32_t l = 0; l < RANGES_EACH; l++)
                slc_page_space_free(space, firsts[t][l], 1u << l, round);
        slc_page_space_complete(space, round);
        assert_int_equal(slc_page_space_used(space), 0);
        assert_true(end == 0 || slc_page_space_end(space) == end); /* all of it was used again */
        end = slc_page_space_end(space);
    }
    CHECK_OK(slc_page_space_allocate(space, 5, UINT64_C(1) << 30, &firsts[0][0]));
    slc_page_space_destroy(space);
    free(firsts);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_ranges_agree_with_a_naive_model),
        cmocka_unit_test(nothing_changes_when_memory_runs_out),
        cmocka_unit_test(creation_survives_every_allocation_failure),
        cmocka_unit_test(a_range_may_be_as_large_as_the_capacity),
        cmocka_unit_test(a_freed_range_waits_for_its_launch),
        cmocka_unit_test(fragmentation_stays_bounded),
        cmocka_unit_test(hundred_thousand_textures_come_and_go),
    };
    return RUN_TESTS(tests);
}
