/* Misuse of demand loading, each kind made once that needs no shader, and what strict mode says. */
#include "support/gray_source.h"
#include "support/test.h"
#include "vulkan/fake_vulkan.h"

#include <sluice/demand_strict.h>

#include <string.h>

static struct {
    uint32_t counts[SLUICE_DEMAND_MISUSE_SOURCE_IN_USE + 1]; ///< by kind
    SluiceDemandMisuse last;
    char text[400];
} heard;

static struct fake_vulkan fake; /* large */
static SluiceVulkanContext *context;

static void listen(void *user, const SluiceDemandMisuse *misuse)
{
    (void)user;
    heard.counts[misuse->kind]++;
    heard.last = *misuse;
    strncpy(heard.text, misuse->pMessage, sizeof heard.text - 1);
}

static void check_heard(SluiceDemandMisuseKind kind, uint32_t count, uint64_t value,
                        const char *text)
{
    assert_int_equal(heard.counts[kind], count);
    assert_true(heard.last.kind == kind && heard.last.value == value);
    assert_non_null(strstr(heard.text, text));
}

static SluiceDemandLoader *begin(uint64_t unsignaled)
{
    SluiceDemandLoader *loader;
    fake = (struct fake_vulkan){.no_resolve = true, .waits_time_out = true};
    memset(&heard, 0, sizeof heard);
    const SluiceVulkanContextCreateInfo context_info = fake_vulkan_context_info(&fake);
    CHECK_OK(sluiceCreateVulkanContext(&context_info, &context));
    SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                         .context = context,
                                         .maxTextureCount = 4,
                                         .pageCapacity = 1 << 16,
                                         .maxRequestsPerLaunch = 100};
    CHECK_OK(sluiceCreateDemandLoader(&info, &loader));
    const SluiceDemandStrictMode strict = {.structSize = sizeof strict,
                                           .launchesWithoutRequests = 20,
                                           .unsignaledNs = unsignaled,
                                           .repeatLaunches = 30,
                                           .pfnReport = listen};
    CHECK_OK(sluiceSetDemandStrictMode(loader, &strict));
    return loader;
}

/* Completes all launches that were begun. */
static void finish(SluiceDemandLoader *loader)
{
    fake.frame_value = UINT32_MAX;
    sluiceDestroyDemandLoader(loader);
    sluiceDestroyVulkanContext(context);
    assert_int_equal(fake.live_objects, 0);
}

static SluiceResult begin_launch(SluiceDemandLoader *loader, SluiceDemandLaunch *launch)
{
    *launch = (SluiceDemandLaunch){.structSize = sizeof *launch};
    SluiceResult result = sluiceBeginDemandLaunch(loader, fake_vulkan_commands(&fake), launch);
    if (result == SLUICE_SUCCESS)
        fake.frame_semaphore = launch->semaphore;
    return result;
}

static SluiceResult end_launch(SluiceDemandLoader *loader)
{
    return sluiceEndDemandLaunch(loader, fake_vulkan_commands(&fake));
}

static SluiceResult process(SluiceDemandLoader *loader, const SluiceDemandLaunch *launch,
                            uint64_t timeout)
{
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    return sluiceProcessDemandRequests(loader, launch, timeout, &requests, NULL);
}

static void launch_times(SluiceDemandLoader *loader, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        SluiceDemandLaunch launch;
        CHECK_OK(begin_launch(loader, &launch));
        CHECK_OK(end_launch(loader));
        fake.frame_value = launch.signalValue;
        CHECK_OK(process(loader, &launch, 0));
    }
}

