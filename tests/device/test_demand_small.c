/* Small textures: mip tails that share pages. */
#include "device/demand_runner.h"

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>

static struct harness h;

enum { COUNT = 600, SIZE = 64, LEVELS = 7, PAGE = 65536 };

struct small {
    struct runner r;
    struct runner_image images[COUNT];
    SluiceDemandTextureId ids[COUNT];
};

static struct small *small_create(const SluiceDemandLoaderCreateInfo *info)
{
    struct small *s = calloc(1, sizeof *s);
    assert_non_null(s);
    runner_init(&s->r, &h, info);
    return s;
}

static void small_destroy(struct small *s)
{
    runner_finish(&s->r);
    for (uint32_t i = 0; i < COUNT; i++)
        if (s->images[i].inner)
            runner_image_finish(&s->images[i]);
    free(s);
}

static void add(struct small *s, uint32_t i, SluiceFormat format, uint32_t width, uint32_t height)
{
    runner_image_init(&s->images[i], format, width, height, i);
    s->ids[i] = runner_add_texture(&s->r, &s->images[i]);
}

/* Samples `level` of textures `first` to `end` - 1, each at another texel. */
static void add_samples(struct small *s, uint32_t first, uint32_t end, uint32_t level)
{
    for (uint32_t i = first; i < end; i++)
        runner_add_texel(&s->r, s->ids[i], SIZE, SIZE, level, i % (SIZE >> level),
                         i / 7 % (SIZE >> level));
}

static void check_samples(struct small *s, uint32_t sample, uint32_t first, uint32_t end,
                          uint32_t level)
{
    for (uint32_t i = first; i < end; i++)
        runner_check_texel(&s->r, sample + i - first, &s->images[i], level, i % (SIZE >> level),
                           i / 7 % (SIZE >> level));
}

/* 600 x 85 KiB / 4 are 200 pages. */
static void three_textures_of_64x64_share_a_page(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 13u << 20};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < COUNT; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    for (uint32_t l = 0; l + 1 < LEVELS; l++)
        add_samples(s, 0, COUNT, l);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    SluiceDemandStatistics statistics = runner_statistics(&s->r);
    for (uint32_t l = 0; l + 1 < LEVELS; l++)
        check_samples(s, l * COUNT, 0, COUNT, l);
    assert_int_equal(statistics.residentTileCount, COUNT);
    assert_int_equal(statistics.tailPageCount, COUNT / 3);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    assert_int_equal(statistics.evictedCount, 0);
    assert_true(statistics.lodBias == 0);
    print_message("# small.bytes_per_texture %u\n",
                  (uint32_t)(statistics.tailPageCount * PAGE / COUNT));
    small_destroy(s);
}

/* Two of three textures go, and others take their slots. */
static void slots_of_removed_textures_are_taken_again(void **state)
{
    (void)state;
    struct small *s = small_create(NULL);
    for (uint32_t i = 0; i < COUNT / 2; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, 0, COUNT / 2, 1);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    uint64_t pages = runner_statistics(&s->r).tailPageCount;
    assert_int_equal(pages, COUNT / 6);
    runner_clear(&s->r);
    for (uint32_t i = 0; i < COUNT / 2; i++)
        if (i % 3)
            CHECK_OK(sluiceRemoveDemandTexture(s->r.loader, s->ids[i]));
    for (uint32_t i = COUNT / 2; i < COUNT / 2 + COUNT / 3; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, COUNT / 2, COUNT / 2 + COUNT / 3, 2);
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    check_samples(s, 0, COUNT / 2, COUNT / 2 + COUNT / 3, 2);
    assert_int_equal(runner_statistics(&s->r).tailPageCount, pages);
    runner_clear(&s->r);
    for (uint32_t i = 0; i < COUNT / 2; i += 3)
        add_samples(s, i, i + 1, 0);
    runner_launch(&s->r);
    assert_int_equal(s->r.requests.missingCount, 0);
    for (uint32_t i = 0; i < COUNT / 2; i += 3)
        check_samples(s, i / 3, i, i + 1, 0);
    for (uint32_t i = 0; i < COUNT / 2 + COUNT / 3; i++)
        if (i >= COUNT / 2 || i % 3 == 0)
            CHECK_OK(sluiceRemoveDemandTexture(s->r.loader, s->ids[i]));
    assert_int_equal(runner_statistics(&s->r).tailPageCount, 0);
    assert_int_equal(runner_statistics(&s->r).residentTileCount, 0);
    small_destroy(s);
}

/* Formats and sizes have pages of their own: 1x1 to 64x64, wide and high. */
static void textures_of_all_sizes_keep_their_texels(void **state)
{
    (void)state;
    const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_UNORM,
                                    SLUICE_FORMAT_R32G32B32A32_SFLOAT};
    struct small *s = small_create(NULL);
    uint32_t sizes[COUNT][2];
    for (uint32_t i = 0; i < COUNT; i++) {
        sizes[i][0] = 1 + i * 37 % 64;
        sizes[i][1] = 1 + i * 53 / 2 % 64;
        add(s, i, formats[i % 2], sizes[i][0], sizes[i][1]);
        runner_add_texel(&s->r, s->ids[i], sizes[i][0], sizes[i][1], 0, sizes[i][0] - 1,
                         sizes[i][1] - 1);
        runner_add_texel(&s->r, s->ids[i], sizes[i][0], sizes[i][1], 0, 0, 0);
    }
    assert_in_range(runner_load(&s->r, 20), 1, 19);
    for (uint32_t i = 0; i < COUNT; i++) {
        runner_check_texel(&s->r, 2 * i, &s->images[i], 0, sizes[i][0] - 1, sizes[i][1] - 1);
        runner_check_texel(&s->r, 2 * i + 1, &s->images[i], 0, 0, 0);
    }
    small_destroy(s);
}

/* 8 MiB are 128 pages: for 384 textures. The others show their last level's color. */
static void tails_beyond_the_budget_are_refused_when_every_slot_is_taken(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .memoryBudget = 8u << 20};
    struct small *s = small_create(&info);
    for (uint32_t i = 0; i < COUNT; i++)
        add(s, i, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE);
    add_samples(s, 0, COUNT, 0);
    runner_load(&s->r, 40);
    SluiceDemandStatistics statistics = runner_statistics(&s->r);
    assert_true(statistics.tileMemorySize <= info.memoryBudget);
    assert_int_equal(statistics.tailPageCount, 128);
    assert_int_equal(statistics.residentTileCount, 384);
    small_destroy(s);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(three_textures_of_64x64_share_a_page),
        cmocka_unit_test(slots_of_removed_textures_are_taken_again),
        cmocka_unit_test(textures_of_all_sizes_keep_their_texels),
        cmocka_unit_test(tails_beyond_the_budget_are_refused_when_every_slot_is_taken),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
