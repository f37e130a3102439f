/* Textures of a set as image sources: the texels are what decoding and converting gives. */
#include "neural/neural_files.h"
#include "neural/worked_example.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include "base/checked.h"
#include "image/convert.h"

#include <sluice/neural_source.h>

#include <stdlib.h>
#include <string.h>

enum { SIZE = 32 };

static SluiceImageSource *create(SluiceNeuralSet *set, uint32_t texture)
{
    SluiceImageSource *source = NULL;
    CHECK_OK(sluiceCreateNeuralImageSource(
        &(SluiceNeuralImageSourceCreateInfo){.structSize =
                                                 sizeof(SluiceNeuralImageSourceCreateInfo),
                                             .set = set,
                                             .textureIndex = texture},
        &source));
    return source;
}

/* RGBA floats of a rectangle that starts at (x, y), from all latents. */
static void decode(SluiceNeuralSet *set, const SluiceNeuralTexture *texture, uint32_t mip,
                   const SluiceImageRegion *r, float *rgba)
{
    SluiceNeuralConstants constants;
    uint64_t latent_size = 0, weight_size = 0;
    float channels[SIZE * SIZE * 4];
    CHECK_OK(sluiceReadNeuralLatents(set, NULL, &constants, &latent_size, NULL));
    void *latents = malloc(latent_size);
    CHECK_OK(sluiceReadNeuralLatents(set, NULL, &constants, &latent_size, latents));
    CHECK_OK(sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &weight_size, NULL));
    void *weights = malloc(weight_size);
    CHECK_OK(sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &weight_size, weights));
    SluiceNeuralDecodeInfo info = {.structSize = sizeof info,
                                   .pConstants = &constants,
                                   .pLatents = latents,
                                   .latentSize = latent_size,
                                   .pWeights = weights,
                                   .weightSize = weight_size,
                                   .mip = mip,
                                   .x = r->x,
                                   .y = r->y,
                                   .width = r->width,
                                   .height = r->height,
                                   .firstChannel = texture->firstChannel,
                                   .channelCount = texture->channelCount,
                                   .pTexels = channels};
    CHECK_OK(sluiceDecodeNeuralTexels(&info));
    for (uint32_t i = 0; i < r->width * r->height; i++) {
        rgba[4 * i] = rgba[4 * i + 1] = rgba[4 * i + 2] = 0;
        rgba[4 * i + 3] = 1;
        for (uint32_t c = 0; c < texture->channelCount; c++) {
            SluiceNeuralColorSpace from;
            CHECK_OK(sluiceGetNeuralChannel(set, texture->firstChannel + c, &from));
            rgba[4 * i + c] = sluiceConvertNeuralColor(channels[i * texture->channelCount + c],
                                                       from, SLUICE_NEURAL_COLOR_LINEAR);
        }
    }
    free(latents);
    free(weights);
}

/* Largest difference in linear light of any texel that both have. */
static float worst(SluiceNeuralSet *set, uint32_t index, uint32_t mip, const SluiceImageRegion *r)
{
    SluiceNeuralTexture texture = {.structSize = sizeof texture};
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceImageSource *source = create(set, index);
    static float expected[SIZE * SIZE * 4], found[SIZE * SIZE * 4];
    static uint8_t texels[SIZE * SIZE * 8];
    float difference = 0;
    CHECK_OK(sluiceGetNeuralTexture(set, index, &texture));
    CHECK_OK(sluiceGetImageInfo(source, &info));
    uint32_t texel_size = sluiceGetFormatTexelSize(info.format);
    CHECK_OK(sluiceReadImageRegion(source, r, texels, (size_t)SIZE * texel_size));
    decode(set, &texture, mip, r, expected);
    for (uint32_t y = 0; y < r->height; y++) {
        float *row = found + (size_t)y * r->width * 4;
        slc_texels_to_rgba(info.format, texels + (size_t)y * SIZE * texel_size, row, r->width);
        for (uint32_t i = 0; i < r->width; i++)
            for (uint32_t c = 0; c < texture.channelCount; c++) {
                float a = row[4 * i + c], b = expected[((size_t)y * r->width + i) * 4 + c];
                /* formats for colors that stay as the network gives them */
                bool encoded = info.format != SLUICE_FORMAT_R8G8B8A8_SRGB &&
                               texture.rgbColorSpace == SLUICE_NEURAL_COLOR_SRGB && c < 3;
                if (encoded)
                    a = sluiceConvertNeuralColor(a, SLUICE_NEURAL_COLOR_SRGB,
                                                 SLUICE_NEURAL_COLOR_LINEAR);
                b = b < 0 ? 0 : b > 1 ? 1 : b;
                float d = a > b ? a - b : b - a;
                difference = d > difference ? d : difference;
            }
    }
    sluiceDestroyImageSource(source);
    return difference;
}

static void texels_are_those_of_the_decoder(void **state)
{
    static const char *const samples[] = {"v7_64_g.ntc", "v9_64_g.ntc", "v9_300x200.ntc"};
    (void)state;
    for (size_t s = 0; s < sizeof samples / sizeof samples[0]; s++) {
        char path[512];
        if (!find_neural_sample(samples[s], path, sizeof path))
            SKIP_TEST("the sample is not there");
        SluiceNeuralSet *set = open_neural_sample(path);
        SluiceNeuralSetInfo info = {.structSize = sizeof info};
        CHECK_OK(sluiceGetNeuralSetInfo(set, &info));
        for (uint32_t t = 0; t < info.textureCount; t++)
            for (uint32_t mip = 0; mip < info.mipCount; mip++) {
                uint32_t width = slc_mip_size(info.width, mip),
                         height = slc_mip_size(info.height, mip);
                SluiceImageRegion r = {.mipLevel = mip, .x = width / 3, .y = height / 5};
                r.width = slc_min_u32(SIZE, width - r.x);
                r.height = slc_min_u32(SIZE, height - r.y);
                float difference = worst(set, t, mip, &r);
                if (!(difference <= 0.6f / 255 * 2.4f)) /* half a step, where sRGB is steepest */
                    fail_msg("%s, texture %u, mip %u: %.9g", samples[s], t, mip,
                             (double)difference);
            }
        sluiceDestroyNeuralSet(set);
    }
}

