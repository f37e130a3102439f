/* Launches that are prepared and never submitted: nothing is lost, and nothing is read again. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <string.h>

enum { IMAGES = 6, TEXELS = 60 };

static struct harness h;

struct loaded {
    SluiceDemandStatistics statistics;
    struct RunnerOutput outputs[IMAGES * TEXELS];
};

/* Loads all sampled texels, although some launches are abandoned. */
static void load(struct loaded *loaded, uint32_t abandon_one_in)
{
    static struct runner_image images[IMAGES];
    struct runner r;
    h.abandon_one_in = abandon_one_in;
    runner_init(&r, &h, NULL);
    for (uint32_t i = 0; i < IMAGES; i++) {
        uint32_t width = 300 << i % 3, height = 700 >> i % 2;
        runner_image_init(&images[i],
                          i % 2 ? SLUICE_FORMAT_R8G8B8A8_UNORM : SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                          width, height, i);
        SluiceDemandTextureId id = runner_add_texture(&r, &images[i]);
        for (uint32_t t = 0; t < TEXELS; t++)
            runner_add_texel(&r, id, width, height, t % 3, t * 7 % (width >> t % 3),
                             t * 11 % (height >> t % 3));
    }
    runner_load(&r, 40);
    assert_true(runner_all_resident(&r));
    for (uint32_t i = 0; i < IMAGES * TEXELS; i++)
        loaded->outputs[i] = runner_output(&r, i);
    loaded->statistics = runner_statistics(&r);
    h.abandon_one_in = 0;
    runner_finish(&r);
    for (uint32_t i = 0; i < IMAGES; i++)
        runner_image_finish(&images[i]);
}

static void what_is_loaded_is_the_same_where_launches_are_given_up(void **state)
{
    (void)state;
    static struct loaded plain, given_up; /* large */
    load(&plain, 0);
    uint32_t before = h.abandoned_count;
    load(&given_up, 2);
    assert_in_range(h.abandoned_count - before, 3, UINT32_MAX);
    assert_memory_equal(plain.outputs, given_up.outputs, sizeof plain.outputs);
    assert_int_equal(plain.statistics.bytesRead, given_up.statistics.bytesRead);
    assert_int_equal(plain.statistics.bytesUploaded, given_up.statistics.bytesUploaded);
    assert_int_equal(plain.statistics.residentTileCount, given_up.statistics.residentTileCount);
    assert_int_equal(plain.statistics.texturesOpened, given_up.statistics.texturesOpened);
}

static void begin_commands(VkCommandBuffer commands)
{
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    assert_int_equal(h.ResetCommandBuffer(commands, 0), VK_SUCCESS);
    assert_int_equal(h.BeginCommandBuffer(commands, &begin), VK_SUCCESS);
}

/* Prepares as many as may be in flight, and gives all of them up with the first. */
static void give_up_all(struct runner *r, VkCommandBuffer commands)
{
    SluiceDemandLaunch first = {.structSize = sizeof first}, launch = {.structSize = sizeof launch};
    begin_commands(commands);
    CHECK_OK(sluiceBeginDemandLaunch(r->loader, commands, &first));
    CHECK_RESULT(sluiceBeginDemandLaunch(r->loader, commands, &launch),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceEndDemandLaunch(r->loader, commands));
    while (sluiceBeginDemandLaunch(r->loader, commands, &launch) == SLUICE_SUCCESS)
        CHECK_OK(sluiceEndDemandLaunch(r->loader, commands));
    CHECK_OK(sluiceAbandonDemandLaunch(r->loader, &first));
    CHECK_RESULT(sluiceAbandonDemandLaunch(r->loader, &first), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceEndDemandLaunch(r->loader, commands), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceDemandRequests requests = {.structSize = sizeof requests};
    CHECK_RESULT(sluiceProcessDemandRequests(r->loader, &first, 0, &requests, NULL),
                 SLUICE_ERROR_INVALID_ARGUMENT);
}

static void any_number_of_launches_in_a_row_can_be_given_up(void **state)
{
    (void)state;
    static struct runner_image image;
    struct runner r;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 600, 600, 1);
    SluiceDemandTextureId id = runner_add_texture(&r, &image);
    for (uint32_t i = 0; i < TEXELS; i++)
        runner_add_texel(&r, id, 600, 600, 0, i * 9, i * 7);
    h.quiet = true;
    for (uint32_t step = 0; step < 6; step++) { /* between all that it takes to load them */
        for (uint32_t i = 0; i < 10; i++)
            give_up_all(&r, h.commands[0]);
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
    CHECK_RESULT(sluiceAbandonDemandLaunch(r.loader, &r.launch), SLUICE_ERROR_INVALID_ARGUMENT);
    h.quiet = false;
    assert_int_equal(r.requests.missingCount, 0);
    assert_int_equal(runner_statistics(&r).launchCount, 6);
    for (uint32_t i = 0; i < TEXELS; i++)
        runner_check_texel(&r, i, &image, 0, i * 9, i * 7);
    runner_finish(&r);
    runner_image_finish(&image);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_loaded_is_the_same_where_launches_are_given_up),
        cmocka_unit_test(any_number_of_launches_in_a_row_can_be_given_up),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
