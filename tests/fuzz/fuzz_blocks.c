/*
 * Any texels as BC7 and BC6H blocks: the decoder reads them, and they are no worse than a block of
 * one color, the mean of the texels. The first byte chooses quality and signs; the texels follow
 * and repeat. With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/bake/fuzz_blocks_libfuzzer
 *     BUILD/tests/bake/fuzz_blocks_libfuzzer -max_len=129 tests/fuzz/corpus/blocks
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#include "bake/bc6h_encode.h"
#include "bake/bc7_encode.h"
#include "support/bptc_decode.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static const SluiceBakeQuality qualities[] = {SLUICE_BAKE_QUALITY_FAST, SLUICE_BAKE_QUALITY_NORMAL,
                                              SLUICE_BAKE_QUALITY_BEST};

static void fail(const char *what, double error, double most)
{
    fprintf(stderr, "%s: squared error %.0f, a block of one color has %.0f\n", what, error, most);
    abort();
}

/* Squared error of `count` values at distance `stride` against their rounded mean. */
static double error_of_mean(const int *values, int count, int stride)
{
    double sum = 0, error = 0;
    for (int i = 0; i < count; i++)
        sum += values[i * stride];
    double mean = (double)(int64_t)(sum / count + (sum < 0 ? -0.5 : 0.5));
    for (int i = 0; i < count; i++)
        error += (values[i * stride] - mean) * (values[i * stride] - mean);
    return error;
}

static void check_bc7(SluiceBakeQuality quality, const uint8_t texels[64])
{
    uint8_t block[16], back[64];
    int values[64], mode;
    double error = 0, most = 0;
    slc_encode_bc7(quality, (const uint8_t(*)[64])texels, 1, block);
    if (!bc7_decode(block, back, &mode))
        abort();
    for (int i = 0; i < 64; i++) {
        values[i] = texels[i];
        error += (double)(back[i] - texels[i]) * (back[i] - texels[i]);
    }
    for (int c = 0; c < 4; c++)
        most += error_of_mean(values + c, 16, 4);
    if (error > most)
        fail("BC7", error, most);
}

/* Steps between halves, after what the encoder does to values that BC6H does not have. */
static int steps_of(uint16_t half, bool is_signed)
{
    int magnitude = half & 0x7fff;
    magnitude = magnitude > 0x7c00 ? 0 : magnitude > 0x7bff ? 0x7bff : magnitude;
    return half & 0x8000 ? is_signed ? -magnitude : 0 : magnitude;
}

static void check_bc6h(SluiceBakeQuality quality, bool is_signed, const uint16_t texels[64])
{
    uint8_t block[16];
    uint16_t back[48];
    int values[64], mode;
    double error = 0, most = 0;
    slc_encode_bc6h(is_signed, quality, (const uint16_t(*)[64])texels, 1, block);
    if (!bc6h_decode(is_signed, block, back, &mode))
        abort();
    for (int i = 0; i < 64; i++)
        values[i] = steps_of(texels[i], is_signed);
    for (int i = 0; i < 48; i++) {
        double difference = steps_of(back[i], is_signed) - values[i / 3 * 4 + i % 3];
        if ((back[i] & 0x7fff) > 0x7bff)
            abort();
        error += difference * difference;
    }
    for (int c = 0; c < 3; c++)
        most += error_of_mean(values + c, 16, 4);
    if (error > most)
        fail("BC6H", error, most);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t bytes[128];
    uint16_t halves[64];
    if (size < 2)
        return 0;
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = data[1 + i % (size - 1)];
    memcpy(halves, bytes, sizeof halves);
    SluiceBakeQuality quality = qualities[data[0] % 3];
    check_bc7(quality, bytes);
    check_bc6h(quality, data[0] & 128, halves);
    return 0;
}
