/* Files that cannot be read for a while: in the end everything is there, and few reads are wasted.
 */
#include "device/demand_runner.h"

#include "support/test.h"

#include <string.h>

enum { SIZE = 1024, TILE = 128, TILES = SIZE / TILE };

static struct harness h;

/* Delays of retries: at once, and never without a call. */
static const uint64_t soon = 1, never = UINT64_MAX;

static SluiceDemandLoaderCreateInfo quick_retries(uint64_t delay)
{
    return (SluiceDemandLoaderCreateInfo){.structSize = sizeof(SluiceDemandLoaderCreateInfo),
                                          .failureRetryDelayNs = delay};
}

/* Level 0 cannot be read while it is out. */
struct outage {
    SluiceImageSource base;
    SluiceImageSource *inner;
    atomic_bool is_out;
    atomic_uint refused;
};

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct outage *)base)->inner, info);
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct outage *outage = (struct outage *)base;
    if (region->mipLevel == 0 && atomic_load(&outage->is_out)) {
        atomic_fetch_add(&outage->refused, 1);
        return SLUICE_ERROR_IO;
    }
    return sluiceReadImageRegion(outage->inner, region, texels, row_pitch);
}

static void destroy(SluiceImageSource *base)
{
    (void)base;
}

static const SluiceImageSourceInterface outage_interface = {sizeof outage_interface, get_info,
                                                            read_region, destroy};

struct scene {
    struct runner r;
    struct runner_image image;
    struct outage outage;
    SluiceDemandTextureId id;
};

/* Every tile of level 0 is sampled, and none can be read. */
static void begin_outage(struct scene *s, uint64_t delay)
{
    const SluiceDemandLoaderCreateInfo info = quick_retries(delay);
    memset(s, 0, sizeof *s);
    runner_init(&s->r, &h, &info);
    runner_image_init(&s->image, SLUICE_FORMAT_R8G8B8A8_UNORM, SIZE, SIZE, 1);
    s->outage = (struct outage){
        .base.pInterface = &outage_interface, .inner = s->image.inner, .is_out = true};
    const SluiceDemandTextureCreateInfo texture = {
        .structSize = sizeof texture, .image.source = &s->outage.base, .pSampler = &runner_nearest};
    CHECK_OK(sluiceAddDemandTexture(s->r.loader, &texture, &s->id));
    for (uint32_t i = 0; i < TILES * TILES; i++)
        runner_add_texel(&s->r, s->id, SIZE, SIZE, 0, i % TILES * TILE, i / TILES * TILE);
}

static void check_sharp(struct scene *s)
{
    for (uint32_t i = 0; i < TILES * TILES; i++)
        runner_check_texel(&s->r, i, &s->image, 0, i % TILES * TILE, i / TILES * TILE);
}

static void end_outage(struct scene *s)
{
    runner_finish(&s->r);
    runner_image_finish(&s->image);
}

static void after_an_outage_every_tile_comes_by_itself(void **state)
{
    (void)state;
    static struct scene s;
    h.quiet = true;
    begin_outage(&s, soon);
    uint32_t warnings = h.log_count[SLUICE_LOG_WARNING];
    runner_load(&s.r, 5);
    uint32_t first = s.outage.refused;
    assert_true(first >= 2 * TILES * TILES);
    runner_load(&s.r, 50);
    assert_true(s.outage.refused > first);
    /* Four tiles a launch, twice each; and for each coarser tile, which comes instead. */
    assert_true(s.outage.refused <= 2 * TILES * TILES + (55 + 16 + 4 + 1) * 4 * 2);
    assert_int_equal(h.log_count[SLUICE_LOG_WARNING], warnings + 1);
    s.outage.is_out = false;
    assert_true(runner_load(&s.r, 12) < 12); /* the others follow the first that comes */
    check_sharp(&s);
    assert_true(runner_statistics(&s.r).retriedCount >= TILES * TILES);
    assert_int_equal(h.log_count[SLUICE_LOG_WARNING], warnings + 1);
    end_outage(&s);
    h.quiet = false;
}

static void a_texture_that_is_said_to_be_well_is_read_at_once(void **state)
{
    (void)state;
    static struct scene s;
    h.quiet = true;
    for (int all = 0; all < 2; all++) {
        begin_outage(&s, never);
        runner_load(&s.r, 9);
        assert_int_equal(s.r.requests.missingCount, 0);
        s.outage.is_out = false;
        runner_launch(&s.r);
        assert_int_equal(s.r.requests.missingCount, 0); /* nobody asks */
        CHECK_OK(sluiceRetryDemandTexture(s.r.loader, all ? SLUICE_ALL_DEMAND_TEXTURES : s.id));
        assert_true(runner_load(&s.r, 6) < 6);
        check_sharp(&s);
        assert_int_equal(runner_statistics(&s.r).retriedCount, TILES * TILES);
        end_outage(&s);
    }
    h.quiet = false;
}

/* The tail, too: the texture shows its failure color meanwhile. */
static void a_texture_that_was_lost_altogether_comes_back(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    const SluiceDemandLoaderCreateInfo info =
        quick_retries(never); /* or no coarser tile is tried */
    h.quiet = true;
    runner_init(&r, &h, &info);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 512, 512, 1);
    image.source.fail_at = 2; /* after the color of the last level */
    image.source.fails_on = true;
    image.source.failure = SLUICE_ERROR_IO;
    runner_add_texel(&r, runner_add_texture(&r, &image), 512, 512, 0, 9, 9);
    runner_load(&r, 20);
    assert_int_equal(image.closed, 1);
    image.source.fail_at = 0;
    CHECK_OK(sluiceRetryDemandTexture(r.loader, SLUICE_ALL_DEMAND_TEXTURES));
    assert_true(runner_load(&r, 12) < 12);
    runner_check_texel(&r, 0, &image, 0, 9, 9);
    runner_finish(&r);
    runner_image_finish(&image);
    h.quiet = false;
}

