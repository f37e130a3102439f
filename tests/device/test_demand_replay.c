/* A demand loader on a device is recorded; the recording is played without one. */
#include "device/demand_runner.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/replay.h>

#include <stdio.h>
#include <stdlib.h>

enum { IMAGES = 3, SIZE = 2048 };

static const char path[] = "test_demand_replay.trace";
static struct harness h;

/* More tiles than 4 MiB hold, launch after launch elsewhere; a texture is replaced on the way. */
static void render(struct runner *r, struct runner_image *images)
{
    SluiceDemandTextureId ids[IMAGES];
    for (uint32_t i = 0; i < IMAGES; i++) {
        runner_image_init(&images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, i);
        ids[i] = runner_add_texture(r, &images[i]);
    }
    for (uint32_t launch = 0; launch < 24; launch++) {
        runner_clear(r);
        for (uint32_t i = 0; i < 30; i++)
            runner_add_texel(r, ids[(launch / 8 + i) % IMAGES], SIZE, SIZE, 0,
                             (launch / 3 * 512 + i * 130) % SIZE, i * 257 % SIZE);
        runner_launch(r);
        CHECK_OK(sluiceWaitDemandTicket(r->loader, r->ticket, UINT64_MAX, NULL));
        if (launch == 12)
            CHECK_OK(sluiceInvalidateDemandTexture(r->loader, ids[0]));
    }
}

static void *read_file(size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    void *data = malloc(*size);
    assert_non_null(data);
    assert_int_equal(fread(data, 1, *size, file), *size);
    fclose(file);
    return data;
}

static void a_recorded_run_replays_to_the_same_decisions(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image images[IMAGES];
    SluiceRecorder *recorder;
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    const SluiceDemandLoaderCreateInfo small = {.structSize = sizeof small,
                                                .memoryBudget = 4 << 20};
    const SluiceFileRecordingInfo recording = {.structSize = sizeof recording, .pPath = path};
    h.abandon_one_in = 5;
    runner_init(&r, &h, &small);
    CHECK_OK(sluiceBeginDemandRecording(r.loader, &recording, &recorder));
    render(&r, images);
    CHECK_OK(sluiceEndRecording(recorder));
    SluiceDemandStatistics statistics = runner_statistics(&r);
    h.abandon_one_in = 0;
    runner_finish(&r);
    for (uint32_t i = 0; i < IMAGES; i++)
        runner_image_finish(&images[i]);

    SluiceReplayInfo info = {.structSize = sizeof info, .size = 0};
    void *data = read_file(&info.size);
    info.pData = data;
    CHECK_OK(sluiceReplay(&info, &replayed));
    free(data);
    remove(path);
    assert_int_equal(replayed.kind, SLUICE_TRACE_KIND_DEMAND_RECORDING);
    assert_int_equal(replayed.divergedEvent, 0);
    assert_true(replayed.decisionHash == replayed.recordedHash);
    assert_int_equal(replayed.demand.launchCount, 24);
    assert_int_equal(replayed.demand.loadCount + statistics.texturesOpened, statistics.servedCount);
    assert_true(replayed.demand.evictedCount >= statistics.evictedCount);
    assert_true(statistics.evictedCount > 20); /* or the run shows little */
}

static void a_loader_that_was_used_is_not_recorded(void **state)
{
    (void)state;
    struct runner r;
    SluiceRecorder *recorder, *second;
    const SluiceFileRecordingInfo recording = {.structSize = sizeof recording, .pPath = path};
    runner_init(&r, &h, NULL);
    CHECK_OK(sluiceBeginDemandRecording(r.loader, &recording, &recorder));
    CHECK_RESULT(sluiceBeginDemandRecording(r.loader, &recording, &second),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    assert_null(second);
    CHECK_OK(sluiceEndRecording(recorder));
    runner_launch(&r);
    CHECK_RESULT(sluiceBeginDemandRecording(r.loader, &recording, &recorder),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    runner_finish(&r);
    remove(path);
}

static void a_recording_survives_every_refused_allocation(void **state)
{
    (void)state;
    struct runner r;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    runner_init(&r, &h, NULL);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        SluiceRecorder *recorder;
        failing_allocator_init(&allocator, n);
        const SluiceFileRecordingInfo recording = {
            .structSize = sizeof recording, .pPath = path, .pAllocator = &allocator.callbacks};
        result = sluiceBeginDemandRecording(r.loader, &recording, &recorder);
        if (result == SLUICE_SUCCESS)
            result = sluiceEndRecording(recorder);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(allocator.live_count, 0);
    }
    runner_finish(&r);
    remove(path);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_recorded_run_replays_to_the_same_decisions),
        cmocka_unit_test(a_loader_that_was_used_is_not_recorded),
        cmocka_unit_test(a_recording_survives_every_refused_allocation),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
