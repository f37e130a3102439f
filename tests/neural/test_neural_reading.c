/* Properties of files, and files that contradict themselves. */
#include "neural/neural_files.h"
#include "neural/worked_example.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint8_t example[WORKED_EXAMPLE_MAX_SIZE];
static size_t example_size;

static SluiceNeuralSet *open_example(void)
{
    SluiceNeuralSet *set = NULL;
    CHECK_OK(open_neural_bytes(example, example_size, NULL, &set));
    return set;
}

static SluiceNeuralSetInfo info_of(const SluiceNeuralSet *set)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetNeuralSetInfo(set, &info));
    return info;
}

static void the_worked_example_is_described(void **state)
{
    SluiceNeuralSet *set = open_example();
    SluiceNeuralSetInfo info = info_of(set);
    SluiceNeuralTexture texture = {.structSize = sizeof texture};
    SluiceNeuralColorSpace space;
    (void)state;
    assert_int_equal(info.schema, 3);
    assert_int_equal(info.width, 4);
    assert_int_equal(info.mipCount, 1);
    assert_int_equal(info.channelCount, 2);
    assert_int_equal(info.validChannels, 3);
    assert_int_equal(info.latentImageCount, 2);
    assert_int_equal(info.gridScale, 2);
    assert_int_equal(info.highFeatures, 4);
    assert_int_equal(info.latentSize, 10);
    assert_int_equal(info.fileSize, example_size);
    CHECK_OK(sluiceGetNeuralTexture(set, 0, &texture));
    assert_string_equal(texture.pName, "two");
    assert_int_equal(texture.channelCount, 2);
    assert_int_equal(texture.format, SLUICE_NEURAL_CHANNEL_UNORM8);
    CHECK_RESULT(sluiceGetNeuralTexture(set, 1, &texture), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceGetNeuralChannel(set, 0, &space));
    assert_int_equal(space, SLUICE_NEURAL_COLOR_LINEAR);
    CHECK_OK(sluiceGetNeuralChannel(set, 1, &space));
    assert_int_equal(space, SLUICE_NEURAL_COLOR_SRGB);
    sluiceDestroyNeuralSet(set);
}

static void mips_and_latent_images_name_one_another(void **state)
{
    char path[512];
    (void)state;
    if (!find_neural_sample("v9_300x200.ntc", path, sizeof path))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    static const uint32_t FIRST[9] = {0, 0, 0, 3, 3, 5, 5, 5, 5},
                          COUNT[9] = {3, 3, 3, 2, 2, 4, 4, 4, 4};
    SluiceNeuralSet *set = open_neural_sample(path);
    for (uint32_t i = 0; i < 9; i++) {
        SluiceNeuralMip mip = {.structSize = sizeof mip};
        SluiceNeuralLatentImage image = {.structSize = sizeof image};
        CHECK_OK(sluiceGetNeuralMip(set, i, &mip));
        assert_int_equal(mip.width, 300 >> i);
        assert_int_equal(mip.firstFusedMip, FIRST[i]);
        assert_int_equal(mip.fusedMipCount, COUNT[i]);
        assert_int_equal(mip.latentImageCount, 2);
        for (uint32_t n = 0; n < 2; n++) {
            CHECK_OK(sluiceGetNeuralLatentImage(set, mip.latentImage + n, &image));
            assert_int_equal(image.firstMip, FIRST[i]);
            assert_int_equal(image.mipCount, COUNT[i]);
            assert_int_equal(image.partCount, 4);
        }
    }
    sluiceDestroyNeuralSet(set);
}

