/* Decoded texels beside numbers by hand, and beside decodes of another decoder. */
#include "neural/decoded.h"
#include "neural/fast_network.h"
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

/* Random networks and inputs of each size; sums may wrap. */
static void both_ways_to_run_a_network_give_the_same_bits(void **state)
{
    static struct slc_neural_fast fast;
    (void)state;
    for (uint32_t s = 0; s < MADE_SHAPE_COUNT; s++) {
        struct made_parts parts;
        make_parts(&parts, &made_shapes[s], s);
        struct slc_neural_shape shape = slc_neural_shape_of(made_shapes[s].network);
        for (int kind = 0; kind < 2; kind++) {
            SluiceNeuralWeightKind k = (SluiceNeuralWeightKind)kind;
            struct slc_neural_blob at = slc_neural_blob_of(&shape, k);
            uint8_t *blob = kind ? parts.fp8_weights : parts.int8_weights;
            if (s == 0 && !kind)
                memset(blob + at.biases[0], 0x7F, 8);
            slc_neural_fast_init(&fast, &shape, k, blob);
            for (int n = 0; n < 50; n++) {
                float slow_outputs[16], fast_outputs[16], floats[96];
                int8_t inputs[96];
                for (int i = 0; i < 96; i++) {
                    inputs[i] = (int8_t)(roll() % 256 - 128);
                    floats[i] = (float)inputs[i] / 100.0f;
                }
                if (kind) {
                    slc_neural_run_fp8(&shape, &at, blob, floats, slow_outputs);
                    slc_neural_fast_fp8(&fast, floats, fast_outputs);
                } else {
                    slc_neural_run_int8(&shape, &at, blob, inputs, slow_outputs);
                    slc_neural_fast_int8(&fast, inputs, fast_outputs);
                }
                assert_memory_equal(slow_outputs, fast_outputs, sizeof slow_outputs);
            }
        }
        free_made_parts(&parts);
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
        cmocka_unit_test(both_ways_to_run_a_network_give_the_same_bits),
        cmocka_unit_test(decodes_of_schema_1_agree_with_another_decoder),
        cmocka_unit_test(decodes_of_schema_3_agree_with_another_decoder),
        cmocka_unit_test(color_spaces_are_the_inverse_of_one_another),
        cmocka_unit_test(e4m3_rounds_to_the_nearest),
        cmocka_unit_test(outputs_are_mapped),
    };
    return RUN_TESTS(tests);
}
