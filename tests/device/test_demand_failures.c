/* Failing images: failures end, are reported, and textures show the remaining levels. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <math.h>
#include <sched.h>

static struct harness h;

struct told {
    atomic_uint count, retried;
    atomic_uint_least64_t value; ///< last value
};

static void note_failure(void *user, const SluiceTileReadFailure *failure)
{
    struct told *told = user;
    atomic_fetch_add(&told->count, 1);
    atomic_fetch_add(&told->retried, failure->willRetry);
    atomic_store(&told->value, failure->userValue);
}

static SluiceDemandLoaderCreateInfo quick_retries(struct told *told)
{
    return (SluiceDemandLoaderCreateInfo){.structSize = sizeof(SluiceDemandLoaderCreateInfo),
                                          .failure = {told, note_failure}};
}

static void check_failed(const struct runner *r, uint32_t sample)
{
    struct RunnerOutput out = runner_output(r, sample);
    assert_true(out.resident && out.color[0] == 1 && out.color[1] == 0 && out.color[2] == 1);
}

static void an_image_that_cannot_be_opened_shows_its_failure_color(void **state)
{
    (void)state;
    static const SluiceResult results[] = {SLUICE_ERROR_FILE_NOT_FOUND, SLUICE_ERROR_IO,
                                           SLUICE_ERROR_CORRUPT_DATA};
    static const uint32_t attempts[] = {1, 3, 2};
    h.quiet = true;
    for (uint32_t i = 0; i < 3; i++) {
        struct runner r;
        struct runner_image image;
        struct told told = {0};
        const SluiceDemandLoaderCreateInfo info = quick_retries(&told);
        runner_init(&r, &h, &info);
        runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
        image.open_result = results[i];
        SluiceDemandTextureId id = runner_add_texture(&r, &image);
        runner_add_texel(&r, id, 300, 300, 0, 9, 9);
        uint32_t errors = h.log_count[SLUICE_LOG_ERROR];
        assert_int_equal(runner_load(&r, 9), 2);
        check_failed(&r, 0);
        assert_int_equal(h.log_count[SLUICE_LOG_ERROR], errors + 1);
        assert_int_equal(image.opened, attempts[i]);
        assert_int_equal(image.closed, 0);
        assert_int_equal(told.count, attempts[i]);
        assert_int_equal(told.value, id);
        SluiceDemandStatistics statistics = runner_statistics(&r);
        assert_int_equal(statistics.texturesFailed, 1);
        assert_int_equal(statistics.texturesOpened, 0);
        /* Fails until the test clears the failure. */
        image.open_result = SLUICE_SUCCESS;
        runner_launch(&r);
        assert_int_equal(r.requests.missingCount, 0);
        CHECK_OK(sluiceInvalidateDemandTexture(r.loader, id));
        runner_load(&r, 9);
        runner_check_texel(&r, 0, &image, 0, 9, 9);
        runner_finish(&r);
        runner_image_finish(&image);
    }
    h.quiet = false;
}

static void a_failure_names_the_image_that_was_never_open(void **state)
{
    struct runner r;
    struct runner_image image;
    struct told told = {0};
    const SluiceDemandLoaderCreateInfo info = quick_retries(&told);
    (void)state;
    h.quiet = true;
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    image.open_result = SLUICE_ERROR_UNSUPPORTED;
    SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                            .image = runner_image_desc(&image)};
    create.image.pName = "bricks.store";
    SluiceDemandTextureId id;
    CHECK_OK(sluiceAddDemandTexture(r.loader, &create, &id));
    runner_add_texel(&r, id, 300, 300, 0, 9, 9);
    runner_load(&r, 9);
    assert_memory_equal(h.last_message, "bricks.store cannot be used as a texture", 40);
    runner_finish(&r);
    runner_image_finish(&image);
    h.quiet = false;
}

/* A source whose info is set by the test. */
struct liar {
    SluiceImageSource base;
    SluiceImageInfo info;
};

