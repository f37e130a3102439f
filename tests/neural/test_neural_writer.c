/* Written files are read again. */
#include "image/half.h"
#include "neural/decoded.h"
#include "neural/decoder.h"
#include "neural/made_file.h"
#include "neural/neural_files.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Returns code `index` of a grid from packed latents, bit by bit. */
static uint32_t packed_code(const uint8_t *latents, uint32_t bits, size_t index)
{
    uint32_t code = 0;
    for (uint32_t b = 0; b < bits; b++) {
        size_t bit = index * bits + b;
        code |= (uint32_t)(latents[bit / 8] >> bit % 8 & 1) << b;
    }
    return code;
}

static void check_codes(const struct made_parts *parts, const struct decodable *d)
{
    const SluiceNeuralConstants *k = &d->constants;
    const uint8_t *expected = parts->codes;
    for (uint32_t i = 0; i < 16; i++) {
        bool is_low = k->schema == 1 && i % 2;
        uint32_t size = k->slices[i].gridSize;
        size_t codes =
            (size_t)(size & 0xFFFF) * (size >> 16) * (is_low ? k->lowFeatures : k->highFeatures);
        assert_int_equal(size, k->slices[i].sliceSize);
        for (size_t c = 0; c < codes; c++)
            if (packed_code(d->latents + k->slices[i].dataOffset, is_low ? k->lowBits : k->highBits,
                            c) != *expected++)
                fail_msg("code %zu of grid %u differs", c, i);
    }
    assert_ptr_equal(expected, parts->codes + parts->code_count);
}

static void check_description(const struct made_parts *parts, const SluiceNeuralSet *set)
{
    SluiceNeuralTexture texture = {.structSize = sizeof texture};
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    SluiceNeuralColorSpace space;
    CHECK_OK(sluiceGetNeuralSetInfo(set, &info));
    assert_int_equal(info.channelCount, 6);
    assert_int_equal(info.validChannels, 31);
    assert_int_equal(info.network, parts->info.network);
    for (uint32_t i = 0; i < 2; i++) {
        const SluiceNeuralTexture *expected = &parts->textures[i];
        CHECK_OK(sluiceGetNeuralTexture(set, i, &texture));
        assert_string_equal(texture.pName, expected->pName);
        assert_int_equal(texture.firstChannel, expected->firstChannel);
        assert_int_equal(texture.channelCount, expected->channelCount);
        assert_int_equal(texture.format, expected->format);
        assert_int_equal(texture.rgbColorSpace, expected->rgbColorSpace);
        assert_int_equal(texture.alphaColorSpace, expected->alphaColorSpace);
        assert_int_equal(texture.bcFormat, expected->bcFormat);
    }
    for (uint32_t i = 0; i < 5; i++) {
        CHECK_OK(sluiceGetNeuralChannel(set, i, &space));
        assert_int_equal(space, parts->spaces[i]);
    }
}

static void what_is_written_is_read_again(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < MADE_SHAPE_COUNT; i++) {
        struct made_parts parts;
        struct made_file file = {0};
        struct decodable d;
        SluiceNeuralSet *set = NULL;
        make_parts(&parts, &made_shapes[i], i);
        CHECK_OK(write_made_file(&parts, &file));
        CHECK_OK(open_neural_bytes(file.bytes, file.size, NULL, &set));
        check_description(&parts, set);
        for (int kind = 0; kind < 2; kind++) {
            read_decodable(set, NULL, (SluiceNeuralWeightKind)kind, &d);
            assert_memory_equal(d.weights, kind ? parts.fp8_weights : parts.int8_weights,
                                d.weight_size);
            assert_memory_equal(&d.constants, &parts.constants, sizeof parts.constants);
            assert_int_equal(d.latent_size, parts.latent_size);
            check_codes(&parts, &d);
            free_decodable(&d);
        }
        sluiceDestroyNeuralSet(set);
        free_made_parts(&parts);
        free(file.bytes);
    }
}

/* Layers 0 to 2 hold equal numbers in 16 bits. All other bytes are equal. */
static void half_weights_are_those_of_fp8(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < MADE_SHAPE_COUNT; i++) {
        struct made_parts parts;
        struct made_file file = {0};
        struct decodable fp8, half;
        SluiceNeuralSet *set = NULL;
        make_parts(&parts, &made_shapes[i], i);
        CHECK_OK(write_made_file(&parts, &file));
        CHECK_OK(open_neural_bytes(file.bytes, file.size, NULL, &set));
        read_decodable(set, NULL, SLUICE_NEURAL_WEIGHTS_FP8, &fp8);
        read_decodable(set, NULL, SLUICE_NEURAL_WEIGHTS_HALF, &half);
        uint64_t wide = half.weight_size - fp8.weight_size; /* weights of these layers */
        assert_int_equal(wide,
                         fp8.constants.schema == 3 ? 7680 : fp8.constants.inputCount * 64 + 8192);
        for (uint64_t k = 0; k < wide; k++) {
            uint16_t bits = (uint16_t)(half.weights[2 * k] | half.weights[2 * k + 1] << 8);
            assert_true(slc_float_from_half(bits) == slc_float_from_e4m3(fp8.weights[k]));
        }
        assert_memory_equal(half.weights + 2 * wide, fp8.weights + wide, fp8.weight_size - wide);
        free_decodable(&fp8);
        free_decodable(&half);
        sluiceDestroyNeuralSet(set);
        free_made_parts(&parts);
        free(file.bytes);
    }
}

