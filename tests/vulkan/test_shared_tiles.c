/* The directory of shared tiles against a list that is searched from end to end. */
#include "vulkan/shared_tiles.h"

#include "support/failing_allocator.h"
#include "support/roll.h"
#include "support/test.h"

enum { KEYS = 48 };

struct model {
    struct failing_allocator memory;
    struct slc_shared_tiles tiles;
    struct slc_tile_key keys[KEYS];
    uint32_t listed[KEYS];       ///< entry of each key; SLC_NONE: none
    uint32_t unlisted[4 * KEYS]; ///< entries that are not found any more
    uint32_t unlisted_count, live_count, most;
};

static const SluiceImageSource *source_of(uint32_t number)
{
    static char sources[4];
    return (const SluiceImageSource *)(const void *)&sources[number];
}

/* The state of the hash of shared_tiles.c before the last part of a key. */
static uint64_t mix(const SluiceImageSource *source, uint32_t layer, uint32_t level)
{
    const uint64_t parts[] = {(uint64_t)(uintptr_t)source, (uint64_t)layer << 32 | level};
    uint64_t hash = 0x243F6A8885A308D3u;
    for (int i = 0; i < 2; i++) {
        hash = (hash ^ parts[i]) * 0x9E3779B97F4A7C15u;
        hash ^= hash >> 32;
    }
    return hash;
}

/* Eight keys at a time have one hash, so that entries are chained. */
static void make_keys(struct model *m)
{
    for (uint32_t i = 0; i < KEYS; i++) {
        struct slc_tile_key *key = &m->keys[i];
        *key = (struct slc_tile_key){source_of(i & 1), i >> 1 & 1, i >> 2 & 1, i / 8, 7};
        uint64_t last = ((uint64_t)key->x << 32 | key->y) ^ mix(source_of(0), 0, 0) ^
                        mix(key->source, key->layer, key->level);
        key->x = (uint32_t)(last >> 32);
        key->y = (uint32_t)last;
    }
}

static void init(struct model *m)
{
    *m = (struct model){.tiles.free = SLC_NONE};
    failing_allocator_init(&m->memory, UINT64_MAX);
    make_keys(m);
    for (uint32_t i = 0; i < KEYS; i++)
        m->listed[i] = SLC_NONE;
}

static void finish(struct model *m)
{
    slc_shared_tiles_finish(&m->tiles, &m->memory.callbacks);
    assert_int_equal(m->memory.live_bytes, 0);
}

/* The entries of a source are chained, all of them and no others. */
static void check_source(const struct model *m, const SluiceImageSource *source)
{
    uint32_t expected = 0, count = 0, before = SLC_NONE;
    for (uint32_t i = 0; i < KEYS; i++)
        expected += m->listed[i] != SLC_NONE && m->keys[i].source == source;
    for (uint32_t i = slc_shared_tiles_first_of(&m->tiles, source); i != SLC_NONE;
         i = m->tiles.entries[i].after) {
        assert_true(m->tiles.entries[i].listed && m->tiles.entries[i].key.source == source);
        assert_int_equal(m->tiles.entries[i].before, before);
        before = i;
        assert_in_range(++count, 1, expected);
    }
    assert_int_equal(count, expected);
}

static void check(const struct model *m)
{
    for (uint32_t i = 0; i < 3; i++)
        check_source(m, source_of(i));
    for (uint32_t i = 0; i < KEYS; i++)
        assert_int_equal(slc_shared_tiles_find(&m->tiles, &m->keys[i]), m->listed[i]);
    for (uint32_t i = 0; i < m->unlisted_count; i++)
        assert_false(m->tiles.entries[m->unlisted[i]].listed);
    assert_in_range(m->tiles.high, m->live_count, m->most);
}

static void add(struct model *m, uint32_t key)
{
    m->listed[key] = slc_shared_tiles_add(&m->tiles, &m->memory.callbacks, &m->keys[key]);
    assert_true(m->listed[key] != SLC_NONE);
    m->live_count++;
    m->most = m->live_count > m->most ? m->live_count : m->most;
}

static void end(struct model *m, uint32_t entry)
{
    slc_shared_tiles_remove(&m->tiles, entry);
    m->live_count--;
}

static void step(struct model *m)
{
    uint32_t key = (uint32_t)roll() % KEYS;
    uint32_t entry = m->listed[key];
    if (entry == SLC_NONE) {
        add(m, key);
    } else if (roll() % 2) {
        end(m, entry);
        m->listed[key] = SLC_NONE;
    } else if (m->unlisted_count < 4 * KEYS) {
        slc_shared_tiles_unlist(&m->tiles, entry);
        slc_shared_tiles_unlist(&m->tiles, entry); /* no more than once */
        m->unlisted[m->unlisted_count++] = entry;
        m->listed[key] = SLC_NONE;
    }
    if (m->unlisted_count && roll() % 3 == 0) {
        uint32_t at = (uint32_t)roll() % m->unlisted_count;
        end(m, m->unlisted[at]);
        m->unlisted[at] = m->unlisted[--m->unlisted_count];
    }
}

static void each_key_finds_its_own_entry(void **state)
{
    (void)state;
    static struct model m;
    init(&m);
    roll_seed(91);
    for (int i = 0; i < 20000; i++) {
        step(&m);
        check(&m);
    }
    assert_in_range(m.most, 20, 5 * KEYS);
    finish(&m);
}

static void tiles_that_are_going_are_counted_until_they_are_removed(void **state)
{
    (void)state;
    static struct model m;
    init(&m);
    add(&m, 0);
    add(&m, 1);
    m.tiles.entries[m.listed[0]].going = true;
    m.tiles.going_count++;
    end(&m, m.listed[1]);
    assert_int_equal(m.tiles.going_count, 1);
    end(&m, m.listed[0]);
    assert_int_equal(m.tiles.going_count, 0);
    finish(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_key_finds_its_own_entry),
        cmocka_unit_test(tiles_that_are_going_are_counted_until_they_are_removed),
    };
    return RUN_TESTS(tests);
}
