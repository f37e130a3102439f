/* Textures that are not sampled are forgotten, and return when they are sampled. */
#include "device/crowd.h"

#include "support/failing_allocator.h"
#include "support/fault_source.h"
#include "support/test.h"

#include <stdio.h>
#include <string.h>

enum { SMALL = 64, LARGE = 256, TOGETHER = 40 };

static void set_budget(struct harness *h, uint64_t budget)
{
    CHECK_OK(harness_set_context(h, &(SluiceVulkanContextCreateInfo){.memoryBudget = budget}));
}

static SluiceVulkanStreamerCreateInfo settings(uint32_t count)
{
    return (SluiceVulkanStreamerCreateInfo){.maxTextureCount = count,
                                            .maxRegionCount = 1u << 15,
                                            .feedbackTimeoutTicks = 2,
                                            .numExtraStandbyTiles = 16,
                                            .heapTileCapacity = 16,
                                            .forgetTextures = true};
}

/* Adds textures. Some have regular levels and tiles of them. */
static void add_many(struct crowd *c, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(crowd_add(c, i % 25 == 24 ? LARGE : SMALL, NULL));
}

static void visit_all(struct crowd *c)
{
    for (uint32_t first = 0; first < c->count; first += TOGETHER) {
        c->ranges[0] = (struct crowd_range){first, TOGETHER};
        assert_int_equal(crowd_sharpen(c, 60), 0);
    }
}

static void check_crowd(struct harness *h, uint32_t count, uint64_t budget)
{
    struct crowd c;
    set_budget(h, budget);
    crowd_init(&c, h, settings(count));
    c.budget = budget;
    add_many(&c, count);
    assert_int_equal(crowd_statistics(&c).absentTextureCount, count);
    visit_all(&c);
    visit_all(&c);
    SluiceVulkanStreamerStatistics s = crowd_statistics(&c);
    printf("# %llu times forgotten, %u absent of %u, %llu bytes of tile memory\n",
           (unsigned long long)s.texturesForgotten, s.absentTextureCount, count,
           (unsigned long long)s.tileMemorySize);
    assert_true(s.texturesForgotten >= count);
    assert_int_equal(s.tilesFailed, 0);
    crowd_finish(&c);
    CHECK_OK(harness_set_context(h, NULL));
}

/* Sparse mip tails of 64 x 64 are 7 tiles on lavapipe, and about one or less on GPUs. */
static uint64_t sparse_budget(struct harness *h)
{
    return harness_is_software(h) ? 24u << 20 : 4u << 20;
}

/* Budget for about 150 of the small textures. Pages come in images of several MiB. */
static uint64_t budget_of(struct harness *h)
{
    return h->mode == SLUICE_RESIDENCY_MODE_SPARSE  ? sparse_budget(h)
           : h->mode == SLUICE_RESIDENCY_MODE_PAGED ? 8u << 20
                                                    : 4u << 20;
}

static void many_are_sampled_once_and_again_within_a_budget_for_few(void **state)
{
    struct harness *h = *state;
    check_crowd(h, 400, budget_of(h));
}

static void frames_that_are_abandoned_lose_none(void **state)
{
    struct harness *h = *state;
    h->abandon_one_in = 3;
    check_crowd(h, 160, h->mode == SLUICE_RESIDENCY_MODE_SPARSE ? sparse_budget(h) : 4u << 20);
    h->abandon_one_in = 0;
}

static void a_sparse_streamer_forgets_small_dense_textures(void **state)
{
    struct harness *h = *state;
    if (h->mode != SLUICE_RESIDENCY_MODE_SPARSE)
        SKIP_TEST("a streamer that chooses its mode is sparse on this device");
    h->leaves_auto = true;
    check_crowd(h, 240, 4u << 20);
    h->leaves_auto = false;
}

static void those_in_view_stay_while_others_come_and_go(void **state)
{
    struct harness *h = *state;
    struct crowd c;
    set_budget(h, budget_of(h));
    crowd_init(&c, h, settings(400));
    add_many(&c, 400);
    c.ranges[0] = (struct crowd_range){0, 10};
    assert_int_equal(crowd_sharpen(&c, 30), 0);
    const uint64_t before = crowd_statistics(&c).texturesForgotten;
    for (uint32_t first = 10; first + 30 <= 400; first += 30) {
        c.ranges[1] = (struct crowd_range){first, 30};
        for (uint32_t i = 0; i < 12; i++) { /* the outputs of the first range come first */
            crowd_frame(&c);
            for (uint32_t k = 0; k < 10; k++)
                assert_int_equal(((const struct CrowdOutput *)c.outputs.mapped)[k].missing, 0);
        }
    }
    assert_true(crowd_statistics(&c).texturesForgotten > before + 100);
    crowd_finish(&c);
    CHECK_OK(harness_set_context(h, NULL));
}