static void packed_latents_give_the_same_file(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < MADE_SHAPE_COUNT; i++) {
        struct made_parts parts;
        struct made_file first = {0}, second = {0};
        struct decodable d;
        SluiceNeuralSet *set = NULL;
        make_parts(&parts, &made_shapes[i], i);
        CHECK_OK(write_made_file(&parts, &first));
        CHECK_OK(open_neural_bytes(first.bytes, first.size, NULL, &set));
        read_decodable(set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, &d);
        parts.info.pCodes = NULL;
        parts.info.pLatents = d.latents;
        CHECK_OK(write_made_file(&parts, &second));
        assert_int_equal(first.size, second.size);
        assert_memory_equal(first.bytes, second.bytes, first.size);
        free_decodable(&d);
        sluiceDestroyNeuralSet(set);
        free_made_parts(&parts);
        free(first.bytes);
        free(second.bytes);
    }
}

/* The writer's rules give the plans that the format's own compressors have written. */
static void plans_are_those_of_the_samples(void **state)
{
    static const char *const NAMES[] = {"v7_512_n2.ntc", "v7_64_g.ntc", "v9_300x200.ntc",
                                        "v9_512_b5.ntc", "v9_64_g.ntc"};
    char path[512];
    (void)state;
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        if (!find_neural_sample(NAMES[i], path, sizeof path))
            SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
        SluiceNeuralSet *set = open_neural_sample(path);
        SluiceNeuralSetInfo info = {.structSize = sizeof info};
        SluiceNeuralConstants of_file, planned;
        uint64_t size = 0, planned_size;
        CHECK_OK(sluiceGetNeuralSetInfo(set, &info));
        CHECK_OK(sluiceReadNeuralLatents(set, NULL, &of_file, &size, NULL));
        SluiceNeuralWriteInfo write = {
            .structSize = sizeof write,
            .schema = info.schema,
            .width = info.width,
            .height = info.height,
            .channelCount = info.channelCount,
            .network = info.network,
            .highFeatures = info.highFeatures,
            .highBits = info.highBits,
            .lowFeatures = info.lowFeatures,
            .lowBits = info.lowBits,
            .gridScale = info.gridScale,
        };
        CHECK_OK(sluicePlanNeuralFile(&write, &planned, &planned_size));
        planned.validChannels = of_file.validChannels;
        assert_int_equal(size, planned_size);
        assert_memory_equal(&planned, &of_file, sizeof planned);
        sluiceDestroyNeuralSet(set);
    }
}

static void files_are_written_to_a_path(void **state)
{
    struct made_parts parts;
    struct made_file file = {0};
    char path[64];
    size_t size;
    (void)state;
    snprintf(path, sizeof path, "/tmp/sluice-writer-%ld.ntc", (long)getpid());
    make_parts(&parts, &made_shapes[0], 7);
    CHECK_OK(write_made_file(&parts, &file));
    parts.info.pPath = path;
    CHECK_OK(sluiceWriteNeuralFile(&parts.info));
    uint8_t *bytes = read_neural_file(path, &size);
    assert_int_equal(size, file.size);
    assert_memory_equal(bytes, file.bytes, size);
    unlink(path);
    parts.info.pPath = "/tmp/no-such-folder/x.ntc";
    CHECK_RESULT(sluiceWriteNeuralFile(&parts.info), SLUICE_ERROR_FILE_NOT_FOUND);
    free(bytes);
    free(file.bytes);
    free_made_parts(&parts);
}

static void each_failed_write_is_returned(void **state)
{
    struct made_parts parts;
    SluiceResult result = SLUICE_ERROR_IO;
    (void)state;
    make_parts(&parts, &made_shapes[9], 1);
    for (uint32_t n = 1; result != SLUICE_SUCCESS; n++) {
        struct made_file file = {.fail_at = n};
        result = write_made_file(&parts, &file);
        assert_true(result == SLUICE_ERROR_IO || result == SLUICE_SUCCESS);
        free(file.bytes);
        assert_true(n < 200);
    }
    free_made_parts(&parts);
}

static void every_refused_allocation_is_survived(void **state)
{
    struct made_parts parts;
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    (void)state;
    make_parts(&parts, &made_shapes[9], 1);
    for (uint64_t n = 0; result != SLUICE_SUCCESS; n++) {
        struct failing_allocator allocator;
        struct made_file file = {0};
        failing_allocator_init(&allocator, n);
        parts.info.pAllocator = &allocator.callbacks;
        result = write_made_file(&parts, &file);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        assert_int_equal(allocator.live_bytes, 0);
        free(file.bytes);
        assert_true(n < 50);
    }
    free_made_parts(&parts);
}

