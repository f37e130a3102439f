/*
 * Blocks made by encode_blocks.glsl, decoded in C: BC7 by support/bptc_decode.c, others by the
 * decoders below. The baseline is the simplest encoder, with the corners of the texels' bounding
 * box as end points. The baker's encoders search longer and show the remaining gap.
 */
#include "device/conform.h"

#ifdef HAVE_BAKE
#include "bake/blocks.h"
#endif
#include "support/bptc_decode.h"
#include "support/roll.h"
#include "support/test.h"

#include "encode_blocks_comp.h"
#include "encode_blocks_shared.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCKS = 1024, KINDS = 7 };
enum kind { SOLID, TWO_COLORS, RAMP, CURVE, CLOUD, NOISE, APART };
static const char *const format_names[] = {"BC1", "BC4", "BC5", "BC7"};

struct rig {
    struct harness *h;
    struct harness_buffer texels, blocks;
    struct conform_set set;
    VkPipeline pipeline;
};

static void rig_init(struct rig *rig, struct harness *h)
{
    rig->h = h;
    harness_buffer_init(h, &rig->texels, BLOCKS * sizeof(struct EncodeInput),
                        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    harness_buffer_init(h, &rig->blocks, BLOCKS * 16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    conform_create_set(h, 2, 0, 8, &rig->set);
    conform_write_buffers(h, &rig->set, 2,
                          (const struct harness_buffer *const[]){&rig->texels, &rig->blocks});
    rig->pipeline = conform_compute_pipeline(
        h, rig->set.layout, conform_module(h, encode_blocks_comp, sizeof encode_blocks_comp), NULL);
}

static void rig_finish(struct rig *rig)
{
    rig->h->DestroyPipeline(rig->h->device, rig->pipeline, NULL);
    conform_destroy_set(rig->h, &rig->set);
    harness_buffer_finish(rig->h, &rig->texels);
    harness_buffer_finish(rig->h, &rig->blocks);
}

static void encode(struct rig *rig, uint32_t format)
{
    uint32_t push[2] = {BLOCKS, format};
    conform_run_job(rig->h, &(struct conform_job){.set = &rig->set,
                                                  .stage = CONFORM_STAGE_COMPUTE,
                                                  .pipeline = rig->pipeline,
                                                  .count = BLOCKS,
                                                  .push = push,
                                                  .push_size = sizeof push});
}

static double draw(double from, double to)
{
    return from + (to - from) * roll() / ROLL_MAX;
}

/* Makes the texels of a block, in bytes / 255. */
static void make_block(enum kind kind, float rgba[64])
{
    double a[4], b[4], bend[4];
    for (int c = 0; c < 4; c++) {
        a[c] = draw(0, 1);
        b[c] = kind == CLOUD ? a[c] + draw(-0.1, 0.1) : draw(0, 1);
        bend[c] = draw(-0.2, 0.2);
    }
    const int apart = (int)(roll() % 4); /* varies downward only; the others also to the right */
    for (int i = 0; i < 16; i++) {
        double t = kind == TWO_COLORS ? draw(0, 1) < 0.5 : (i % 4 + 2 * (i / 4)) / 9.0;
        for (int c = 0; c < 4; c++) {
            double v = kind == SOLID ? a[c] : kind == NOISE ? draw(0, 1) : a[c] + t * (b[c] - a[c]);
            if (kind == APART)
                v = a[c] + (c == apart ? i / 4 : i % 4) / 3.0 * (b[c] - a[c]);
            if (kind == CURVE)
                v += bend[c] * 4 * t * (1 - t);
            if (kind == CLOUD)
                v += draw(-0.05, 0.05);
            rgba[4 * i + c] = (float)(round(fmin(fmax(v, 0), 1) * 255) / 255);
        }
    }
}

static void decode_bc1(const uint8_t *block, double rgba[64])
{
    unsigned ends[2] = {block[0] | (unsigned)block[1] << 8, block[2] | (unsigned)block[3] << 8};
    for (int i = 0; i < 16; i++) {
        unsigned index = block[4 + i / 4] >> i % 4 * 2 & 3;
        for (int c = 0; c < 3; c++) {
            double e[2];
            for (int k = 0; k < 2; k++)
                e[k] = c == 0   ? (ends[k] >> 11) / 31.0
                       : c == 1 ? (ends[k] >> 5 & 63) / 63.0
                                : (ends[k] & 31) / 31.0;
            double four[4] = {e[0], e[1], (2 * e[0] + e[1]) / 3, (e[0] + 2 * e[1]) / 3};
            double three[4] = {e[0], e[1], (e[0] + e[1]) / 2, 0};
            rgba[4 * i + c] = ends[0] > ends[1] ? four[index] : three[index];
        }
        rgba[4 * i + 3] = ends[0] > ends[1] || index < 3;
    }
}

static void decode_bc4(const uint8_t *block, int channel, double rgba[64])
{
    uint64_t bits = 0;
    for (int i = 0; i < 6; i++)
        bits |= (uint64_t)block[2 + i] << 8 * i;
    double a = block[0] / 255.0, b = block[1] / 255.0;
    for (int i = 0; i < 16; i++, bits >>= 3) {
        int index = bits & 7;
        double v = index == 0 ? a : index == 1 ? b : 0;
        if (index > 1 && block[0] > block[1])
            v = ((8 - index) * a + (index - 1) * b) / 7;
        else if (index > 1)
            v = index == 7 ? 1 : index == 6 ? 0 : ((6 - index) * a + (index - 1) * b) / 5;
        rgba[4 * i + channel] = v;
    }
}

static void decode(uint32_t format, const uint8_t *block, double rgba[64])
{
    uint8_t bytes[64];
    int mode;
    if (format == ENCODE_BC1) {
        decode_bc1(block, rgba);
    } else if (format == ENCODE_BC7) {
        assert_true(bc7_decode(block, bytes, &mode));
        for (int i = 0; i < 64; i++)
            rgba[i] = bytes[i] / 255.0;
    } else {
        decode_bc4(block, 0, rgba);
        if (format == ENCODE_BC5)
            decode_bc4(block + 8, 1, rgba);
    }
}

static int channel_count(uint32_t format)
{
    return format == ENCODE_BC4 ? 1 : format == ENCODE_BC5 ? 2 : format == ENCODE_BC1 ? 3 : 4;
}

static double squared_error(uint32_t format, const float *texels, const double *rgba)
{
    double sum = 0;
    for (int i = 0; i < 16; i++)
        for (int c = 0; c < channel_count(format); c++)
            sum += pow((double)texels[4 * i + c] - rgba[4 * i + c], 2);
    return sum;
}

/* Error with the corners of the bounding box as quantized end points, and the best weight per
 * texel. */
static double corner_error(uint32_t format, const float *texels)
{
    static const double bc7[16] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
    int channels = channel_count(format), weights = format == ENCODE_BC1 ? 4 : 8;
    double low[4] = {1, 1, 1, 1}, high[4] = {0}, sum = 0, rounds[4] = {255, 255, 255, 255};
    if (format == ENCODE_BC1)
        memcpy(rounds, (double[4]){31, 63, 31, 1}, sizeof rounds);
    if (format == ENCODE_BC7) {
        memcpy(rounds, (double[4]){127, 127, 127, 127}, sizeof rounds);
        weights = 16;
    }
    for (int i = 0; i < 64; i++) {
        low[i % 4] = fmin(low[i % 4], (double)texels[i]);
        high[i % 4] = fmax(high[i % 4], (double)texels[i]);
    }
    for (int c = 0; c < channels; c++) {
        low[c] = round(low[c] * rounds[c]) / rounds[c];
        high[c] = round(high[c] * rounds[c]) / rounds[c];
    }
    for (int i = 0; i < 16; i++) {
        double best = 1e9;
        for (int k = 0; k < weights; k++) {
            double w = format == ENCODE_BC7 ? bc7[k] / 64 : k / (weights - 1.0), e = 0;
            for (int c = 0; c < channels; c++)
                e += pow(low[c] + w * (high[c] - low[c]) - (double)texels[4 * i + c], 2);
            best = fmin(best, e);
        }
        sum += best;
    }
    return sum;
}

static double psnr(double squares, int channels)
{
    return -10 * log10(squares / BLOCKS / 16 / channels);
}

static double decoded_error(uint32_t format, const struct EncodeInput *inputs,
                            const uint8_t *blocks, size_t size)
{
    double squares = 0, rgba[64];
    for (uint32_t i = 0; i < BLOCKS; i++) {
        decode(format, blocks + i * size, rgba);
        squares += squared_error(format, inputs[i].rgba, rgba);
    }
    return squares;
}

/* Returns the dB of the baker's blocks. NAN: this build has no such encoder. */
static double baked_psnr(uint32_t format, const struct EncodeInput *inputs)
{
#ifdef HAVE_BAKE
    static const SluiceFormat formats[ENCODE_FORMATS] = {
        SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, SLUICE_FORMAT_BC4_UNORM_BLOCK,
        SLUICE_FORMAT_BC5_UNORM_BLOCK, SLUICE_FORMAT_BC7_UNORM_BLOCK};
    static uint8_t texels[BLOCKS][64], blocks[BLOCKS * 16];
    const struct slc_block_encoder encoder = {.format = formats[format]};
    if (!slc_can_encode_blocks(formats[format]))
        return NAN;
    for (uint32_t i = 0; i < BLOCKS; i++)
        for (int t = 0; t < 64; t++)
            texels[i][t] = (uint8_t)lround((double)inputs[i].rgba[t] * 255);
    CHECK_OK(slc_encode_blocks(&encoder, texels, 16, 4, 4 * BLOCKS, blocks));
    return psnr(decoded_error(format, inputs, blocks,
                              format == ENCODE_BC1 || format == ENCODE_BC4 ? 8 : 16),
                channel_count(format));
#else
    (void)format, (void)inputs;
    return NAN;
#endif
}

/* Prints the dB of shader and baker. Fails below `least`, or more than `most_less` below the
 * baker. */
static void compare(struct rig *rig, uint32_t format, const char *name, double least,
                    double most_less)
{
    const struct EncodeInput *inputs = rig->texels.mapped;
    encode(rig, format);
    double got = psnr(decoded_error(format, inputs, rig->blocks.mapped, 16), channel_count(format));
    double baked = baked_psnr(format, inputs);
    print_message("# %s, %s: %.2f dB, baked %.2f\n", format_names[format], name, got, baked);
    if (!(got >= least) || got < baked - most_less)
        fail_msg("%s, %s: %.2f dB, baked %.2f", format_names[format], name, got, baked);
}

static void blocks_of_each_kind_beat_the_corners_of_their_box(void **state)
{
    static const char *const names[KINDS] = {"solid", "two colors", "ramp", "curve",
                                             "cloud", "noise",      "apart"};
    /* dB over BLOCKS blocks: about 0.3 below the measured values. */
    static const double least[ENCODE_FORMATS][KINDS] = {{41.6, 41.6, 28.8, 26.9, 32.7, 13.5, 23.9},
                                                        {150, 150, 35.3, 36.4, 47.8, 29.7, 37.6},
                                                        {150, 150, 35.2, 36.3, 47.8, 29.7, 37.7},
                                                        {53.5, 53.0, 41.7, 30.3, 34.5, 15.1, 50.8}};
    struct rig rig;
    rig_init(&rig, *state);
    struct EncodeInput *inputs = rig.texels.mapped;
    for (uint32_t kind = 0; kind < KINDS; kind++) {
        double corners[ENCODE_FORMATS] = {0};
        roll_seed(kind + 1);
        for (uint32_t i = 0; i < BLOCKS; i++) {
            make_block(kind, inputs[i].rgba);
            for (uint32_t format = 0; format < ENCODE_FORMATS; format++)
                corners[format] += corner_error(format, inputs[i].rgba);
        }
        for (uint32_t format = 0; format < ENCODE_FORMATS; format++) {
            double corner_psnr = psnr(corners[format] * 1.001, channel_count(format));
            compare(&rig, format, names[kind], fmax(least[format][kind], corner_psnr), 1000);
        }
    }
    rig_finish(&rig);
}

/* Loads four planes of a material of 512 x 512 texels; -1: all 255. Returns false if the file is
 * missing. */
static bool load_material(const char *name, const int planes[4], struct EncodeInput *inputs)
{
    enum { SIZE = 512, PER_ROW = SIZE / 4 };
    const char *data = getenv("SLUICE_TEST_DATA"), *root = getenv("SLUICE_SOURCE_ROOT");
    static uint8_t bytes[8 * SIZE * SIZE];
    char path[512];
    snprintf(path, sizeof path, "%s%s/ntc/materials/%s",
             data   ? data
             : root ? root
                    : ".",
             data ? "" : "/../shared/data", name);
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    assert_true(fread(bytes, SIZE * SIZE, 1, file) == 1);
    assert_true(fread(bytes + SIZE * SIZE, 1, sizeof bytes - SIZE * SIZE, file) > 0);
    fclose(file);
    for (uint32_t i = 0; i < BLOCKS; i++) /* every 16th block, in columns that vary by row */
        for (uint32_t t = 0; t < 64; t++) {
            uint32_t block = 16 * i + i / (PER_ROW / 16) % 16;
            uint32_t x = block % PER_ROW * 4 + t / 4 % 4, y = block / PER_ROW * 4 + t / 16;
            int plane = planes[t % 4];
            inputs[i].rgba[t] =
                plane < 0 ? 1.0f : bytes[(size_t)plane * SIZE * SIZE + y * SIZE + x] / 255.0f;
        }
    return true;
}

static void blocks_of_materials_are_near_to_the_bakers(void **state)
{
    static const struct {
        const char *name, *file;
        int planes[4];
        double least[ENCODE_FORMATS]; ///< dB, about 0.3 below the measured values; 0: not compared
    } materials[] = {
        {"bronze albedo", "bronze.u8", {0, 1, 2, -1}, {34.5, 43.2, 43.0, 42.6}},
        {"bronze albedo, height", "bronze.u8", {0, 1, 2, 3}, {0, 0, 0, 38.2}},
        {"bronze normal, roughness, cavity", "bronze.u8", {4, 5, 6, 7}, {0, 0, 40.8, 32.5}},
        {"foliage", "foliage.u8", {0, 1, 2, -1}, {30.7, 0, 0, 38.1}},
        {"foliage, mask", "foliage.u8", {0, 1, 2, 3}, {0, 0, 0, 34.2}}};
    static const double most_less[ENCODE_FORMATS] = {0.6, 0, 0, 0.4};
    struct rig rig;
    rig_init(&rig, *state);
    bool found = true;
    for (size_t m = 0; m < sizeof materials / sizeof *materials && found; m++) {
        found = load_material(materials[m].file, materials[m].planes, rig.texels.mapped);
        for (uint32_t format = 0; format < ENCODE_FORMATS && found; format++)
            if (materials[m].least[format] > 0)
                compare(&rig, format, materials[m].name, materials[m].least[format],
                        most_less[format]);
    }
    rig_finish(&rig);
    if (!found)
        SKIP_TEST("the materials are not there; SLUICE_TEST_DATA says where the data folder is");
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(blocks_of_each_kind_beat_the_corners_of_their_box),
        cmocka_unit_test(blocks_of_materials_are_near_to_the_bakers),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