static void age_forgets_while_there_is_memory(void **state)
{
    struct crowd c;
    SluiceVulkanStreamerCreateInfo info = settings(20);
    info.forgetAfterFrames = 8;
    crowd_init(&c, *state, info);
    add_many(&c, 20);
    c.ranges[0] = (struct crowd_range){0, 20};
    assert_int_equal(crowd_sharpen(&c, 30), 0);
    const uint64_t read = crowd_statistics(&c).bytesRead;
    assert_int_equal(crowd_statistics(&c).absentTextureCount, 0);
    c.ranges[0] = (struct crowd_range){0, 5}; /* the others are no longer sampled */
    for (uint32_t i = 0; i < 7; i++)
        assert_int_equal(crowd_frame(&c), 0);
    assert_int_equal(crowd_statistics(&c).absentTextureCount, 0);
    for (uint32_t i = 0; i < 20; i++)
        assert_int_equal(crowd_frame(&c), 0);
    assert_int_equal(crowd_statistics(&c).absentTextureCount, 15);
    assert_true(crowd_statistics(&c).bytesRead == read);
    c.ranges[0].count = 20;
    assert_int_equal(crowd_sharpen(&c, 30), 0);
    assert_int_equal(crowd_statistics(&c).absentTextureCount, 0);
    crowd_finish(&c);
}

static void without_age_and_with_memory_all_stay(void **state)
{
    struct crowd c;
    crowd_init(&c, *state, settings(20));
    add_many(&c, 20);
    c.ranges[0] = (struct crowd_range){0, 20};
    assert_int_equal(crowd_sharpen(&c, 30), 0);
    crowd_rest(&c, 40);
    assert_int_equal(crowd_statistics(&c).texturesForgotten, 0);
    assert_int_equal(crowd_statistics(&c).absentTextureCount, 0);
    crowd_finish(&c);
}

/* Textures are removed in every phase: forgotten, waiting for the image to be destroyed, waiting
 * for texels. */
static void they_can_be_removed_at_any_time(void **state)
{
    SluiceVulkanStreamerCreateInfo info = settings(8);
    info.forgetAfterFrames = 3;
    for (uint32_t phase = 0; phase < 12; phase += 1 + phase / 6) {
        struct crowd c;
        crowd_init(&c, *state, info);
        add_many(&c, 8);
        c.ranges[0] = (struct crowd_range){0, 8};
        if (phase > 0)
            assert_int_equal(crowd_sharpen(&c, 30), 0);
        crowd_rest(&c, phase);
        if (phase > 9)
            crowd_frame(&c);
        for (uint32_t i = 0; i < 8; i++)
            CHECK_OK(sluiceRemoveVulkanTexture(c.streamer, c.members[i].texture.textureId));
        assert_int_equal(crowd_statistics(&c).absentTextureCount, 0);
        crowd_rest(&c, 8);
        assert_int_equal(crowd_statistics(&c).textureCount, 0);
        SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create};
        for (uint32_t i = 0; i < 8; i++) { /* in their place */
            create.source = c.members[i].source;
            CHECK_OK(sluiceAddVulkanTexture(c.streamer, &create, &c.members[i].texture));
            assert_int_equal(c.members[i].texture.tableIndex, i);
        }
        assert_int_equal(crowd_sharpen(&c, 30), 0);
        crowd_finish(&c);
    }
}

static void one_whose_source_fails_shows_the_fallback_until_it_is_read(void **state)
{
    struct harness *h = *state;
    struct crowd c;
    struct fault_source fault;
    SluiceVulkanStreamerCreateInfo info = settings(2);
    info.forgetAfterFrames = 3;
    crowd_init(&c, h, info);
    fault_source_init(&fault, crowd_source(&c.members[0], 0, SMALL));
    CHECK_OK(crowd_add(&c, SMALL, &fault.base));
    c.ranges[0] = (struct crowd_range){0, 1};
    assert_int_equal(crowd_sharpen(&c, 30), 0);
    crowd_rest(&c, 12);
    assert_int_equal(crowd_statistics(&c).absentTextureCount, 1);
    h->quiet = true;
    const uint32_t errors = h->log_count[SLUICE_LOG_ERROR] + h->log_count[SLUICE_LOG_WARNING];
    fault.failure = SLUICE_ERROR_IO;
    fault.fail_at = atomic_load(&fault.read_count) + 1;
    fault.fails_on = true;
    for (uint32_t i = 0; i < 6; i++) /* and every sample is the fallback color */
        assert_int_equal(crowd_frame(&c), 1);
    assert_true(crowd_statistics(&c).tilesFailed > 0);
    assert_true(h->log_count[SLUICE_LOG_ERROR] + h->log_count[SLUICE_LOG_WARNING] > errors);
    fault.fails_on = false;
    CHECK_OK(sluiceRetryVulkanSource(c.streamer, &fault.base));
    h->quiet = false;
    assert_int_equal(crowd_sharpen(&c, 60), 0);
    crowd_finish(&c);
    fault_source_finish(&fault);
}

