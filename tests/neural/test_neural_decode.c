/* Decoded texels beside numbers by hand, and beside decodes of another decoder. */
#include "neural/decoded.h"
#include "neural/decoder.h"
#include "neural/neural_files.h"
#include "neural/worked_example.h"
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_worked_network_runs_as_by_hand),
        cmocka_unit_test(the_inputs_of_the_worked_example_are_those_by_hand),
        cmocka_unit_test(the_worked_example_decodes),
        cmocka_unit_test(decodes_of_schema_1_agree_with_another_decoder),
        cmocka_unit_test(decodes_of_schema_3_agree_with_another_decoder),
    };
    return RUN_TESTS(tests);
}