static void textures_that_could_not_be_opened_are_opened_later(void **state)
{
    (void)state;
    static const SluiceResult results[] = {SLUICE_ERROR_FILE_NOT_FOUND, SLUICE_ERROR_IO,
                                           SLUICE_ERROR_CORRUPT_DATA, SLUICE_NOT_READY};
    enum { COUNT = sizeof results / sizeof *results };
    struct runner r;
    struct runner_image images[COUNT];
    const SluiceDemandLoaderCreateInfo info = quick_retries(soon);
    h.quiet = true;
    runner_init(&r, &h, &info);
    for (uint32_t i = 0; i < COUNT; i++) {
        runner_image_init(&images[i], SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, i);
        images[i].open_result = results[i];
        runner_add_texel(&r, runner_add_texture(&r, &images[i]), 300, 300, 0, 9, 9);
    }
    uint32_t errors = h.log_count[SLUICE_LOG_ERROR];
    runner_load(&r, 20);
    assert_int_equal(h.log_count[SLUICE_LOG_ERROR], errors + COUNT - 1); /* each once */
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_true(images[i].opened > 2 && images[i].opened <= 2 * 20);
        images[i].open_result = SLUICE_SUCCESS;
    }
    assert_true(runner_load(&r, 12) < 12);
    for (uint32_t i = 0; i < COUNT; i++)
        runner_check_texel(&r, i, &images[i], 0, 9, 9);
    runner_finish(&r);
    for (uint32_t i = 0; i < COUNT; i++)
        runner_image_finish(&images[i]);
    h.quiet = false;
}

struct fills {
    atomic_bool is_out;
    atomic_uint refused;
};

static SluiceResult fill(void *user, uint32_t page, uint64_t *value)
{
    struct fills *fills = user;
    if (atomic_load(&fills->is_out)) {
        atomic_fetch_add(&fills->refused, 1);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    *value = page;
    return SLUICE_SUCCESS;
}

static void values_that_could_not_be_found_are_found_later(void **state)
{
    (void)state;
    enum { PAGES = 40 };
    struct runner r;
    struct fills fills = {true, 0};
    SluiceDemandResourceId id;
    uint32_t first;
    const SluiceDemandLoaderCreateInfo info = quick_retries(soon);
    const SluiceDemandResourceCreateInfo resource = {
        .structSize = sizeof resource, .pageCount = PAGES, .pUserData = &fills, .pfnFill = fill};
    h.quiet = true;
    runner_init(&r, &h, &info);
    CHECK_OK(sluiceAddDemandResource(r.loader, &resource, &id, &first));
    for (uint32_t i = 0; i < PAGES; i++)
        runner_add_page(&r, first + i);
    for (uint32_t i = 0; i < 10; i++) {
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
    assert_in_range(fills.refused, PAGES + 4, PAGES + 10 * 4);
    fills.is_out = false;
    for (uint32_t i = 0; i < 10; i++) {
        runner_launch(&r);
        CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    }
    assert_true(runner_all_resident(&r));
    runner_finish(&r);
    h.quiet = false;
}

static void textures_may_go_while_they_wait_to_be_tried_again(void **state)
{
    (void)state;
    static struct scene s;
    h.quiet = true;
    begin_outage(&s, soon);
    runner_load(&s.r, 5);
    CHECK_OK(sluiceInvalidateDemandTexture(s.r.loader, s.id));
    runner_load(&s.r, 5);
    CHECK_OK(sluiceRemoveDemandTexture(s.r.loader, s.id));
    SluiceDemandTextureId stale = s.id;
    struct runner_image other;
    runner_image_init(&other, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 2);
    runner_clear(&s.r);
    runner_add_texel(&s.r, runner_add_texture(&s.r, &other), 300, 300, 0, 9, 9);
    assert_true(runner_load(&s.r, 12) < 12);
    runner_check_texel(&s.r, 0, &other, 0, 9, 9);
    CHECK_RESULT(sluiceRetryDemandTexture(s.r.loader, stale), SLUICE_ERROR_STALE_TEXTURE);
    CHECK_RESULT(sluiceRetryDemandTexture(s.r.loader, 99), SLUICE_ERROR_UNKNOWN_TEXTURE);
    CHECK_RESULT(sluiceRetryDemandTexture(s.r.loader, SLUICE_NO_DEMAND_TEXTURE),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceRetryDemandTexture(NULL, 0), SLUICE_ERROR_NULL_POINTER);
    end_outage(&s);
    runner_image_finish(&other);
    h.quiet = false;
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(after_an_outage_every_tile_comes_by_itself),
        cmocka_unit_test(a_texture_that_is_said_to_be_well_is_read_at_once),
        cmocka_unit_test(a_texture_that_was_lost_altogether_comes_back),
        cmocka_unit_test(textures_that_could_not_be_opened_are_opened_later),
        cmocka_unit_test(values_that_could_not_be_found_are_found_later),
        cmocka_unit_test(textures_may_go_while_they_wait_to_be_tried_again),
    };
    CHECK_OK(harness_set_context(&h, &(SluiceVulkanContextCreateInfo){.readRetry = {2, 1, 1}}));
    return harness_finish(&h, RUN_TESTS(tests));
}
