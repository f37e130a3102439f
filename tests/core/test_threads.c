#define _POSIX_C_SOURCE 200112L /* pthread_barrier_t */
#include "core/fixture.h"

#include <pthread.h>
#include <sched.h>

enum { THREAD_COUNT = 4, TEXTURE_COUNT = 5, ROUND_COUNT = 200 };

static uint64_t mix(uint64_t h, uint64_t value)
{
    h = (h ^ value) * 0x9E3779B97F4A7C15u;
    return h ^ h >> 29;
}

struct reader {
    const SluiceStreamedTextureManager *manager;
    const SluiceTextureId *ids;
    pthread_barrier_t *start; ///< NULL: nobody to wait for
    uint64_t hash;            ///< out: of all that was read
    uint32_t errors;          ///< out
};

/* Every call that takes a const manager. No checks of cmocka: they belong to the main thread. */
static void read_once(struct reader *r, SluiceTextureId id)
{
    const SluiceStreamedTextureManager *m = r->manager;
    SluiceStreamedTextureLayout layout = {sizeof layout, {0}};
    SluiceStreamedTextureStatistics statistics = {.structSize = sizeof statistics};
    uint32_t heap_count = 64, heaps[64] = {0};
    uint8_t map[256] = {0};
    r->errors += sluiceGetTextureLayout(m, id, &layout) != SLUICE_SUCCESS;
    r->errors += sluiceGetStatistics(m, &statistics) != SLUICE_SUCCESS;
    r->errors += sluiceGetEmptyHeaps(m, &heap_count, heaps) != SLUICE_SUCCESS;
    r->errors += sluiceWriteMinMipData(m, id, 16, sizeof map, map) != SLUICE_SUCCESS;
    SluiceMinMipRect rect = {id, 1, 1, 2, 2};
    r->errors += sluiceWriteMinMipRect(m, &rect, 16, 32, map + 128) != SLUICE_SUCCESS;
    for (uint32_t i = 0; i < sizeof map; i++)
        r->hash = mix(r->hash, map[i]);
    for (uint32_t i = 0; i < layout.tileCount; i++) {
        SluiceTileState state = SLUICE_TILE_STATE_FREE;
        SluiceTile tile = {0};
        r->errors += sluiceGetTileState(m, id, i, &state, &tile) != SLUICE_SUCCESS;
        r->hash = mix(r->hash, (uint64_t)state << 32 | tile.mipLevel);
    }
    r->hash = mix(r->hash, statistics.mappedTileCount + statistics.hostMemorySize + heap_count);
}

static void *read_all(void *user)
{
    struct reader *r = user;
    if (r->start) /* else the first may be done before the last begins, and nothing overlaps */
        pthread_barrier_wait(r->start);
    for (uint32_t round = 0; round < ROUND_COUNT; round++) {
        read_once(r, r->ids[round % TEXTURE_COUNT]);
        sched_yield(); /* so that they do on a single core too */
    }
    return NULL;
}

static void calls_on_a_const_manager_may_run_beside_each_other(void **state)
{
    (void)state;
    struct fixture f;
    fixture_open(&f, 16, false);
    SluiceTextureId ids[TEXTURE_COUNT];
    uint64_t random = 4;
    for (uint32_t i = 0; i < TEXTURE_COUNT; i++) {
        SluiceStreamedTextureDesc desc = full_chain(1000 + 100 * i, 700, 128, 128);
        ids[i] = fixture_add(&f, &desc);
        if (i == 4)
            continue; /* never sampled */
        uint8_t map[256];
        for (uint32_t r = 0; r < sizeof map; r++)
            map[r] = next_random(&random) % 4;
        fixture_feed_map(&f, ids[i], map, i, 10);
        CHECK_OK(fixture_to_map(&f, ids[i]));
        if (i != 2)
            fixture_answer_mapped(&f);
    }
    struct reader readers[THREAD_COUNT + 1];
    pthread_t threads[THREAD_COUNT];
    pthread_barrier_t start;
    assert_int_equal(pthread_barrier_init(&start, NULL, THREAD_COUNT), 0);
    for (uint32_t i = 0; i <= THREAD_COUNT; i++)
        readers[i] = (struct reader){f.manager, ids, i < THREAD_COUNT ? &start : NULL, 1, 0};
    for (uint32_t i = 0; i < THREAD_COUNT; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, read_all, &readers[i]), 0);
    for (uint32_t i = 0; i < THREAD_COUNT; i++)
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    pthread_barrier_destroy(&start);
    read_all(&readers[THREAD_COUNT]); /* alone */
    for (uint32_t i = 0; i <= THREAD_COUNT; i++) {
        assert_int_equal(readers[i].errors, 0);
        assert_true(readers[i].hash == readers[THREAD_COUNT].hash);
    }
    fixture_close(&f);
}

/* Runs a manager from start to end. Returns a hash of its decisions. */
static void *live_alone(void *user)
{
    uint64_t *hash = user;
    struct fixture f;
    fixture_open(&f, 8, true);
    f.heaps.limit = 6;
    fixture_configure(&f, 4, 0, 2, 3);
    SluiceStreamedTextureDesc desc = full_chain(1025, 513, 128, 128);
    SluiceTextureId ids[3] = {fixture_add(&f, &desc), fixture_add_small(&f),
                              fixture_add(&f, &desc)};
    uint64_t random = 8;
    for (uint64_t t = 0; t < 100; t++) {
        uint8_t map[64];
        for (uint32_t i = 0; i < sizeof map; i++)
            map[i] = next_random(&random) % 8 ? SLUICE_MIP_UNTOUCHED : next_random(&random) % 4;
        fixture_feed_map(&f, ids[t % 3], map, t, 5);
        CHECK_OK(fixture_to_unmap(&f, SLUICE_ALL_TEXTURES, t));
        CHECK_OK(sluiceCompleteRetireValue(f.manager, t));
        assert_true(fixture_to_map(&f, SLUICE_ALL_TEXTURES) >= 0);
        fixture_answer_mapped(&f);
        *hash = mix(*hash, fixture_digest(&f, 3, ids));
    }
    fixture_close(&f);
    return NULL;
}

static void managers_of_different_threads_share_nothing(void **state)
{
    (void)state;
    uint64_t hashes[THREAD_COUNT + 1] = {0};
    pthread_t threads[THREAD_COUNT];
    for (uint32_t i = 0; i < THREAD_COUNT; i++)
        assert_int_equal(pthread_create(&threads[i], NULL, live_alone, &hashes[i]), 0);
    for (uint32_t i = 0; i < THREAD_COUNT; i++)
        assert_int_equal(pthread_join(threads[i], NULL), 0);
    live_alone(&hashes[THREAD_COUNT]);
    for (uint32_t i = 0; i < THREAD_COUNT; i++)
        assert_true(hashes[i] == hashes[THREAD_COUNT]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_on_a_const_manager_may_run_beside_each_other),
        cmocka_unit_test(managers_of_different_threads_share_nothing),
    };
    return RUN_TESTS(tests);
}
