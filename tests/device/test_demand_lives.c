/* Adds, changes and removes textures at random during launches. Pictures must stay right. */
#include "device/demand_runner.h"

#include "support/test.h"

static struct harness h;

enum { IMAGES = 12, SLOTS = 24, STEPS = 1500, SAMPLES = 6 };

static uint32_t random_state = 1;

static uint32_t random_below(uint32_t limit)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)(random_state >> 8) * limit >> 24);
}

/* A texture or nothing, with its image and the samples of a launch. */
struct slot {
    SluiceDemandTextureId id, variant;
    uint32_t image;
};

struct life {
    struct runner r;
    struct runner_image images[IMAGES];
    struct slot slots[SLOTS];
    struct {
        uint32_t slot, level, x, y;
    } samples[SLOTS * SAMPLES];
    uint32_t launched;
};

static void init(struct life *life, const SluiceDemandLoaderCreateInfo *info)
{
    static const uint32_t sizes[IMAGES][2] = {{1, 1},     {300, 200}, {64, 64},    {2048, 100},
                                              {700, 700}, {33, 1000}, {1024, 512}, {65, 65},
                                              {5, 3},     {512, 512}, {129, 257},  {900, 40}};
    *life = (struct life){.launched = 0};
    runner_init(&life->r, &h, info);
    for (uint32_t i = 0; i < IMAGES; i++) {
        runner_image_init(&life->images[i],
                          i % 3 ? SLUICE_FORMAT_R8G8B8A8_UNORM : SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                          sizes[i][0], sizes[i][1], i);
        life->images[i].source.delay_us = i % 4 == 0 ? 300 : 0;
    }
}

static void create(struct life *life, struct slot *slot)
{
    slot->image = random_below(IMAGES);
    slot->id = runner_add_texture(&life->r, &life->images[slot->image]);
    slot->variant = 0;
}

static void change(struct life *life, struct slot *slot)
{
    SluiceDemandLoader *loader = life->r.loader;
    SluiceDemandImage image;
    switch (random_below(8)) {
    case 0:
    case 1:
        CHECK_OK(sluiceRemoveDemandTexture(loader, slot->id));
        *slot = (struct slot){0};
        break;
    case 2:
    case 3:
        slot->image = random_below(IMAGES);
        image = runner_image_desc(&life->images[slot->image]);
        CHECK_OK(sluiceReplaceDemandImage(loader, slot->id, &image));
        break;
    case 4: CHECK_OK(sluiceInvalidateDemandTexture(loader, slot->id)); break;
    case 5:
        if (slot->variant)
            CHECK_OK(sluiceRemoveDemandTexture(loader, slot->variant));
        CHECK_OK(sluiceAddDemandTextureVariant(loader, slot->id, &runner_nearest, &slot->variant));
        break;
    case 6: CHECK_OK(sluicePreloadDemandTexture(loader, slot->id, random_below(12), NULL)); break;
    default:
        if (life->r.ticket)
            CHECK_OK(sluiceCancelDemandTicket(loader, life->r.ticket));
        break;
    }
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static void choose_samples(struct life *life)
{
    runner_clear(&life->r);
    for (uint32_t s = 0; s < SLOTS; s++)
        for (uint32_t i = 0; i < SAMPLES && life->slots[s].id; i++) {
            const struct slot *slot = &life->slots[s];
            const SluiceImageInfo *info = &life->images[slot->image].info;
            uint32_t level = random_below(info->mipLevelCount), at = life->r.count;
            life->samples[at].slot = s;
            life->samples[at].level = level;
            life->samples[at].x = random_below(level_size(info->width, level));
            life->samples[at].y = random_below(level_size(info->height, level));
            runner_add_texel(&life->r, slot->variant && i % 2 ? slot->variant : slot->id,
                             info->width, info->height, level, life->samples[at].x,
                             life->samples[at].y);
        }
}

static void check(struct life *life)
{
    for (uint32_t i = 0; i < life->r.count; i++)
        runner_check_texel(&life->r, i, &life->images[life->slots[life->samples[i].slot].image],
                           life->samples[i].level, life->samples[i].x, life->samples[i].y);
}

static void launch(struct life *life)
{
    if (runner_submit(&life->r) == SLUICE_SUCCESS)
        life->launched++;
    if (random_below(2))
        return; /* in flight while more changes */
    if (sluiceProcessDemandRequests(life->r.loader, &life->r.launch, UINT64_MAX, &life->r.requests,
                                    &life->r.ticket) == SLUICE_SUCCESS &&
        random_below(2))
        CHECK_OK(sluiceWaitDemandTicket(life->r.loader, life->r.ticket, UINT64_MAX, NULL));
}

static void settle(struct life *life)
{
    SluiceResult result = sluiceProcessDemandRequests(life->r.loader, &life->r.launch, UINT64_MAX,
                                                      &life->r.requests, &life->r.ticket);
    assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_INVALID_ARGUMENT);
    choose_samples(life);
    assert_in_range(runner_load(&life->r, 60), 1, 59);
    check(life);
}