static void hdr_textures_are_linear_floats(void **state)
{
    char path[512];
    (void)state;
    if (!find_neural_sample("v9_window_b5_20k.ntc", path, sizeof path))
        SKIP_TEST("the sample is not there");
    SluiceNeuralSet *set = open_neural_sample(path);
    SluiceImageSource *source = create(set, 0);
    SluiceImageInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetImageInfo(source, &info));
    assert_int_equal(info.format, SLUICE_FORMAT_R16G16B16A16_SFLOAT);
    assert_int_equal(info.width, 512);
    assert_int_equal(info.mipLevelCount, 10);
    sluiceDestroyImageSource(source);
    sluiceDestroyNeuralSet(set);
}

static uint8_t example[WORKED_EXAMPLE_MAX_SIZE];
static size_t example_size;

/* Opens, reads and destroys, with a set that the source owns. */
static SluiceResult try_read(const SluiceAllocationCallbacks *cb)
{
    SluiceNeuralSet *set = NULL;
    SluiceImageSource *source = NULL;
    uint8_t texels[4 * 4 * 4];
    SluiceResult result = open_neural_bytes(example, example_size, cb, &set);
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateNeuralImageSource(
            &(SluiceNeuralImageSourceCreateInfo){.structSize =
                                                     sizeof(SluiceNeuralImageSourceCreateInfo),
                                                 .ownedSet = set,
                                                 .pAllocator = cb},
            &source);
    if (result == SLUICE_SUCCESS)
        result = sluiceReadImageRegion(source, &(SluiceImageRegion){.width = 4, .height = 4},
                                       texels, 16);
    sluiceDestroyImageSource(source);
    return result;
}

static void every_refused_allocation_of_a_source_is_survived(void **state)
{
    struct failing_allocator allocator;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    uint32_t allowed = 0;
    (void)state;
    example_size = write_worked_example(example);
    for (; result != SLUICE_SUCCESS; allowed++) {
        failing_allocator_init(&allocator, allowed);
        result = try_read(&allocator.callbacks);
        assert_int_equal(allocator.live_count, 0);
        if (result != SLUICE_SUCCESS)
            assert_int_equal(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
    }
    assert_true(allowed > 3);
}

/* Whatever is wrong with the other arguments, once the info could be read. */
static void an_owned_set_is_destroyed_if_creation_fails(void **state)
{
    struct failing_allocator allocator;
    (void)state;
    example_size = write_worked_example(example);
    for (int wrong = 0; wrong < 4; wrong++) {
        SluiceNeuralSet *set = NULL, *other = NULL;
        SluiceImageSource *source = NULL;
        failing_allocator_init(&allocator, UINT64_MAX);
        CHECK_OK(open_neural_bytes(example, example_size, &allocator.callbacks, &set));
        CHECK_OK(open_neural_bytes(example, example_size, NULL, &other));
        SluiceNeuralImageSourceCreateInfo info = {
            .structSize = sizeof info,
            .set = wrong == 1 ? other : NULL,
            .ownedSet = set,
            .textureIndex = wrong == 2,
            .weights = wrong == 3 ? SLUICE_NEURAL_WEIGHTS_FP8 : SLUICE_NEURAL_WEIGHTS_INT8};
        assert_true(sluiceCreateNeuralImageSource(&info, wrong ? &source : NULL) < 0);
        assert_int_equal(allocator.live_count, 0);
        sluiceDestroyNeuralSet(other);
    }
}

static void textures_that_do_not_exist_are_refused(void **state)
{
    SluiceNeuralSet *set = NULL;
    SluiceImageSource *source = NULL;
    (void)state;
    example_size = write_worked_example(example);
    CHECK_OK(open_neural_bytes(example, example_size, NULL, &set));
    SluiceNeuralImageSourceCreateInfo info = {
        .structSize = sizeof info, .set = set, .textureIndex = 1};
    CHECK_RESULT(sluiceCreateNeuralImageSource(&info, &source), SLUICE_ERROR_INVALID_ARGUMENT);
    info.textureIndex = 0;
    info.set = NULL;
    CHECK_RESULT(sluiceCreateNeuralImageSource(&info, &source), SLUICE_ERROR_NULL_POINTER);
    info.set = set;
    info.weights = SLUICE_NEURAL_WEIGHTS_FP8; /* the example has none */
    CHECK_RESULT(sluiceCreateNeuralImageSource(&info, &source), SLUICE_ERROR_UNSUPPORTED);
    assert_null(source);
    sluiceDestroyNeuralSet(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_those_of_the_decoder),
        cmocka_unit_test(hdr_textures_are_linear_floats),
        cmocka_unit_test(every_refused_allocation_of_a_source_is_survived),
        cmocka_unit_test(an_owned_set_is_destroyed_if_creation_fails),
        cmocka_unit_test(textures_that_do_not_exist_are_refused),
    };
    return RUN_TESTS(tests);
}
