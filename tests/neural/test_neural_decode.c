/* Decoded texels beside numbers by hand, and beside decodes of another decoder. */
#include "base/checked.h"
#include "neural/decoded.h"
#include "neural/decoder.h"
#include "neural/made_file.h"
#include "neural/neural_files.h"
#include "neural/worked_example.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Inputs of texel (1, 2) as NVIDIA's shaders have them. They truncate positions toward 0. */
static const int8_t TRUNCATED[48] = {
    [0] = -43, -97, 56,   40, [16] = 8, 8,    8,    8,   [32] = -63, 0,   0,
    63,        0,   -127, 63, -63,      -127, -127, -63, -63,        -63, -63};

static void open_worked_example(SluiceNeuralSet **set, struct decodable *d)
{
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    CHECK_OK(open_neural_bytes(bytes, write_worked_example(bytes), NULL, set));
    read_decodable(*set, NULL, SLUICE_NEURAL_WEIGHTS_INT8, d);
}

static void the_worked_network_runs_as_by_hand(void **state)
{
    float outputs[16];
    SluiceNeuralSet *set = NULL;
    struct decodable d;
    (void)state;
    struct slc_neural_shape shape = slc_neural_shape_of(SLUICE_NEURAL_NETWORK_SCHEMA3);
    struct slc_neural_blob at = slc_neural_blob_of(&shape, SLUICE_NEURAL_WEIGHTS_INT8);
    open_worked_example(&set, &d);
    assert_int_equal(d.weight_size, 9472);
    slc_neural_run_int8(&shape, &at, d.weights, TRUNCATED, outputs);
    assert_true(outputs[0] == 0.23681640625f);
    assert_true(outputs[1] == 0.0201416015625f);
    free_decodable(&d);
    sluiceDestroyNeuralSet(set);
}

static void the_inputs_of_the_worked_example_are_those_by_hand(void **state)
{
    static const int8_t WAVES[14] = {-65, -1,   -1,   63,  -1,  -127, 63,
                                     -65, -127, -127, -65, -65, -65,  -65};
    int8_t inputs[SLC_NEURAL_MAX_INPUTS];
    SluiceNeuralSet *set = NULL;
    struct decodable d;
    (void)state;
    open_worked_example(&set, &d);
    struct slc_neural_mip_view view = {
        .constants = &d.constants,
        .width = 4,
        .height = 4,
        .slices = {d.constants.slices[0], d.constants.slices[1]},
        .codes = {d.latents, d.latents + d.constants.slices[1].dataOffset}};
    slc_neural_int8_inputs(&view, 1, 2, inputs);
    for (int i = 0; i < 48; i++) {
        int expected = i >= 32 && i < 46 ? WAVES[i - 32] : TRUNCATED[i];
        if (inputs[i] != expected)
            fail_msg("input %d is %d, not %d", i, inputs[i], expected);
    }
    free_decodable(&d);
    sluiceDestroyNeuralSet(set);
}

/* Computed in Python from the inputs above. */
static void the_worked_example_decodes(void **state)
{
    float texel[2];
    SluiceNeuralSet *set = NULL;
    struct decodable d;
    (void)state;
    open_worked_example(&set, &d);
    CHECK_OK(decode_rectangle(&d, 0, 1, 2, 1, 1, texel));
    assert_true(texel[0] == 0.242919921875f);
    assert_true(texel[1] == 0.0140380859375f);
    free_decodable(&d);
    sluiceDestroyNeuralSet(set);
}

/* Decodes a rectangle of a mip in all ways, with channels 1 and 2 if there are any. */
static void check_ways(const struct decodable *d, uint32_t mip)
{
    enum { WIDTH = 45, HEIGHT = 12, MOST = WIDTH * HEIGHT * 2 };
    static float plain[MOST], strips[MOST], fastest[MOST];
    const uint32_t width = slc_mip_size(d->constants.width, mip),
                   height = slc_mip_size(d->constants.height, mip);
    SluiceNeuralDecodeInfo info = {.structSize = sizeof info,
                                   .pConstants = &d->constants,
                                   .pLatents = d->latents,
                                   .latentSize = d->latent_size,
                                   .pWeights = d->weights,
                                   .weightSize = d->weight_size,
                                   .weightKind = d->kind,
                                   .mip = mip,
                                   .x = width / 5,
                                   .y = height / 3,
                                   .firstChannel = 1,
                                   .channelCount = 2};
    info.width = slc_min_u32(width - info.x, WIDTH);
    info.height = slc_min_u32(height - info.y, HEIGHT);
    const size_t size = (size_t)info.width * info.height * 2 * sizeof(float);
    info.pTexels = plain;
    CHECK_OK(slc_neural_decode(&info, slc_neural_decode_plainly));
    info.pTexels = strips;
    CHECK_OK(slc_neural_decode(&info, slc_neural_decode_strips));
    info.pTexels = fastest;
    CHECK_OK(slc_neural_decode(&info, slc_neural_fastest_way()));
    assert_memory_equal(plain, strips, size);
    assert_memory_equal(plain, fastest, size);
}

