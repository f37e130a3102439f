/* A demand loader on a device is recorded; the recording is played without one. */
#include "device/demand_runner.h"

#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/replay.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* Records a run in which one launch in five is abandoned. */
static SluiceDemandStatistics record(const SluiceDemandLoaderCreateInfo *create,
                                     void (*run)(struct runner *, struct runner_image *),
                                     struct runner_image *images, uint32_t image_count)
{
    struct runner r;
    SluiceRecorder *recorder;
    const SluiceFileRecordingInfo recording = {.structSize = sizeof recording, .pPath = path};
    h.abandon_one_in = 5;
    runner_init(&r, &h, create);
    CHECK_OK(sluiceBeginDemandRecording(r.loader, &recording, &recorder));
    run(&r, images);
    CHECK_OK(sluiceEndRecording(recorder));
    SluiceDemandStatistics statistics = runner_statistics(&r);
    h.abandon_one_in = 0;
    runner_finish(&r);
    for (uint32_t i = 0; i < image_count; i++)
        runner_image_finish(&images[i]);
    return statistics;
}

/* Plays the recording, which must not diverge, and removes it. */
static SluiceReplayResult replay(void)
{
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    SluiceReplayInfo info = {.structSize = sizeof info, .size = 0};
    void *data = read_file(&info.size);
    info.pData = data;
    CHECK_OK(sluiceReplay(&info, &replayed));
    free(data);
    remove(path);
    assert_int_equal(replayed.divergedEvent, 0);
    assert_true(replayed.decisionHash == replayed.recordedHash);
    return replayed;
}

static void a_recorded_run_replays_to_the_same_decisions(void **state)
{
    (void)state;
    struct runner_image images[IMAGES];
    const SluiceDemandLoaderCreateInfo small = {.structSize = sizeof small,
                                                .memoryBudget = 4 << 20};
    SluiceDemandStatistics statistics = record(&small, render, images, IMAGES);
    SluiceReplayResult replayed = replay();
    assert_int_equal(replayed.kind, SLUICE_TRACE_KIND_DEMAND_RECORDING);
    assert_int_equal(replayed.demand.launchCount, 24);
    assert_int_equal(replayed.demand.loadCount + statistics.texturesOpened, statistics.servedCount);
    assert_true(replayed.demand.evictedCount >= statistics.evictedCount);
    assert_true(statistics.evictedCount > 20); /* or the run shows little */
}

enum { SMALL = 300, SMALL_SIZE = 64, SMALL_STEP = 20, SMALL_LAUNCHES = 60 };

/* More mip tails than 4 MiB hold: textures are forgotten for others, by age, and opened again. */
static void render_small(struct runner *r, struct runner_image *images)
{
    SluiceDemandTextureId ids[SMALL];
    for (uint32_t i = 0; i < SMALL; i++) {
        runner_image_init(&images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, SMALL_SIZE, SMALL_SIZE, i);
        ids[i] = runner_add_texture(r, &images[i]);
    }
    for (uint32_t launch = 0; launch < SMALL_LAUNCHES; launch++) {
        runner_clear(r);
        for (uint32_t i = 0; i < SMALL_STEP; i++)
            runner_add_texel(r, ids[(launch / 3 * SMALL_STEP + i) % SMALL], SMALL_SIZE, SMALL_SIZE,
                             1, i, 5);
        runner_launch(r);
        CHECK_OK(sluiceWaitDemandTicket(r->loader, r->ticket, UINT64_MAX, NULL));
    }
}

static void forgotten_textures_replay_to_the_same_decisions(void **state)
{
    (void)state;
    static struct runner_image images[SMALL];
    for (uint32_t age = 0; age <= 5; age += 5) {
        const SluiceDemandLoaderCreateInfo small = {
            .structSize = sizeof small, .memoryBudget = 4 << 20, .forgetAfterLaunches = age};
        SluiceDemandStatistics statistics = record(&small, render_small, images, SMALL);
        SluiceReplayResult replayed = replay();
        assert_int_equal(replayed.demand.launchCount, SMALL_LAUNCHES);
        assert_int_equal(statistics.refusedCount, 0);
        assert_true(statistics.texturesForgotten > SMALL / 2);
    }
}