static void unpaired_launches_are_reported(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(0);
    SluiceDemandLaunch launch, other;
    CHECK_RESULT(end_launch(loader), SLUICE_ERROR_INVALID_ARGUMENT);
    check_heard(SLUICE_DEMAND_MISUSE_LAUNCH_NOT_BEGUN, 1, 0, "sluiceBeginDemandLaunch first");
    CHECK_OK(begin_launch(loader, &launch));
    CHECK_RESULT(begin_launch(loader, &other), SLUICE_ERROR_INVALID_ARGUMENT);
    check_heard(SLUICE_DEMAND_MISUSE_LAUNCH_NOT_ENDED, 1, 1, "launch 1 was begun and not ended");
    CHECK_OK(end_launch(loader));
    CHECK_OK(sluiceSetDemandStrictMode(loader, NULL));
    CHECK_RESULT(end_launch(loader), SLUICE_ERROR_INVALID_ARGUMENT);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_LAUNCH_NOT_BEGUN], 1);
    CHECK_RESULT(
        sluiceSetDemandStrictMode(
            loader, &(SluiceDemandStrictMode){.structSize = sizeof(SluiceDemandStrictMode)}),
        SLUICE_ERROR_INVALID_ARGUMENT);
    finish(loader);
}

static void launches_that_are_never_signaled_are_reported_once(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(1);
    SluiceDemandLaunch launch, other;
    launch_times(loader, 3);
    CHECK_OK(begin_launch(loader, &launch));
    CHECK_OK(end_launch(loader));
    for (uint32_t i = 0; i < 9; i++) /* the second call is later than the first */
        CHECK_RESULT(process(loader, &launch, 0), SLUICE_NOT_READY);
    check_heard(SLUICE_DEMAND_MISUSE_LAUNCH_NOT_SIGNALED, 1, 4,
                "submit its commands with signalValue 4");
    CHECK_OK(sluiceAbandonDemandLaunch(loader, &launch));
    CHECK_OK(begin_launch(loader, &launch)); /* launch 4 anew */
    CHECK_OK(end_launch(loader));
    CHECK_OK(begin_launch(loader, &other));
    CHECK_OK(end_launch(loader));
    for (uint32_t i = 0; i < 9; i++)
        CHECK_RESULT(begin_launch(loader, &other), SLUICE_NOT_READY);
    check_heard(SLUICE_DEMAND_MISUSE_LAUNCH_NOT_SIGNALED, 2, 4, "has the value 3");
    finish(loader);
}

/* A wait without end would hide the report: it is made before the rest of the wait. */
static void a_wait_without_end_is_reported_while_it_lasts(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(UINT64_C(3600000000000));
    SluiceDemandLaunch launch;
    CHECK_OK(begin_launch(loader, &launch));
    CHECK_OK(end_launch(loader));
    uint32_t waits = fake.wait_count;
    CHECK_RESULT(process(loader, &launch, UINT64_MAX), SLUICE_NOT_READY); /* the fake gives up */
    assert_int_equal(fake.wait_count, waits + 2);
    assert_in_range(fake.waits[waits % 64].timeout, 1, UINT64_C(3600000000000));
    assert_true(fake.waits[(waits + 1) % 64].timeout == UINT64_MAX);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_LAUNCH_NOT_SIGNALED], 0); /* not an hour */
    CHECK_RESULT(process(loader, &launch, 1000), SLUICE_NOT_READY);
    assert_int_equal(fake.waits[(waits + 2) % 64].timeout, 1000);
    assert_int_equal(fake.wait_count, waits + 3);
    finish(loader);
}

static void launches_that_nobody_processes_are_reported(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(1);
    SluiceDemandLaunch launch;
    for (uint32_t i = 0; i < 2; i++) {
        CHECK_OK(begin_launch(loader, &launch));
        CHECK_OK(end_launch(loader));
    }
    fake.frame_value = 2;
    for (uint32_t i = 0; i < 9; i++)
        CHECK_RESULT(begin_launch(loader, &launch), SLUICE_NOT_READY);
    check_heard(SLUICE_DEMAND_MISUSE_LAUNCH_NOT_PROCESSED, 1, 1, "sluiceProcessDemandRequests");
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_LAUNCH_NOT_SIGNALED], 0);
    finish(loader);
}

