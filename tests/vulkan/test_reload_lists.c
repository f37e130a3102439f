/* Lists of tiles by texture, against a model that walks everything. */
#include "vulkan/reload_lists.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <string.h>

enum { TEXTURES = 7, TILES = 24, SPARE = 4, STEP = 8 };

static uint32_t seed;

static uint32_t draw(uint32_t limit)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) % limit;
}

/* Model of the lists: tiles in the order of addition, textures in the order of their turns. */
struct model {
    uint32_t tiles[TEXTURES][TILES], counts[TEXTURES];
    bool waits[TEXTURES];
    uint64_t due[TEXTURES];
    uint32_t turns[TEXTURES], turn_count; ///< ready ones
};

static bool model_has(const struct model *m, uint32_t texture, uint32_t tile)
{
    for (uint32_t i = 0; i < m->counts[texture]; i++)
        if (m->tiles[texture][i] == tile)
            return true;
    return false;
}

static void model_leave(struct model *m, uint32_t texture)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m->turn_count; i++)
        if (m->turns[i] != texture)
            m->turns[kept++] = m->turns[i];
    m->turn_count = kept;
}

static bool model_is_ready(const struct model *m, uint32_t texture)
{
    for (uint32_t i = 0; i < m->turn_count; i++)
        if (m->turns[i] == texture)
            return true;
    return false;
}

static void model_enter(struct model *m, uint32_t texture)
{
    if (m->counts[texture] && !m->waits[texture] && !model_is_ready(m, texture))
        m->turns[m->turn_count++] = texture;
}

static void model_add(struct model *m, uint32_t texture, uint32_t tile)
{
    if (model_has(m, texture, tile))
        return;
    m->tiles[texture][m->counts[texture]++] = tile;
    model_enter(m, texture);
}

static void check(const struct slc_reload_lists *r, const struct model *m)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < TEXTURES; t++) {
        count += m->counts[t];
        assert_int_equal(slc_reload_lists_count(r, t), m->counts[t]);
        for (uint32_t tile = 0; tile < TILES; tile++)
            assert_int_equal(slc_reload_lists_has(r, t, tile), model_has(m, t, tile));
    }
    assert_int_equal(r->count, count);
    assert_int_equal(r->ready.count, m->turn_count);
}

/* Some tiles of the first texture; it may wait afterwards, and some tiles may come back. */
static void turn(struct slc_reload_lists *r, struct model *m, uint64_t now)
{
    uint32_t texture = slc_reload_lists_begin(r), taken[SPARE];
    assert_int_equal(texture, m->turns[0]);
    uint32_t most = m->counts[texture] < SPARE ? m->counts[texture] : SPARE;
    uint32_t count = 1 + draw(most);
    bool fails = draw(3) == 0;
    model_leave(m, texture);
    for (uint32_t i = 0; i < count; i++) {
        taken[i] = slc_reload_lists_take(r, texture);
        assert_int_equal(taken[i], m->tiles[texture][0]);
        memmove(m->tiles[texture], m->tiles[texture] + 1, --m->counts[texture] * sizeof taken[0]);
    }
    for (uint32_t i = 0; i < count; i++)
        if (draw(2)) {
            slc_reload_lists_add(r, texture, taken[i]);
            m->tiles[texture][m->counts[texture]++] = taken[i];
        }
    if (fails) {
        m->waits[texture] = true;
        m->due[texture] = now + STEP * draw(9) + texture; /* no two are equal */
        slc_reload_lists_wait(r, texture, m->due[texture]);
    }
    slc_reload_lists_end(r, texture);
    model_enter(m, texture);
}