static void schema_1_has_two_grids_per_latent_image(void **state)
{
    char path[512];
    (void)state;
    if (!find_neural_sample("v7_64_g.ntc", path, sizeof path))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    SluiceNeuralSet *set = open_neural_sample(path);
    SluiceNeuralSetInfo info = info_of(set);
    SluiceNeuralLatentImage image = {.structSize = sizeof image};
    SluiceNeuralLatentPart part;
    uint64_t offset, size;
    assert_int_equal(info.schema, 1);
    assert_int_equal(info.highBits, 2);
    assert_int_equal(info.lowFeatures, 8);
    assert_int_equal(info.latentSize, 1024 + 1024 + 64 + 64);
    CHECK_OK(sluiceGetNeuralLatentImage(set, 1, &image));
    assert_int_equal(image.width, 8);
    assert_int_equal(image.lowHeight, 4);
    assert_int_equal(image.firstMip, 3);
    assert_int_equal(image.mipCount, 4);
    CHECK_OK(sluiceGetNeuralLatentPart(set, 1, 1, &part));
    assert_int_equal(part.offset, 3844 + 30912);
    assert_int_equal(part.size, 64);
    CHECK_RESULT(sluiceGetNeuralLatentPart(set, 1, 2, &part), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_OK(sluiceGetNeuralLatentRange(set, 2, 2, &offset, &size)); /* both latent images */
    assert_int_equal(offset, 3844 + 28800);
    assert_int_equal(size, 2176);
    CHECK_OK(sluiceGetNeuralLatentRange(set, 4, 3, &offset, &size));
    assert_int_equal(offset, 3844 + 30848);
    assert_int_equal(size, 128);
    CHECK_RESULT(sluiceGetNeuralLatentRange(set, 4, 4, &offset, &size),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    sluiceDestroyNeuralSet(set);
}

static void every_sample_opens(void **state)
{
    static const char *const NAMES[] = {
        "v7_512_n2.ntc", "v7_64_g.ntc",          "v9_300x200.ntc",        "v9_512_b5.ntc",
        "v9_64_g.ntc",   "v9_bronze_b5_20k.ntc", "v9_foliage_b5_20k.ntc", "v9_window_b5_20k.ntc"};
    char path[512];
    (void)state;
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        if (!find_neural_sample(NAMES[i], path, sizeof path))
            SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
        SluiceNeuralSet *set = open_neural_sample(path);
        assert_int_equal(info_of(set).schema, NAMES[i][1] == '7' ? 1 : 3);
        sluiceDestroyNeuralSet(set);
    }
}

/* Replaces text by text of equal length. */
static void replace(uint8_t *bytes, const char *from, const char *to)
{
    size_t length = strlen(from);
    assert_int_equal(length, strlen(to));
    for (size_t i = 40; i + length <= example_size; i++)
        if (memcmp(bytes + i, from, length) == 0) {
            memcpy(bytes + i, to, length);
            return;
        }
    fail_msg("%s is not there", from);
}

static void contradictions_are_refused(void **state)
{
    static const struct {
        const char *from, *to;
        SluiceResult result;
    } CASES[] = {
        {"\"schemaVersion\":3", "\"schemaVersion\":2", SLUICE_ERROR_UNSUPPORTED},
        {"\"width\":4", "\"width\":0", SLUICE_ERROR_CORRUPT_DATA},
        {"\"width\":4", "\"width\":8", SLUICE_ERROR_CORRUPT_DATA}, /* mip 0 has 4 */
        {"\"width\":4", "\"width\":-", SLUICE_ERROR_CORRUPT_DATA},
        {"\"numChannels\":2", "\"numChannels\":1", SLUICE_ERROR_CORRUPT_DATA},
        {"\"numColorMips\":1", "\"numColorMips\":9", SLUICE_ERROR_CORRUPT_DATA},
        {"\"numFeatures\":4", "\"numFeatures\":5", SLUICE_ERROR_CORRUPT_DATA},
        {"\"numFeatures\":4", "\"numFeatures\":8", SLUICE_ERROR_CORRUPT_DATA},
        {"\"firstChannel\":0", "\"firstChannel\":1", SLUICE_ERROR_CORRUPT_DATA},
        {"\"latentMip\":0", "\"latentMip\":1", SLUICE_ERROR_CORRUPT_DATA},
        {"\"latentMip\":0", "\"latentMip\":2", SLUICE_ERROR_CORRUPT_DATA},
        {"\"positionScale\":0.25", "\"positionScale\":0.00", SLUICE_ERROR_CORRUPT_DATA},
        {"\"positionScale\":0.25", "\"positionScala\":0.25", SLUICE_ERROR_CORRUPT_DATA},
        {"\"positionLod\":-0.5", "\"positionLod\":-9e9", SLUICE_ERROR_CORRUPT_DATA},
        {"\"layerViews\":[12]", "\"layerViews\":[14]", SLUICE_ERROR_CORRUPT_DATA},
        {"\"layerViews\":[12]", "\"layerViews\":[13]", SLUICE_ERROR_CORRUPT_DATA},
        {"\"layerViews\":[12]", "\"layerViews\":[  ]", SLUICE_ERROR_CORRUPT_DATA},
        {"\"sRGB\"", "\"sRGC\"", SLUICE_ERROR_CORRUPT_DATA},
        {"\"offset\":512", "\"offset\":524", SLUICE_ERROR_CORRUPT_DATA},
        {"\"name\":\"two\"", "\"name\":\"\\u0\"", SLUICE_ERROR_CORRUPT_DATA},
        {"{\"schema", "[\"schema", SLUICE_ERROR_CORRUPT_DATA},
        {"\"inputChannels\":48", "\"inputChannels\":64", SLUICE_ERROR_CORRUPT_DATA},
        {"\"outputChannels\":4", "\"outputChannels\":5", SLUICE_ERROR_CORRUPT_DATA},
        {"\"outputChannels\":16", "\"outputChannels\":15", SLUICE_ERROR_CORRUPT_DATA},
        {"\"weightView\":0", "\"weightView\":1", SLUICE_ERROR_CORRUPT_DATA},
        {"\"weightType\":\"Int8\"", "\"weightType\":\"Int9\"", SLUICE_ERROR_CORRUPT_DATA},
        {"\"scaleType\":\"Float32\"", "\"scaleType\":\"Float16\"", SLUICE_ERROR_CORRUPT_DATA},
        {"\"biasType\":\"Int32\"", "\"biasType\":\"Int8\" ", SLUICE_ERROR_CORRUPT_DATA},
        {"\"RowMajor\"", "\"ColMajor\"", SLUICE_ERROR_CORRUPT_DATA},
    };
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        SluiceNeuralSet *set = NULL;
        memcpy(bytes, example, example_size);
        replace(bytes, CASES[i].from, CASES[i].to);
        SluiceResult result = open_neural_bytes(bytes, example_size, NULL, &set);
        if (result != CASES[i].result)
            fail_msg("%s: %s", CASES[i].to, sluiceGetResultName(result));
        assert_null(set);
    }
}