static void the_launch_that_a_call_waits_for_is_reported_not_an_older_one(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(1);
    SluiceDemandLaunch launches[2];
    for (uint32_t i = 0; i < 2; i++) {
        CHECK_OK(begin_launch(loader, &launches[i]));
        CHECK_OK(end_launch(loader));
    }
    fake.frame_value = 1;
    for (uint32_t i = 0; i < 3; i++)
        CHECK_RESULT(process(loader, &launches[1], 1000), SLUICE_NOT_READY);
    check_heard(SLUICE_DEMAND_MISUSE_LAUNCH_NOT_SIGNALED, 1, 2, "signalValue 2");
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_LAUNCH_NOT_PROCESSED], 0);
    finish(loader);
}

static SluiceImageSource *create_source(const char *name)
{
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = 8,
                                  .height = 8,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = name};
    return gray_source_with(&info);
}

static void launches_without_requests_are_reported_if_there_are_textures(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(0);
    SluiceImageSource *source = create_source("gray");
    const SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                                  .image.source = source};
    SluiceDemandTextureId id;
    launch_times(loader, 30);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_NO_REQUESTS], 0);
    CHECK_OK(sluiceAddDemandTexture(loader, &create, &id));
    launch_times(loader, 9);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_NO_REQUESTS], 0);
    launch_times(loader, 1);
    check_heard(SLUICE_DEMAND_MISUSE_NO_REQUESTS, 1, 20, "any page of 1 textures and 0 resources");
    launch_times(loader, 20);
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_NO_REQUESTS], 2);
    finish(loader);
    sluiceDestroyImageSource(source);
}

static void textures_beyond_their_count_are_reported(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(0);
    SluiceImageSource *source = create_source("gray");
    const SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                                  .image.source = source};
    SluiceDemandTextureId id;
    for (uint32_t i = 0; i < 4; i++)
        CHECK_OK(sluiceAddDemandTexture(loader, &create, &id));
    CHECK_RESULT(sluiceAddDemandTexture(loader, &create, &id), SLUICE_ERROR_LIMIT_EXCEEDED);
    check_heard(SLUICE_DEMAND_MISUSE_TEXTURES_EXHAUSTED, 1, 4, "beyond maxTextureCount, 4");
    finish(loader);
    sluiceDestroyImageSource(source);
}

static void sources_in_use_are_reported_and_kept(void **state)
{
    (void)state;
    SluiceDemandLoader *loader = begin(0);
    SluiceImageSource *sources[2] = {create_source("gray"), create_source("other")};
    SluiceDemandTextureCreateInfo create = {.structSize = sizeof create,
                                            .image.source = sources[0]};
    SluiceDemandTextureId id;
    bool in_use = false;
    CHECK_OK(sluiceAddDemandTexture(loader, &create, &id));
    CHECK_RESULT(sluiceReleaseDemandSource(loader, sources[0]), SLUICE_NOT_READY);
    check_heard(SLUICE_DEMAND_MISUSE_SOURCE_IN_USE, 1, (uint64_t)(uintptr_t)sources[0],
                "gray: the source is destroyed");
    create.image.source = sources[1];
    CHECK_OK(sluiceReplaceDemandImage(loader, id, &create.image));
    CHECK_OK(sluiceIsDemandSourceInUse(loader, sources[1], &in_use));
    assert_true(in_use);
    CHECK_OK(sluiceReleaseDemandSource(loader, sources[0])); /* leak checkers see the rest */
    CHECK_OK(sluiceRemoveDemandTexture(loader, id));
    CHECK_OK(sluiceReleaseDemandSource(loader, sources[1]));
    assert_int_equal(heard.counts[SLUICE_DEMAND_MISUSE_SOURCE_IN_USE], 1);
    finish(loader);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unpaired_launches_are_reported),
        cmocka_unit_test(launches_that_are_never_signaled_are_reported_once),
        cmocka_unit_test(a_wait_without_end_is_reported_while_it_lasts),
        cmocka_unit_test(launches_that_nobody_processes_are_reported),
        cmocka_unit_test(the_launch_that_a_call_waits_for_is_reported_not_an_older_one),
        cmocka_unit_test(launches_without_requests_are_reported_if_there_are_textures),
        cmocka_unit_test(textures_beyond_their_count_are_reported),
        cmocka_unit_test(sources_in_use_are_reported_and_kept),
    };
    return RUN_TESTS(tests);
}