/* Random networks and latents of each size, all mips; sums may wrap, a level may be no number. */
static void all_ways_to_decode_give_the_same_bits(void **state)
{
    (void)state;
    for (uint32_t s = 0; s < MADE_SHAPE_COUNT; s++) {
        struct made_file file = {0};
        SluiceNeuralSet *set = open_made_file(&made_shapes[s], s, &file);
        struct slc_neural_shape shape = slc_neural_shape_of(made_shapes[s].network);
        for (int kind = 0; kind < 2; kind++) {
            SluiceNeuralWeightKind k = (SluiceNeuralWeightKind)kind;
            struct slc_neural_blob at = slc_neural_blob_of(&shape, k);
            struct decodable d;
            read_decodable(set, NULL, k, &d);
            if (s % 2 == 0 && !kind)
                memset(d.weights + at.biases[0], 0x7F, 8);
            for (uint32_t m = 0; m < d.constants.mipCount; m++) {
                const float lods[] = {d.constants.mips[m].positionLod, NAN, 1e5f, -3e-6f};
                d.constants.mips[m].positionLod = lods[(m + s) % 4];
                check_ways(&d, m);
            }
            free_decodable(&d);
        }
        sluiceDestroyNeuralSet(set);
        free(file.bytes);
    }
}

/* Floats of NAME.WEIGHTS.mipNN.f32. */
static void check_golden(const char *name, const char *weights, uint32_t mip, double least)
{
    char path[512], golden[128];
    size_t size;
    snprintf(golden, sizeof golden, "%s.ntc", name);
    if (!find_neural_sample(golden, path, sizeof path))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    SluiceNeuralSet *set = open_neural_sample(path);
    SluiceNeuralWeightKind kind =
        strcmp(weights, "fp8") == 0 ? SLUICE_NEURAL_WEIGHTS_FP8 : SLUICE_NEURAL_WEIGHTS_INT8;
    float *texels = decode_mip(set, kind, mip);
    snprintf(golden, sizeof golden, "%s.%s.mip%02u.f32", name, weights, mip);
    assert_true(find_neural_sample(golden, path, sizeof path));
    uint8_t *bytes = read_neural_file(path, &size);
    double psnr = psnr_of(texels, (const float *)(void *)bytes, size / 4);
    print_message("# %s %.2f dB\n", golden, psnr);
    assert_true(psnr >= least);
    free(bytes);
    free(texels);
    sluiceDestroyNeuralSet(set);
}

static void decodes_of_schema_1_agree_with_another_decoder(void **state)
{
    static const uint32_t MIPS[] = {0, 1, 3};
    (void)state;
    for (int i = 0; i < 3; i++) {
        check_golden("v7_64_g", "int8", MIPS[i], 50);
        check_golden("v7_64_g", "fp8", MIPS[i], 50);
    }
}

static void decodes_of_schema_3_agree_with_another_decoder(void **state)
{
    static const uint32_t MIPS[] = {0, 1, 3};
    (void)state;
    for (int i = 0; i < 3; i++) {
        check_golden("v9_64_g", "int8", MIPS[i], 50);
        check_golden("v9_64_g", "fp8", MIPS[i], 50);
    }
}