static void unknown_keys_are_skipped_and_names_are_unescaped(void **state)
{
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    SluiceNeuralSet *set = NULL;
    SluiceNeuralTexture texture = {.structSize = sizeof texture};
    (void)state;
    memcpy(bytes, example, example_size);
    replace(bytes, "\"activation\":\"HGELUClamp\"", "\"x\":[{\"y\":[[],{},-1e+1]}]");
    replace(bytes, "\"name\":\"two\",\"firstChannel\":0", "\"name\":\"\\u00e9\\t\\ud83d\\udE00\"");
    CHECK_OK(open_neural_bytes(bytes, example_size, NULL, &set));
    CHECK_OK(sluiceGetNeuralTexture(set, 0, &texture));
    assert_string_equal(texture.pName, "\xC3\xA9\t\xF0\x9F\x98\x80");
    sluiceDestroyNeuralSet(set);
}

static void headers_are_checked(void **state)
{
    /* offset of a byte, its value */
    static const struct {
        size_t at;
        uint8_t value;
        SluiceResult result;
    } CASES[] = {
        {0, 'X', SLUICE_ERROR_CORRUPT_DATA},   {5, 2, SLUICE_ERROR_UNSUPPORTED},
        {15, 0x80, SLUICE_ERROR_CORRUPT_DATA}, {18, 1, SLUICE_ERROR_CORRUPT_DATA},
        {31, 0x80, SLUICE_ERROR_CORRUPT_DATA}, {34, 1, SLUICE_ERROR_CORRUPT_DATA},
    };
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        SluiceNeuralSet *set = NULL;
        memcpy(bytes, example, example_size);
        bytes[CASES[i].at] = CASES[i].value;
        CHECK_RESULT(open_neural_bytes(bytes, example_size, NULL, &set), CASES[i].result);
    }
}

static void the_padding_at_the_end_may_be_missing(void **state)
{
    SluiceNeuralSet *set = NULL;
    (void)state;
    CHECK_OK(open_neural_bytes(example, example_size - 2, NULL, &set));
    sluiceDestroyNeuralSet(set);
    set = NULL;
    CHECK_RESULT(open_neural_bytes(example, example_size - 3, NULL, &set),
                 SLUICE_ERROR_CORRUPT_DATA); /* a byte of the last view */
}

static void values_nested_too_deep_are_refused(void **state)
{
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    char deep[64];
    SluiceNeuralSet *set = NULL;
    (void)state;
    memcpy(bytes, example, example_size);
    memset(deep, '[', sizeof deep);
    memcpy(bytes + 40, "{\"a\":", 5);
    memcpy(bytes + 45, deep, sizeof deep);
    CHECK_RESULT(open_neural_bytes(bytes, example_size, NULL, &set), SLUICE_ERROR_CORRUPT_DATA);
}

