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

/* From the request over the hand-out to the end, of a tile that waits in the queue. */
static void load_late(struct tile_log *log, uint32_t tile, const uint64_t times[3],
                      SluiceTileState end)
{
    take(log, tile, times[0], SLUICE_TILE_STATE_FREE, SLUICE_TILE_STATE_REQUESTED,
         SLUICE_TILE_EVENT_FEEDBACK);
    take(log, tile, times[1], SLUICE_TILE_STATE_REQUESTED, SLUICE_TILE_STATE_ALLOCATED,
         SLUICE_TILE_EVENT_LISTED);
    take(log, tile, times[2], SLUICE_TILE_STATE_ALLOCATED, end, SLUICE_TILE_EVENT_ANSWERED);
}

static void stages_of_a_load_are_queue_and_load(void **state)
{
    (void)state;
    struct tile_log log = {0};
    assert_true(tile_log_add(&log, 5, 8) && tile_log_keep_stages(&log));
    load(&log, 1, 100, 150); /* handed out in the frame of its request, answered 5 frames later */
    load_late(&log, 2, (const uint64_t[]){100, 130, 150}, SLUICE_TILE_STATE_MAPPED);
    load_late(&log, 3, (const uint64_t[]){100, 120, 130}, SLUICE_TILE_STATE_FAILED); /* no load */
    assert_int_equal(log.stages->queue[0], 1);
    assert_int_equal(log.stages->queue[2], 1);
    assert_int_equal(log.stages->queue[3], 1);
    assert_int_equal(log.stages->load[5], 1);
    assert_int_equal(log.stages->load[2], 1);
    assert_int_equal(log.stages->load[1], 0);
    assert_int_equal(tile_log_wait_of(log.stages->load, 0.5), 2);
    assert_int_equal(tile_log_wait_of(log.stages->load, 1.0), 5);
    tile_log_destroy(&log);
}

static void kept_contents_come_back_and_textures_added_since_stay(void **state)
{
    (void)state;
    struct tile_log log = {0};
    struct tile_log_kept kept;
    uint32_t index;
    assert_true(tile_log_add(&log, 5, 8) && tile_log_keep_stages(&log));
    load(&log, 1, 100, 150);
    assert_true(tile_log_keep(&log, &kept));
    assert_true(tile_log_add(&log, 4, 1000)); /* before the other by id, behind it by tiles */
    load(&log, 1, 200, 280);
    load(&log, 3, 200, 280);
    assert_int_equal(log.loads, 3);
    tile_log_restore(&log, &kept);
    assert_int_equal(log.loads, 1);
    assert_int_equal(tile_log_get(&log, 5, 1)->loads, 1);
    assert_int_equal(tile_log_get(&log, 5, 1)->loaded_time, 150);
    assert_int_equal(tile_log_get(&log, 5, 3)->loads, 0);
    assert_int_equal(log.waits[5], 1);
    assert_int_equal(log.waits[8] + log.stages->load[8], 0);
    assert_int_equal(log.stages->load[5], 1);
    assert_true(tile_log_index(&log, 4, &index) && index == 1 && tile_log_get(&log, 4, 999));
    assert_null(tile_log_get(&log, 4, 1000));
    tile_log_kept_finish(&kept);
    tile_log_destroy(&log);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_load_that_nothing_requests_afterwards_is_stale),
        cmocka_unit_test(loads_failures_and_waits_are_counted),
        cmocka_unit_test(stages_of_a_load_are_queue_and_load),
        cmocka_unit_test(kept_contents_come_back_and_textures_added_since_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