static void wake(struct slc_reload_lists *r, struct model *m, uint64_t now)
{
    slc_reload_lists_wake(r, now);
    for (uint32_t i = 0; i < TEXTURES; i++) {
        uint32_t first = TEXTURES; /* the one due first of those that wait */
        for (uint32_t t = 0; t < TEXTURES; t++)
            if (m->waits[t] && m->counts[t] && now - m->due[t] <= UINT64_MAX / 2 &&
                (first == TEXTURES || m->due[t] - m->due[first] > UINT64_MAX / 2))
                first = t;
        if (first == TEXTURES)
            break;
        m->waits[first] = false;
        model_enter(m, first);
    }
}

/* Time stamps wrap meanwhile. */
static void lists_are_those_of_a_model(void **state)
{
    (void)state;
    struct slc_reload_lists r;
    struct model m = {0};
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    CHECK_OK(slc_reload_lists_init(&r, &memory.callbacks, TEXTURES, SPARE));
    for (uint64_t now = -(uint64_t)STEP * 5000; now != STEP * 15000; now += STEP) {
        uint32_t texture = draw(TEXTURES);
        wake(&r, &m, now);
        switch (draw(8)) {
        case 0:
            if (draw(20) == 0) {
                slc_reload_lists_drop(&r, texture);
                model_leave(&m, texture);
                m.counts[texture] = 0;
                m.waits[texture] = false;
            }
            break;
        case 1:
        case 2:
        case 3:
            CHECK_OK(slc_reload_lists_reserve(&r, 3));
            for (uint32_t i = 0; i < 3; i++) {
                uint32_t tile = draw(TILES);
                slc_reload_lists_add(&r, texture, tile);
                model_add(&m, texture, tile);
            }
            break;
        default:
            if (m.turn_count)
                turn(&r, &m, now);
        }
        check(&r, &m);
    }
    slc_reload_lists_finish(&r);
    assert_int_equal(memory.live_bytes, 0);
}

/* Waiting textures must not be examined one by one: the first one due decides for all. */
static void textures_that_wait_come_when_they_are_due(void **state)
{
    (void)state;
    struct slc_reload_lists r;
    const uint64_t due[] = {40, 10, 30, 20};
    struct failing_allocator memory;
    failing_allocator_init(&memory, UINT64_MAX);
    CHECK_OK(slc_reload_lists_init(&r, &memory.callbacks, 4, 0));
    CHECK_OK(slc_reload_lists_reserve(&r, 4));
    for (uint32_t t = 0; t < 4; t++) {
        slc_reload_lists_add(&r, t, 5);
        slc_reload_lists_wait(&r, t, due[t]);
    }
    static const uint32_t order[] = {1, 3, 2, 0};
    for (uint64_t now = 1; now < 50; now++) {
        slc_reload_lists_wake(&r, now);
        assert_int_equal(r.ready.count, now / 10);
    }
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t texture = slc_reload_lists_begin(&r);
        assert_int_equal(texture, order[i]);
        assert_int_equal(slc_reload_lists_take(&r, texture), 5);
        slc_reload_lists_end(&r, texture);
    }
    assert_int_equal(r.ready.count + r.waiting.count, 0);
    slc_reload_lists_finish(&r);
}

static void refused_allocations_change_nothing(void **state)
{
    (void)state;
    for (uint64_t n = 0; n < 20; n++) {
        struct slc_reload_lists r;
        struct failing_allocator memory;
        failing_allocator_init(&memory, n);
        SluiceResult result = slc_reload_lists_init(&r, &memory.callbacks, 4, 2);
        if (result == SLUICE_SUCCESS)
            result = slc_reload_lists_reserve(&r, 100);
        if (result == SLUICE_SUCCESS)
            for (uint32_t i = 0; i < 100; i++)
                slc_reload_lists_add(&r, i % 4, i);
        else
            assert_true(result == SLUICE_ERROR_OUT_OF_HOST_MEMORY && r.count == 0);
        slc_reload_lists_finish(&r);
        assert_int_equal(memory.live_bytes, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_are_those_of_a_model),
        cmocka_unit_test(textures_that_wait_come_when_they_are_due),
        cmocka_unit_test(refused_allocations_change_nothing),
    };
    return RUN_TESTS(tests);
}