static void host_memory_that_fails_loses_none(void **state)
{
    struct harness *h = *state;
    struct failing_allocator a;
    struct crowd c;
    failing_allocator_init(&a, UINT64_MAX);
    CHECK_OK(harness_set_context(h, &(SluiceVulkanContextCreateInfo){.pAllocator = &a.callbacks}));
    SluiceVulkanStreamerCreateInfo info = settings(16);
    info.forgetAfterFrames = 2;
    crowd_init(&c, h, info);
    h->quiet = true;
    for (uint64_t n = 0; c.count < 16;) { /* each allocation of adding fails once */
        a.refuse_from = a.calls + n;
        SluiceResult result = crowd_add(&c, c.count % 2 ? LARGE : SMALL, NULL);
        a.refuse_from = UINT64_MAX;
        n = result == SLUICE_SUCCESS ? 0 : n + 1;
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
    for (uint32_t n = 0; n < 12; n++) {
        c.ranges[0] = (struct crowd_range){0, 16};
        for (uint32_t i = 0; i < 4; i++) { /* they return while memory fails */
            a.refuse_from = a.calls + n;
            crowd_frame(&c);
        }
        a.refuse_from = UINT64_MAX;
        assert_int_equal(crowd_sharpen(&c, 60), 0);
        a.refuse_from = a.calls + n % 3;
        crowd_rest(&c, 4);
        a.refuse_from = UINT64_MAX;
        crowd_rest(&c, 10);
        assert_int_equal(crowd_statistics(&c).absentTextureCount, 16);
    }
    h->quiet = false;
    crowd_finish(&c);
    CHECK_OK(harness_set_context(h, NULL));
    assert_int_equal(a.live_count, 0);
}

static void settings_that_do_not_fit_are_refused(void **state)
{
    struct harness *h = *state;
    SluiceVulkanStreamer *streamer;
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info, .forgetTextures = true};
    h->quiet = true;
    harness_fill(h, &info);
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h->last_message, "textureArray"));
    info.forgetTextures = false;
    info.forgetAfterFrames = 5;
    CHECK_RESULT(sluiceCreateVulkanStreamer(&info, &streamer), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_non_null(strstr(h->last_message, "forgetAfterFrames is 5"));
    h->quiet = false;
}

/* A follower has the maps of its primary. */
static void textures_of_sets_stay(void **state)
{
    struct crowd c;
    SluiceVulkanStreamerCreateInfo info = settings(4);
    info.forgetAfterFrames = 2;
    crowd_init(&c, *state, info);
    CHECK_OK(crowd_add(&c, SMALL, NULL));
    assert_true(c.members[0].texture.imageView == VK_NULL_HANDLE);
    SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                            .source = crowd_source(&c.members[1], 1, SMALL),
                                            .primaryId = c.members[0].texture.textureId};
    CHECK_OK(sluiceAddVulkanTexture(c.streamer, &create, &c.members[1].texture));
    c.count = 2;
    assert_true(c.members[1].texture.imageView != VK_NULL_HANDLE);
    c.ranges[0] = (struct crowd_range){0, 1}; /* feedback of the first counts for both */
    assert_int_equal(crowd_sharpen(&c, 30), 0);
    c.ranges[0].count = 2;
    assert_int_equal(crowd_sharpen(&c, 30), 0);
    crowd_rest(&c, 20);
    assert_int_equal(crowd_statistics(&c).texturesForgotten, 0);
    crowd_finish(&c);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(many_are_sampled_once_and_again_within_a_budget_for_few),
        cmocka_unit_test(frames_that_are_abandoned_lose_none),
        cmocka_unit_test(a_sparse_streamer_forgets_small_dense_textures),
        cmocka_unit_test(those_in_view_stay_while_others_come_and_go),
        cmocka_unit_test(age_forgets_while_there_is_memory),
        cmocka_unit_test(without_age_and_with_memory_all_stay),
        cmocka_unit_test(they_can_be_removed_at_any_time),
        cmocka_unit_test(one_whose_source_fails_shows_the_fallback_until_it_is_read),
        cmocka_unit_test(host_memory_that_fails_loses_none),
        cmocka_unit_test(settings_that_do_not_fit_are_refused),
        cmocka_unit_test(textures_of_sets_stay),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
