/* Ids of a demand loader whose index has no generations left never name another object. */
#include "device/demand_runner.h"
#include "extremes/note.h"

#include "demand_vulkan/loader.h"

static struct harness h;

enum { ROUNDS = 20 };

static SluiceResult fill(void *user, uint32_t page, uint64_t *value)
{
    (void)user;
    *value = page;
    return SLUICE_SUCCESS;
}

/* Runs launches until a destroyed texture's index is free. */
static void pass_launches(struct runner *r)
{
    runner_clear(r);
    for (uint32_t i = 0; i < 3; i++)
        runner_launch(r);
}

static void a_texture_of_the_last_generation_is_the_last_of_its_index(void **state)
{
    (void)state;
    struct runner r;
    struct runner_image image;
    SluiceDemandTextureId ids[ROUNDS];
    uint32_t repeated = 0;
    runner_init(&r, &h, NULL);
    runner_image_init(&image, SLUICE_FORMAT_R8G8B8A8_UNORM, 300, 300, 1);
    for (uint32_t i = 0; i < ROUNDS; i++) {
        ids[i] = runner_add_texture(&r, &image);
        for (uint32_t j = 0; j < i; j++)
            repeated += ids[i] == ids[j];
        if (i == 1) /* 2^32 textures would take too long, so the counter is set */
            r.loader->textures[(uint32_t)ids[1]].generation = UINT32_MAX - 1;
        if (i == 1)
            ids[1] = (uint64_t)(UINT32_MAX - 1) << 32 | (uint32_t)ids[1];
        runner_clear(&r);
        runner_add_texel(&r, ids[i], 300, 300, 0, 5, 5);
        runner_load(&r, 9);
        runner_check_texel(&r, 0, &image, 0, 5, 5);
        CHECK_OK(sluiceRemoveDemandTexture(r.loader, ids[i]));
        pass_launches(&r);
        for (uint32_t j = 0; j <= i; j++)
            CHECK_RESULT(sluiceInvalidateDemandTexture(r.loader, ids[j]),
                         SLUICE_ERROR_STALE_TEXTURE);
    }
    assert_true(ids[2] >> 32 == UINT32_MAX && (uint32_t)ids[2] == (uint32_t)ids[1]);
    assert_true((uint32_t)ids[3] != (uint32_t)ids[2]);
    note("demand textures after the last generation: repeated ids", ROUNDS, repeated, 0);
    assert_int_equal(repeated, 0);
    runner_finish(&r);
    runner_image_finish(&image);
}

static void a_resource_of_the_last_generation_is_the_last_of_its_index(void **state)
{
    (void)state;
    struct runner r;
    const SluiceDemandResourceCreateInfo info = {
        .structSize = sizeof info, .pageCount = 10, .pfnFill = fill};
    SluiceDemandResourceId ids[ROUNDS];
    uint32_t first, repeated = 0;
    runner_init(&r, &h, NULL);
    for (uint32_t i = 0; i < ROUNDS; i++) {
        CHECK_OK(sluiceAddDemandResource(r.loader, &info, &ids[i], &first));
        for (uint32_t j = 0; j < i; j++)
            repeated += ids[i] == ids[j];
        if (i == 1) {
            r.loader->resources[(uint32_t)ids[1] - 1]->generation = UINT32_MAX - 1;
            ids[1] = (uint64_t)(UINT32_MAX - 1) << 32 | (uint32_t)ids[1];
        }
        CHECK_OK(sluiceInvalidateDemandPages(r.loader, ids[i], 0, 10));
        CHECK_OK(sluiceRemoveDemandResource(r.loader, ids[i]));
        pass_launches(&r);
        for (uint32_t j = 0; j <= i; j++)
            assert_true(sluiceInvalidateDemandPages(r.loader, ids[j], 0, 1) < 0);
    }
    assert_true(ids[2] >> 32 == UINT32_MAX && (uint32_t)ids[2] == (uint32_t)ids[1]);
    assert_true((uint32_t)ids[3] != (uint32_t)ids[2]);
    note("demand resources after the last generation: repeated ids", ROUNDS, repeated, 0);
    assert_int_equal(repeated, 0);
    runner_finish(&r);
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_texture_of_the_last_generation_is_the_last_of_its_index),
        cmocka_unit_test(a_resource_of_the_last_generation_is_the_last_of_its_index),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