static SluiceResult lie(SluiceImageSource *source, SluiceImageInfo *info)
{
    *info = ((struct liar *)source)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_zeros(SluiceImageSource *source, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch)
{
    (void)source, (void)region, (void)texels, (void)row_pitch;
    return SLUICE_SUCCESS;
}

static void destroy_nothing(SluiceImageSource *source)
{
    (void)source;
}

static void images_that_no_shader_could_sample_are_refused(void **state)
{
    (void)state;
    static const SluiceImageSourceInterface interface = {sizeof interface, lie, read_zeros,
                                                         destroy_nothing};
    struct liar liars[] = {
        {.info = {sizeof(SluiceImageInfo), 0, 16, 5, SLUICE_FORMAT_R8_UNORM, "no width"}},
        {.info = {sizeof(SluiceImageInfo), (1u << 20) + 1, 1, 21, SLUICE_FORMAT_R8_UNORM,
                  "too wide"}},
        {.info = {sizeof(SluiceImageInfo), 256, 256, 1, SLUICE_FORMAT_R8_UNORM, "too few levels"}},
        {.info = {sizeof(SluiceImageInfo), 16, 16, 0, SLUICE_FORMAT_R8_UNORM, "no levels"}},
        {.info = {sizeof(SluiceImageInfo), 16, 16, 5, SLUICE_FORMAT_R8_UNORM,
                  "more layers than any array", UINT32_MAX}},
        {.info = {sizeof(SluiceImageInfo), 16, 16, 5, SLUICE_FORMAT_UNDEFINED, "no format"}},
        {.info = {sizeof(SluiceImageInfo), 16, 16, 5, (SluiceFormat)99, "unknown format"}},
        {.info = {sizeof(SluiceImageInfo), 1u << 20, 1u << 20, 21, SLUICE_FORMAT_R8_UNORM,
                  "more tiles than pages"}},
    };
    enum { COUNT = sizeof liars / sizeof liars[0] };
    struct runner r;
    SluiceDemandTextureId id;
    runner_init(&r, &h, NULL);
    h.quiet = true;
    for (uint32_t i = 0; i < COUNT; i++) {
        liars[i].base.pInterface = &interface;
        const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                    .image.source = &liars[i].base,
                                                    .failureColor = {1, 0, 1, 1}};
        CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &id));
        runner_add_texel(&r, id, 16, 16, 0, 3, 3);
    }
    runner_load(&r, 9);
    for (uint32_t i = 0; i < COUNT; i++)
        check_failed(&r, i);
    assert_int_equal(runner_statistics(&r).texturesFailed, COUNT);
    h.quiet = false;
    runner_finish(&r);
}

static void a_tile_that_cannot_be_read_is_shown_by_coarser_ones(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    struct told told = {0};
    const SluiceDemandLoaderCreateInfo info = quick_retries(&told);
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 1);
    image.source.fail_at = 2; /* after the color of the last level */
    image.source.fails_on = true;
    image.source.failure = SLUICE_ERROR_UNSUPPORTED;
    image.source.is_short = true;
    h.quiet = true;
    runner_add_texel(&r, runner_add_texture(&r, &image), 512, 512, 0, 9, 9);
    runner_launch(&r); /* opens it */
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    runner_launch(&r); /* misses the tile */
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, &status));
    assert_int_equal(status.taskCount, 1);
    assert_int_equal(status.remainingCount, 0);
    assert_int_equal(status.failedCount, 1);
    image.source.fail_at = 0;
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &image, 1, 4, 4);
    assert_int_equal(told.count, 1);
    assert_int_equal(runner_statistics(&r).failedCount, 1);
    h.quiet = false;
    runner_finish(&r);
    runner_image_finish(&image);
}