static void plans_take_no_memory(void **state)
{
    struct failing_allocator allocator;
    struct made_parts parts;
    (void)state;
    make_parts(&parts, &made_shapes[5], 1);
    failing_allocator_init(&allocator, 0);
    parts.info.pAllocator = &allocator.callbacks;
    CHECK_OK(sluicePlanNeuralFile(&parts.info, &parts.constants, &parts.latent_size));
    assert_int_equal(allocator.calls, 0);
    free_made_parts(&parts);
}

static void wrong_arguments_are_refused(void **state)
{
    struct made_parts parts;
    struct made_file file = {0};
    (void)state;
    make_parts(&parts, &made_shapes[0], 1);
    const SluiceNeuralWriteInfo good = parts.info;
#define REFUSES(field, value)                                                                      \
    do {                                                                                           \
        parts.info = good;                                                                         \
        parts.info.field = (value);                                                                \
        CHECK_RESULT(write_made_file(&parts, &file), SLUICE_ERROR_INVALID_ARGUMENT);               \
    } while (0)
    REFUSES(schema, 2);
    REFUSES(width, 0);
    REFUSES(height, SLUICE_NEURAL_MAX_SIZE + 1);
    REFUSES(mipCount, 8);
    REFUSES(channelCount, 17);
    REFUSES(channelCount, 4); /* a texture has the fifth */
    REFUSES(textureCount, 17);
    REFUSES(network, SLUICE_NEURAL_NETWORK_SCHEMA3);
    REFUSES(highFeatures, 8); /* the network has 4 */
    REFUSES(lowFeatures, 5);
    REFUSES(highBits, 3);
    REFUSES(gridScale, 7);
    REFUSES(latentImageCount, 9);
#undef REFUSES
    parts.info = good;
    parts.codes[5] = 4; /* two bits hold 0 to 3 */
    CHECK_RESULT(write_made_file(&parts, &file), SLUICE_ERROR_INVALID_ARGUMENT);
    parts.codes[5] = 3;
    memset(parts.int8_weights + 12288, 0xFF, 4); /* a scale */
    CHECK_RESULT(write_made_file(&parts, &file), SLUICE_ERROR_INVALID_ARGUMENT);
    parts.info.pInt8Weights = NULL;
    CHECK_OK(write_made_file(&parts, &file));
    parts.info.pFp8Weights = NULL;
    CHECK_RESULT(write_made_file(&parts, &file), SLUICE_ERROR_NULL_POINTER);
    free(file.bytes);
    free_made_parts(&parts);
}

/* Names of the largest length can be written and read. */
static void names_are_as_long_as_can_be_read(void **state)
{
    enum { LIMIT = 1 << 20 };
    struct made_parts parts;
    (void)state;
    make_parts(&parts, &made_shapes[0], 1);
    char *name = malloc(LIMIT + 1);
    assert_non_null(name);
    parts.textures[0].pName = name;
    uint32_t length = LIMIT, step = LIMIT;
    for (; step > 0; step /= 2) { /* the most for which the call succeeds */
        struct made_file file = {0};
        memset(name, 'n', length);
        name[length] = '\0';
        SluiceResult result = write_made_file(&parts, &file);
        if (result == SLUICE_SUCCESS) {
            SluiceNeuralSet *set = NULL;
            SluiceNeuralTexture texture = {.structSize = sizeof texture};
            CHECK_OK(open_neural_bytes(file.bytes, file.size, NULL, &set));
            CHECK_OK(sluiceGetNeuralTexture(set, 0, &texture));
            assert_string_equal(texture.pName, name);
            sluiceDestroyNeuralSet(set);
        } else {
            CHECK_RESULT(result, SLUICE_ERROR_INVALID_ARGUMENT);
            assert_int_equal(file.size, 0);
        }
        free(file.bytes);
        length = result == SLUICE_SUCCESS ? length + step / 2 : length - step / 2;
    }
    assert_in_range(length, LIMIT - 16384, LIMIT - 1);
    free(name);
    free_made_parts(&parts);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_again),
        cmocka_unit_test(half_weights_are_those_of_fp8),
        cmocka_unit_test(packed_latents_give_the_same_file),
        cmocka_unit_test(plans_are_those_of_the_samples),
        cmocka_unit_test(files_are_written_to_a_path),
        cmocka_unit_test(each_failed_write_is_returned),
        cmocka_unit_test(every_refused_allocation_is_survived),
        cmocka_unit_test(plans_take_no_memory),
        cmocka_unit_test(wrong_arguments_are_refused),
        cmocka_unit_test(names_are_as_long_as_can_be_read),
    };
    return RUN_TESTS(tests);
}
