/* Memory of a demand loader falls while it traces, and what rays see stays right. */
#include "device/demand_runner.h"

#include "support/test.h"

#define MIB (UINT64_C(1) << 20)
#define SIZE 2048u
#define TILE 128u
#define TILES (SIZE / TILE) /* along an edge: 16 MiB of level 0 */

static struct harness h;
static struct runner r;
static struct runner_image image;
static SluiceDemandTextureId texture;

static uint64_t tile_memory(void)
{
    SluiceVulkanContextStatistics s = {.structSize = sizeof s};
    CHECK_OK(sluiceGetVulkanContextStatistics(h.context, &s));
    return s.tileMemorySize;
}

/* Samples a texel in each of tiles x tiles tiles. */
static void look_at(uint32_t tiles)
{
    runner_clear(&r);
    for (uint32_t i = 0; i < tiles * tiles; i++)
        runner_add_texel(&r, texture, SIZE, SIZE, 0, i % tiles * TILE + 5, i / tiles * TILE + 9);
}

static void check(uint32_t tiles)
{
    for (uint32_t i = 0; i < tiles * tiles; i++)
        runner_check_texel(&r, i, &image, 0, i % tiles * TILE + 5, i / tiles * TILE + 9);
}

static void open_loader(void)
{
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 7);
    texture = runner_add_texture(&r, &image);
    look_at(TILES);
    assert_true(runner_load(&r, 100) < 100);
    check(TILES);
}

static void close_loader(void)
{
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    runner_finish(&r);
    runner_image_finish(&image);
}

static void run_until_memory_is(uint64_t size, uint32_t limit)
{
    for (uint32_t i = 0; tile_memory() > size; i++) {
        if (i == limit)
            fail_msg("%u KiB after %u launches", (unsigned)(tile_memory() / 1024), i);
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
}

static void run_until_sharp(uint32_t limit)
{
    for (uint32_t i = 0; i < limit; i++) {
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
        if (r.requests.missingCount == 0 && r.requests.lodBias <= 0)
            return;
    }
    fail_msg("%u launches were too few", limit);
}

static void unused_pages_go_when_the_budget_falls(void **state)
{
    (void)state;
    open_loader();
    uint64_t before = tile_memory();
    assert_true(before >= 16 * MIB);
    look_at(4);
    assert_true(runner_load(&r, 20) < 20);
    assert_true(tile_memory() == before);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 9 * MIB));
    run_until_memory_is(9 * MIB, 20);
    assert_true(runner_load(&r, 20) < 20);
    check(4);
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    look_at(TILES);
    assert_true(runner_load(&r, 200) < 200);
    check(TILES);
    close_loader();
}

/* Tiles that are missed again have room in other images. */
static void launches_get_blurrier_when_the_budget_falls_below_what_they_use(void **state)
{
    (void)state;
    open_loader();
    h.quiet = true;
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 9 * MIB));
    run_until_memory_is(9 * MIB, 40);
    for (uint32_t i = 0; i < 20; i++) {
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
        assert_true(tile_memory() <= 9 * MIB);
    }
    h.quiet = false;
    CHECK_OK(sluiceSetVulkanMemoryBudget(h.context, 0));
    run_until_sharp(400);
    check(TILES);
    close_loader();
}

static void abandoned_launches_lose_no_page(void **state)
{
    uint32_t before = h.abandon_one_in;
    h.abandon_one_in = 2;
    unused_pages_go_when_the_budget_falls(state);
    launches_get_blurrier_when_the_budget_falls_below_what_they_use(state);
    h.abandon_one_in = before;
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unused_pages_go_when_the_budget_falls),
        cmocka_unit_test(launches_get_blurrier_when_the_budget_falls_below_what_they_use),
        cmocka_unit_test(abandoned_launches_lose_no_page),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