static void color_spaces_are_the_inverse_of_one_another(void **state)
{
    (void)state;
    for (int i = -100; i <= 300; i++) {
        float linear = (float)i / 50;
        for (int space = 0; space < 3; space++) {
            SluiceNeuralColorSpace s = (SluiceNeuralColorSpace)space;
            float code = sluiceConvertNeuralColor(linear, SLUICE_NEURAL_COLOR_LINEAR, s);
            float again = sluiceConvertNeuralColor(code, s, SLUICE_NEURAL_COLOR_LINEAR);
            assert_true(fabsf(again - linear) < 2e-5f);
        }
    }
    assert_true(
        fabsf(sluiceConvertNeuralColor(0.5f, SLUICE_NEURAL_COLOR_SRGB, SLUICE_NEURAL_COLOR_LINEAR) -
              0.21404114f) < 1e-6f);
    assert_true(
        fabsf(sluiceConvertNeuralColor(1.0f, SLUICE_NEURAL_COLOR_LINEAR, SLUICE_NEURAL_COLOR_HLG) -
              0.5f) < 1e-6f);
    assert_true(fabsf(sluiceConvertNeuralColor(-12.0f, SLUICE_NEURAL_COLOR_LINEAR,
                                               SLUICE_NEURAL_COLOR_HLG) +
                      1.0f) < 1e-4f);
}

static void e4m3_rounds_to_the_nearest(void **state)
{
    (void)state;
    for (int bits = 0; bits < 256; bits++)
        if ((bits & 0x7F) != 0x7F && bits != 0x80)
            assert_int_equal(slc_e4m3_from_float(slc_float_from_e4m3((uint8_t)bits)), bits);
    for (int i = -5000; i <= 5000; i++) { /* no other code is nearer */
        float value = (float)i / 10;
        float best = slc_float_from_e4m3(slc_e4m3_from_float(value));
        for (int bits = 0; bits < 256; bits++)
            if ((bits & 0x7F) != 0x7F)
                assert_true(fabsf(best - value) <=
                            fabsf(slc_float_from_e4m3((uint8_t)bits) - value));
    }
    assert_int_equal(slc_e4m3_from_float(1e30f), 0x7E);
    assert_int_equal(slc_e4m3_from_float(1.0625f), 0x38); /* ties to even */
    assert_int_equal(slc_e4m3_from_float(1.1875f), 0x3A);
    assert_int_equal(slc_e4m3_from_float(0x1p-10f), 0);
}

/* Outputs are permuted, and constants need no weights. */
static void outputs_are_mapped(void **state)
{
    SluiceNeuralOutput outputs[16] = {{1, 0}, {SLUICE_NEURAL_CONSTANT, 0.75f}, {0, 0}};
    float plain[2 * 16], mapped[3 * 16];
    SluiceNeuralSet *set = NULL;
    struct decodable d;
    (void)state;
    open_worked_example(&set, &d);
    CHECK_OK(decode_rectangle(&d, 0, 0, 0, 4, 4, plain));
    CHECK_OK(sluiceGetNeuralWeights(set, d.kind, outputs, &d.weight_size, d.weights));
    d.constants.channelCount = 3;
    CHECK_OK(decode_rectangle(&d, 0, 0, 0, 4, 4, mapped));
    for (int i = 0; i < 16; i++) {
        assert_true(mapped[3 * i] == plain[2 * i + 1]);
        assert_true(mapped[3 * i + 1] == 0.75f);
        assert_true(mapped[3 * i + 2] == plain[2 * i]);
    }
    outputs[3].channel = 16;
    CHECK_RESULT(sluiceGetNeuralWeights(set, d.kind, outputs, &d.weight_size, d.weights),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    outputs[3] = (SluiceNeuralOutput){SLUICE_NEURAL_CONSTANT, 32768};
    CHECK_RESULT(sluiceGetNeuralWeights(set, d.kind, outputs, &d.weight_size, d.weights),
                 SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(
        sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_FP8, NULL, &d.weight_size, d.weights),
        SLUICE_ERROR_UNSUPPORTED);
    free_decodable(&d);
    sluiceDestroyNeuralSet(set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_worked_network_runs_as_by_hand),
        cmocka_unit_test(the_inputs_of_the_worked_example_are_those_by_hand),
        cmocka_unit_test(the_worked_example_decodes),
        cmocka_unit_test(all_ways_to_decode_give_the_same_bits),
        cmocka_unit_test(decodes_of_schema_1_agree_with_another_decoder),
        cmocka_unit_test(decodes_of_schema_3_agree_with_another_decoder),
        cmocka_unit_test(color_spaces_are_the_inverse_of_one_another),
        cmocka_unit_test(e4m3_rounds_to_the_nearest),
        cmocka_unit_test(outputs_are_mapped),
    };
    return RUN_TESTS(tests);
}