static void ask(const SluiceNeuralSet *set)
{
    SluiceNeuralTexture texture = {.structSize = sizeof texture};
    SluiceNeuralMip mip = {.structSize = sizeof mip};
    SluiceNeuralLatentImage image = {.structSize = sizeof image};
    SluiceNeuralLatentPart part;
    SluiceNeuralColorSpace space;
    SluiceNeuralRequest request = {.width = 2, .height = 2};
    uint64_t offset, size;
    info_of(set);
    CHECK_OK(sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &size, NULL));
    assert_int_equal(size, 9472);
    CHECK_OK(sluiceBoundNeuralLatents(set, &request, 1, &size));
    CHECK_OK(sluiceGetNeuralTexture(set, 0, &texture));
    CHECK_OK(sluiceGetNeuralChannel(set, 0, &space));
    CHECK_OK(sluiceGetNeuralMip(set, 0, &mip));
    CHECK_OK(sluiceGetNeuralLatentImage(set, 0, &image));
    CHECK_OK(sluiceGetNeuralLatentPart(set, 0, 0, &part));
    CHECK_OK(sluiceGetNeuralLatentRange(set, 0, 1, &offset, &size));
}

/* Reads latents in both ways, and decodes texels from them. */
static SluiceResult read_and_decode(const SluiceNeuralSet *set)
{
    SluiceNeuralConstants constants;
    uint8_t latents[64], weights[9472];
    float texels[16];
    uint64_t size = sizeof latents, weight_size = sizeof weights;
    SluiceResult result = sluiceReadNeuralLatentPart(set, 0, 0, &size, latents);
    if (result != SLUICE_SUCCESS)
        return result;
    size = sizeof latents;
    result = sluiceReadNeuralLatents(set, NULL, &constants, &size, latents);
    if (result != SLUICE_SUCCESS)
        return result;
    CHECK_OK(sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &weight_size, weights));
    SluiceNeuralDecodeInfo info = {
        .structSize = sizeof info,
        .pConstants = &constants,
        .pLatents = latents,
        .latentSize = size,
        .pWeights = weights,
        .weightSize = weight_size,
        .width = 4,
        .height = 4,
        .channelCount = 1,
        .pTexels = texels,
    };
    return sluiceDecodeNeuralTexels(&info);
}

static void questions_take_no_memory(void **state)
{
    struct failing_allocator allocator;
    SluiceNeuralSet *set = NULL;
    (void)state;
    failing_allocator_init(&allocator, UINT64_MAX);
    CHECK_OK(open_neural_bytes(example, example_size, &allocator.callbacks, &set));
    uint64_t calls = allocator.calls;
    allocator.refuse_from = 0;
    ask(set);
    assert_int_equal(allocator.calls, calls);
    sluiceDestroyNeuralSet(set);
    assert_int_equal(allocator.live_bytes, 0);
}

static void every_refused_allocation_is_survived(void **state)
{
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    (void)state;
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        SluiceNeuralSet *set = NULL;
        failing_allocator_init(&allocator, n);
        result = open_neural_bytes(example, example_size, &allocator.callbacks, &set);
        if (result != SLUICE_SUCCESS) {
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
            assert_null(set);
        } else {
            ask(set);
            result = read_and_decode(set);
            assert_true(result == SLUICE_SUCCESS || result == SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        }
        sluiceDestroyNeuralSet(set);
        assert_int_equal(allocator.live_bytes, 0);
        assert_true(n < 100);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_worked_example_is_described),
        cmocka_unit_test(mips_and_latent_images_name_one_another),
        cmocka_unit_test(schema_1_has_two_grids_per_latent_image),
        cmocka_unit_test(every_sample_opens),
        cmocka_unit_test(contradictions_are_refused),
        cmocka_unit_test(unknown_keys_are_skipped_and_names_are_unescaped),
        cmocka_unit_test(headers_are_checked),
        cmocka_unit_test(the_padding_at_the_end_may_be_missing),
        cmocka_unit_test(values_nested_too_deep_are_refused),
        cmocka_unit_test(questions_take_no_memory),
        cmocka_unit_test(every_refused_allocation_is_survived),
    };
    example_size = write_worked_example(example);
    return RUN_TESTS(tests);
}
