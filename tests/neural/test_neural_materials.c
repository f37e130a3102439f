/* Decoded materials beside their originals, and beside what their compressor prints. */
#include "image/half.h"
#include "neural/decoded.h"
#include "neural/neural_files.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Decoded mip 0 of NAME beside its original: planes of bytes, or of halves that become HLG. */
static void check_material(const char *name, const char *original, uint32_t channels,
                           const double printed[2])
{
    char path[512], file[64];
    size_t size;
    snprintf(file, sizeof file, "v9_%s_b5_20k.ntc", name);
    if (!find_neural_sample(file, path, sizeof path))
        SKIP_TEST("%s is not there; SLUICE_TEST_DATA says where the data folder is", path);
    SluiceNeuralSet *set = open_neural_sample(path);
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    CHECK_OK(sluiceGetNeuralSetInfo(set, &info));
    snprintf(file, sizeof file, "materials/%s", original);
    assert_true(find_neural_sample(file, path, sizeof path));
    uint8_t *planes = read_neural_file(path, &size);
    size_t texels = (size_t)info.width * info.height;
    bool is_half = size == 2 * texels * channels;
    for (int kind = 0; kind < 2; kind++) {
        float *decoded = decode_mip(set, (SluiceNeuralWeightKind)kind, 0);
        double sum = 0;
        for (size_t i = 0; i < texels * channels; i++) {
            size_t texel = i % texels, channel = i / texels;
            double value = (double)decoded[texel * info.channelCount + channel];
            double expected = planes[i] / 255.0;
            if (is_half) {
                float linear =
                    slc_float_from_half((uint16_t)(planes[2 * i] | planes[2 * i + 1] << 8));
                expected = (double)sluiceConvertNeuralColor(linear, SLUICE_NEURAL_COLOR_LINEAR,
                                                            SLUICE_NEURAL_COLOR_HLG);
            } else {
                value = value < 0 ? 0 : value > 1 ? 1 : value;
            }
            sum += (value - expected) * (value - expected);
        }
        double psnr = -10 * log10(sum / (double)(texels * channels));
        print_message("# %s, %s: %.3f dB, %.3f printed by its compressor\n", name,
                      kind ? "FP8" : "INT8", psnr, printed[kind]);
        assert_true(fabs(psnr - printed[kind]) < 0.1);
        free(decoded);
    }
    free(planes);
    sluiceDestroyNeuralSet(set);
}

/* The expected values, which the compressor printed, are in TARGETS.md of the samples. */
static void materials_are_as_near_to_their_originals_as_printed(void **state)
{
    (void)state;
    check_material("bronze", "bronze.u8", 8, (const double[]){34.916, 34.526});
    check_material("foliage", "foliage.u8", 4, (const double[]){35.044, 34.508});
    check_material("window", "window.f16", 3, (const double[]){35.574, 34.824});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(materials_are_as_near_to_their_originals_as_printed),
    };
    return RUN_TESTS(tests);
}
