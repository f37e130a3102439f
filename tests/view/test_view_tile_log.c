#include "support/test.h"

#include "tile_log.h"

static struct tile_log make_log(SluiceTextureId id, uint32_t tiles)
{
    struct tile_log log = {0};
    assert_true(tile_log_create(&id, &tiles, 1, &log));
    return log;
}

static void take(struct tile_log *log, uint32_t tile, uint64_t time, SluiceTileState from,
                 SluiceTileState to, SluiceTileEventReason reason)
{
    const SluiceTileEvent event = {.textureId = 5,
                                   .timeStamp = time,
                                   .mark = time / 10,
                                   .tileIndex = tile,
                                   .from = from,
                                   .to = to,
                                   .reason = reason};
    tile_log_take(log, &event, 1000);
}

static void load(struct tile_log *log, uint32_t tile, uint64_t requested, uint64_t loaded)
{
    take(log, tile, requested, SLUICE_TILE_STATE_FREE, SLUICE_TILE_STATE_REQUESTED,
         SLUICE_TILE_EVENT_FEEDBACK);
    take(log, tile, requested, SLUICE_TILE_STATE_REQUESTED, SLUICE_TILE_STATE_ALLOCATED,
         SLUICE_TILE_EVENT_LISTED);
    take(log, tile, loaded, SLUICE_TILE_STATE_ALLOCATED, SLUICE_TILE_STATE_MAPPED,
         SLUICE_TILE_EVENT_ANSWERED);
}

static void a_load_that_nothing_requests_afterwards_is_stale(void **state)
{
    (void)state;
    struct tile_log log = make_log(5, 8);
    load(&log, 1, 100, 200);
    take(&log, 1, 1200, SLUICE_TILE_STATE_MAPPED, SLUICE_TILE_STATE_STANDBY,
         SLUICE_TILE_EVENT_FEEDBACK); /* last seen at 200 or before */
    assert_int_equal(log.stale, 1);
    load(&log, 2, 100, 200);
    take(&log, 2, 1201, SLUICE_TILE_STATE_MAPPED, SLUICE_TILE_STATE_STANDBY,
         SLUICE_TILE_EVENT_FEEDBACK);
    load(&log, 3, 100, 200);
    take(&log, 3, 201, SLUICE_TILE_STATE_MAPPED, SLUICE_TILE_STATE_STANDBY,
         SLUICE_TILE_EVENT_EVICTED);
    assert_int_equal(log.stale, 1);
    take(&log, 4, 300, SLUICE_TILE_STATE_CANCELED, SLUICE_TILE_STATE_STANDBY,
         SLUICE_TILE_EVENT_ANSWERED); /* arrives after it was canceled */
    assert_int_equal(log.stale, 2);
    assert_int_equal(log.loads, 4);
    tile_log_destroy(&log);
}

static void loads_failures_and_waits_are_counted(void **state)
{
    (void)state;
    struct tile_log log = make_log(5, 8);
    for (uint32_t i = 0; i < 100; i++) /* waits of 0 to 99 frames */
        load(&log, i % 8, 10000 * i, 10000 * i + 10 * i);
    assert_int_equal(tile_log_get(&log, 5, 3)->loads, 13); /* 3, 11, ..., 99 */
    assert_int_equal(tile_log_get(&log, 5, 3)->loaded_time, 10000 * 99 + 990);
    assert_int_equal(tile_log_wait(&log, 0.5), 49);
    assert_int_equal(tile_log_wait(&log, 0.99), 98);
    take(&log, 3, 2000000, SLUICE_TILE_STATE_ALLOCATED, SLUICE_TILE_STATE_FAILED,
         SLUICE_TILE_EVENT_ANSWERED);
    assert_int_equal(tile_log_get(&log, 5, 3)->failures, 1);
    assert_null(tile_log_get(&log, 5, 8));
    assert_null(tile_log_get(&log, 6, 0));
    tile_log_destroy(&log);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_load_that_nothing_requests_afterwards_is_stale),
        cmocka_unit_test(loads_failures_and_waits_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
