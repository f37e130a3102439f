/* Cut-outs keep the share of texels that are there, in every level. */
#include "bake/baked.h"
#include "bake/coverage.h"

#include "base/alloc.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <math.h>
#include <stdlib.h>

#define SIZE 512

/* Leaves: soft-edged discs at random places, which box filters alone would wear away. Their alphas
   are many, so that no two shares of texels lie far apart. */
static uint8_t *make_leaves(uint32_t count, double radius)
{
    uint8_t *rgba = calloc(4 * SIZE * SIZE, 1);
    uint32_t random = 9;
    for (uint32_t i = 0; i < count; i++) {
        double place[2];
        for (int axis = 0; axis < 2; axis++) {
            random = random * 1664525u + 1013904223u;
            place[axis] = random * 0x1p-32 * SIZE;
        }
        double cx = place[0], cy = place[1];
        for (int y = (int)cy - 16; y < (int)cy + 16; y++)
            for (int x = (int)cx - 16; x < (int)cx + 16; x++) {
                double alpha = 255 * (radius + 2 - hypot(x - cx, y - cy)) / 4;
                uint8_t *texel = rgba + 4 * ((y & 511) * SIZE + (x & 511));
                texel[1] = 120;
                if (alpha > texel[3])
                    texel[3] = alpha > 255 ? 255 : (uint8_t)alpha;
            }
    }
    return rgba;
}

static double covered(const char *path, uint32_t level, double threshold)
{
    uint32_t width, height, count = 0;
    float *rgba = read_level(path, level, &width, &height);
    for (uint32_t i = 0; i < width * height; i++)
        count += (double)rgba[4 * i + 3] >= threshold;
    free(rgba);
    return (double)count / (width * height);
}

/* Within one in a hundred texels, and one texel. */
static void check_kept(uint32_t leaves, double radius, float cutout, SluiceFormat format)
{
    struct bake_folder folder;
    char path[256];
    struct plain_source source;
    uint8_t *rgba = make_leaves(leaves, radius);
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .format = format,
                                   .alpha = SLUICE_BAKE_ALPHA_STRAIGHT,
                                   .cutout = cutout};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "leaves.store", path);
    plain_source_init(&source, SLUICE_FORMAT_R8G8B8A8_SRGB, SIZE, SIZE, rgba);
    bake_source(&source.base, path, &settings);
    double wanted = covered(path, 0, (double)cutout);
    for (uint32_t level = 1; level < 8; level++) {
        double got = covered(path, level, (double)cutout), texels = SIZE * SIZE >> 2 * level;
        if (fabs(got - wanted) > 0.01 + 1 / texels)
            fail_msg("cutout %g level %u: %g is covered, not %g", (double)cutout, level, got,
                     wanted);
    }
    free(rgba);
    bake_folder_finish(&folder);
}

static void coverage_is_kept(void **state)
{
    (void)state;
    check_kept(2500, 3, 0.5f, SLUICE_FORMAT_R8G8B8A8_SRGB);
    check_kept(2500, 3, 0.3f, SLUICE_FORMAT_R8G8B8A8_SRGB);
    check_kept(2500, 3, 0.9f, SLUICE_FORMAT_R8G8B8A8_SRGB);
    check_kept(2500, 3, 1.0f, SLUICE_FORMAT_R8G8B8A8_SRGB);
    check_kept(1500, 2, 0.5f, SLUICE_FORMAT_R16G16B16A16_SFLOAT);
}

/* Or the tests above would show nothing. */
static void without_it_coverage_is_lost(void **state)
{
    (void)state;
    struct bake_folder folder;
    char path[256];
    struct plain_source source;
    uint8_t *rgba = make_leaves(1500, 2);
    SluiceBakeSettings settings = {.structSize = sizeof settings,
                                   .alpha = SLUICE_BAKE_ALPHA_STRAIGHT};
    bake_folder_init(&folder);
    bake_folder_file(&folder, "leaves.store", path);
    plain_source_init(&source, SLUICE_FORMAT_R8G8B8A8_SRGB, SIZE, SIZE, rgba);
    bake_source(&source.base, path, &settings);
    assert_true(covered(path, 5, 0.5) < 0.2 * covered(path, 0, 0.5));
    free(rgba);
    bake_folder_finish(&folder);
}

/* From the counts alone: of ten alphas a tenth each, the scale lets through as many as above. */
static void scales_follow_from_the_counts(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_coverage coverage;
    CHECK_OK(slc_coverage_init(&coverage, &cb, 3));
    for (int i = 0; i < 10; i++) {
        const float above[4] = {0, 0, 0, i < 3 ? 0.9f : 0.1f};
        const float below[4] = {0, 0, 0, 0.05f + 0.1f * (float)i};
        slc_coverage_add(&coverage, 0, above, 1);
        slc_coverage_add(&coverage, 1, below, 1);
        slc_coverage_add(&coverage, 2, above, 1);
    }
    float scale = slc_coverage_scale(&coverage, 1, 0.5f);
    assert_true(0.75f * scale >= 0.5f && 0.65f * scale < 0.5f); /* three in ten */
    assert_true(slc_coverage_scale(&coverage, 0, 0.5f) == 1.0f);
    assert_true(slc_coverage_scale(&coverage, 2, 0.5f) == 1.0f);
    slc_coverage_finish(&coverage, &cb);
}

static void nothing_and_everything_stay_what_they_are(void **state)
{
    (void)state;
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_coverage coverage;
    for (int full = 0; full < 2; full++) {
        const float alpha[4] = {0, 0, 0, (float)full};
        CHECK_OK(slc_coverage_init(&coverage, &cb, 2));
        for (int level = 0; level < 2; level++)
            for (int i = 0; i < 100; i++)
                slc_coverage_add(&coverage, (uint32_t)level, alpha, 1);
        float scale = slc_coverage_scale(&coverage, 1, 0.5f);
        assert_true(((float)full * scale >= 0.5f) == (full == 1));
        slc_coverage_finish(&coverage, &cb);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coverage_is_kept),
        cmocka_unit_test(without_it_coverage_is_lost),
        cmocka_unit_test(scales_follow_from_the_counts),
        cmocka_unit_test(nothing_and_everything_stay_what_they_are),
    };
    return RUN_TESTS(tests);
}