static void without_its_coarse_levels_a_texture_fails(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    struct told told = {0};
    const SluiceDemandLoaderCreateInfo info = quick_retries(&told);
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 1);
    image.source.fail_at = 2;
    image.source.fails_on = true;
    image.source.failure = SLUICE_ERROR_IO;
    h.quiet = true;
    runner_add_texel(&r, runner_add_texture(&r, &image), 512, 512, 0, 9, 9);
    runner_load(&r, 20); /* level after level is given up, in the end the tail */
    check_failed(&r, 0);
    h.quiet = false;
    assert_int_equal(told.count, 4 * 3); /* levels 0 to 2 and the tail, three attempts each */
    assert_int_equal(image.closed, 1);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void what_says_later_for_ever_stays_missing_and_hangs_nothing(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image never, later;
    struct told told = {0};
    const SluiceDemandLoaderCreateInfo info = quick_retries(&told);
    runner_init(&r, &h, &info);
    runner_image_init(&never, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    runner_image_init(&later, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 2);
    never.open_failures = UINT64_MAX;
    later.source.postponed = 5;
    runner_add_texel(&r, runner_add_texture(&r, &never), 300, 300, 0, 9, 9);
    runner_add_texel(&r, runner_add_texture(&r, &later), 300, 300, 0, 9, 9);
    assert_int_equal(runner_load(&r, 20), 20);
    assert_int_equal(r.requests.missingCount, 1);
    assert_false(runner_output(&r, 0).resident);
    runner_check_texel(&r, 1, &later, 0, 9, 9);
    assert_in_range(never.opened, 3 * 19, 3 * 20); /* the last attempt is not waited for */
    runner_finish(&r);
    assert_int_equal(never.closed, 0);
    runner_image_finish(&never);
    runner_image_finish(&later);
}

static void reads_of_textures_that_are_gone_change_nothing(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image slow, other;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info};
    runner_init(&r, &h, &info);
    runner_image_init(&slow, SLUICE_FORMAT_R8G8B8A8_UNORM, 1024, 1024, 1);
    runner_image_init(&other, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 2);
    SluiceDemandTextureId id = runner_add_texture(&r, &slow);
    for (uint32_t i = 0; i < 8; i++)
        runner_add_texel(&r, id, 1024, 1024, 0, i * 128, 9);
    runner_launch(&r);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    slow.source.holds = true;
    runner_launch(&r);
    assert_int_equal(r.requests.servedCount, 8);
    fault_source_await(&slow.source, 2);
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    CHECK_RESULT(sluiceWaitDemandTicket(r.loader, r.ticket, 1000, &status), SLUICE_NOT_READY);
    assert_int_equal(status.remainingCount, 8);
    SluiceDemandTicket ticket = r.ticket;
    CHECK_OK(sluiceRemoveDemandTexture(r.loader, id)); /* must not wait */
    assert_int_equal(slow.closed, 0);
    runner_clear(&r);
    runner_add_texel(&r, runner_add_texture(&r, &other), 300, 300, 0, 9, 9);
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &other, 0, 9, 9);
    assert_int_equal(slow.closed, 0);
    fault_source_release(&slow.source);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, ticket, UINT64_MAX, &status));
    assert_int_equal(status.failedCount, 8 - 2); /* two were in flight */
    runner_launch(&r);
    assert_int_equal(slow.closed, 1);
    assert_int_equal(slow.source.read_count, 1 + 2);
    runner_finish(&r);
    runner_image_finish(&slow);
    runner_image_finish(&other);
}

static void a_source_may_go_as_soon_as_its_texture_is_destroyed(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandTextureId id;
    runner_init(&r, &h, NULL);
    for (uint32_t i = 0; i < 10; i++) {
        runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 1024, 1024, i);
        image.source.delay_us = 200;
        const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                    .image.source = &image.source.base,
                                                    .pSampler = &runner_nearest};
        CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &id));
        runner_clear(&r);
        for (uint32_t x = 0; x < 64; x++)
            runner_add_texel(&r, id, 1024, 1024, 0, x % 8 * 128, x / 8 * 128);
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
        runner_launch(&r);
        CHECK_OK(sluiceRemoveDemandTexture(r.loader, id));
        assert_int_equal(image.source.running, 0);
        runner_image_finish(&image); /* its memory may be reused now */
    }
    runner_finish(&r);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_image_that_cannot_be_opened_shows_its_failure_color),
        cmocka_unit_test(a_failure_names_the_image_that_was_never_open),
        cmocka_unit_test(images_that_no_shader_could_sample_are_refused),
        cmocka_unit_test(a_tile_that_cannot_be_read_is_shown_by_coarser_ones),
        cmocka_unit_test(without_its_coarse_levels_a_texture_fails),
        cmocka_unit_test(what_says_later_for_ever_stays_missing_and_hangs_nothing),
        cmocka_unit_test(reads_of_textures_that_are_gone_change_nothing),
        cmocka_unit_test(a_source_may_go_as_soon_as_its_texture_is_destroyed),
    };
    CHECK_OK(harness_set_context(
        &h, &(SluiceVulkanContextCreateInfo){.loaderThreadCount = 3, .readRetry = {3, 1, 1}}));
    return harness_finish(&h, RUN_TESTS(tests));
}