static void live(struct life *life, uint32_t step)
{
    struct slot *slot = &life->slots[random_below(SLOTS)];
    if (slot->id)
        change(life, slot);
    else
        create(life, slot);
    if (random_below(3) == 0)
        launch(life);
    if (step % 50 == 49)
        settle(life);
}

static void run(const SluiceDemandLoaderCreateInfo *info)
{
    static struct life life;
    init(&life, info);
    for (uint32_t step = 0; step < STEPS; step++)
        live(&life, step);
    assert_true(life.launched > STEPS / 10);
    assert_true(runner_statistics(&life.r).texturesOpened > SLOTS);
    runner_finish(&life.r);
    for (uint32_t i = 0; i < IMAGES; i++) {
        assert_int_equal(life.images[i].opened, life.images[i].closed);
        runner_image_finish(&life.images[i]);
    }
}

static void pictures_stay_right_with_memory_for_all(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .maxTextureCount = 3 * SLOTS};
    run(&info);
}

static void pictures_stay_right_with_little_memory_and_few_reads(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info,
                                               .memoryBudget = 24u << 20,
                                               .maxTilesInFlight = 7,
                                               .maxRequestsPerLaunch = 5,
                                               .maxTextureCount = 3 * SLOTS};
    run(&info);
}

/* The image is opened for the first launch, replaced, and opened again for the second, between two
 * other launches. */
static void a_preload_ends_with_the_image_that_it_was_asked_for(void **state)
{
    (void)state;
    const SluiceDemandLoaderCreateInfo info = {.structSize = sizeof info, .maxTilesInFlight = 4};
    struct runner r;
    struct runner_image images[2];
    SluiceDemandTicket preload;
    SluiceDemandTicketStatus status = {.structSize = sizeof status};
    runner_init(&r, &h, &info);
    runner_image_init(&images[0], SLUICE_FORMAT_R8G8B8A8_UNORM, 2048, 2048, 1);
    runner_image_init(&images[1], SLUICE_FORMAT_R8G8B8A8_UNORM, 8, 8, 2);
    SluiceDemandTextureId id = runner_add_texture(&r, &images[0]);
    runner_add_texel(&r, id, 8, 8, 0, 2, 2);
    CHECK_OK(runner_submit(&r)); /* requests the texture */
    const SluiceDemandLaunch asks = r.launch;
    CHECK_OK(sluicePreloadDemandTexture(r.loader, id, 0, &preload));
    CHECK_OK(sluiceWaitDemandTicket(r.loader, preload, UINT64_MAX, NULL));
    CHECK_OK(runner_submit(&r)); /* its tiles are read, because it is open */
    const SluiceDemandImage other = runner_image_desc(&images[1]);
    CHECK_OK(sluiceReplaceDemandImage(r.loader, id, &other));
    CHECK_OK(sluiceProcessDemandRequests(r.loader, &asks, UINT64_MAX, &r.requests, &r.ticket));
    assert_int_equal(r.requests.servedCount, 1);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, r.ticket, UINT64_MAX, NULL));
    CHECK_OK(sluiceProcessDemandRequests(r.loader, &r.launch, UINT64_MAX, &r.requests, NULL));
    runner_load(&r, 9);
    runner_check_texel(&r, 0, &images[1], 0, 2, 2);
    CHECK_OK(sluiceWaitDemandTicket(r.loader, preload, UINT64_MAX, &status));
    assert_int_equal(status.remainingCount, 0);
    assert_int_equal(runner_statistics(&r).residentTileCount, 1);
    runner_finish(&r);
    runner_image_finish(&images[0]);
    runner_image_finish(&images[1]);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_stay_right_with_memory_for_all),
        cmocka_unit_test(pictures_stay_right_with_little_memory_and_few_reads),
        cmocka_unit_test(a_preload_ends_with_the_image_that_it_was_asked_for),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