static SluiceResult read_bytes(void *user, uint32_t page, uint32_t size, void *bytes)
{
    (void)user;
    memset(bytes, (int)page, size);
    return page % 17 == 3 ? SLUICE_ERROR_UNSUPPORTED : SLUICE_SUCCESS;
}

/* Pages of two sizes that take each other's memory, and of a resource that is answered. */
static void use_resources(struct runner *r)
{
    SluiceDemandResourceId ids[3];
    uint32_t first[3], missed[64];
    for (uint32_t i = 0; i < 3; i++) {
        const SluiceDemandResourceCreateInfo info = {.structSize = sizeof info,
                                                     .pageCount = 5000,
                                                     .maxResidentPageCount = i == 2 ? 20 : 0,
                                                     .pageSize = i == 2 ? 0 : 3000 + 200000 * i,
                                                     .pfnRead = i == 2 ? NULL : read_bytes};
        CHECK_OK(sluiceAddDemandResource(r->loader, &info, &ids[i], &first[i]));
    }
    CHECK_OK(sluiceSetDemandPageValue(r->loader, ids[2], 4999, 1, true));
    for (uint32_t launch = 0; launch < 24; launch++) {
        uint32_t count = 64, kind = launch / 8 % 2;
        runner_clear(r);
        for (uint32_t i = 0; i < (kind ? 8 : 600); i++)
            runner_add_page(r, first[kind] + launch / 2 * 5 + i);
        for (uint32_t i = 0; i < 6; i++)
            runner_add_page(r, first[2] + launch * 3 + i);
        runner_launch(r);
        CHECK_OK(sluiceWaitDemandTicket(r->loader, r->ticket, UINT64_MAX, NULL));
        CHECK_OK(sluiceGetMissedDemandPages(r->loader, ids[2], &count, missed));
        for (uint32_t i = 0; i < count; i += 2)
            CHECK_OK(sluiceSetDemandPageValue(r->loader, ids[2], missed[i], launch, false));
        if (launch % 5 == 4)
            CHECK_OK(sluiceInvalidateDemandPages(r->loader, ids[2], 0, 4000));
    }
}

static void byte_pages_and_answers_replay_to_the_same_decisions(void **state)
{
    (void)state;
    struct runner r;
    SluiceRecorder *recorder;
    SluiceReplayResult replayed = {.structSize = sizeof replayed};
    const SluiceDemandLoaderCreateInfo small = {
        .structSize = sizeof small, .memoryBudget = 8 << 20, .byteMemoryBudget = 2 << 20};
    const SluiceFileRecordingInfo recording = {.structSize = sizeof recording, .pPath = path};
    h.abandon_one_in = 5;
    h.quiet = true; /* reads fail */
    runner_init(&r, &h, &small);
    CHECK_OK(sluiceBeginDemandRecording(r.loader, &recording, &recorder));
    use_resources(&r);
    CHECK_OK(sluiceEndRecording(recorder));
    SluiceDemandStatistics statistics = runner_statistics(&r);
    runner_finish(&r);
    h.quiet = false;
    h.abandon_one_in = 0;

    SluiceReplayInfo info = {.structSize = sizeof info, .size = 0};
    void *data = read_file(&info.size);
    info.pData = data;
    CHECK_OK(sluiceReplay(&info, &replayed));
    free(data);
    remove(path);
    assert_int_equal(replayed.divergedEvent, 0);
    assert_true(replayed.decisionHash == replayed.recordedHash);
    assert_int_equal(replayed.demand.launchCount, 24);
    assert_true(statistics.evictedCount > 100); /* or the run shows little */
}

static void a_loader_that_is_recorded_is_not_recorded_again(void **state)
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
        cmocka_unit_test(forgotten_textures_replay_to_the_same_decisions),
        cmocka_unit_test(byte_pages_and_answers_replay_to_the_same_decisions),
        cmocka_unit_test(a_loader_that_is_recorded_is_not_recorded_again),
        cmocka_unit_test(a_recording_survives_every_refused_allocation),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
