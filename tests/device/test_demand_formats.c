/* Every format: tiles, tails, cut blocks, and the color of the last level. */
#include "device/blocks.h"
#include "device/cut_source.h"
#include "device/demand_runner.h"

#include "image/convert.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

static struct harness h;

enum { WIDTH = 1337, HEIGHT = 611, LEVELS = 11 };

static bool is_usable(SluiceFormat format)
{
    SluiceVulkanFormatCapabilities caps = {.structSize = sizeof caps};
    CHECK_OK(
        sluiceGetVulkanFormatCapabilities(h.instance, h.physical_device, h.get, format, &caps));
    return caps.sampled && caps.linearFilter;
}

static bool is_decoded(SluiceFormat format)
{
    return format != SLUICE_FORMAT_BC6H_UFLOAT_BLOCK && format != SLUICE_FORMAT_BC6H_SFLOAT_BLOCK &&
           (format < SLUICE_FORMAT_ETC2_R8G8B8_UNORM_BLOCK || format >= SLUICE_FORMAT_R8_SNORM);
}

static bool is_signed(SluiceFormat format)
{
    return format == SLUICE_FORMAT_BC4_SNORM_BLOCK || format == SLUICE_FORMAT_BC5_SNORM_BLOCK;
}

static bool is_srgb(SluiceFormat format)
{
    return format == SLUICE_FORMAT_R8G8B8A8_SRGB;
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    const float *low = user;
    (void)width, (void)height;
    for (uint32_t i = 0; i < 4; i++)
        rgba[i] = *low + (1 - *low) * (float)((x * (7 + i) + y * (13 - i) + level * 31) % 64) / 64;
}

static SluiceImageSource *create_source(SluiceFormat format)
{
    SluiceImageSource *source;
    if (sluiceGetFormatTexelSize(format) == 0)
        return block_source(WIDTH, HEIGHT, format);
    static float lowest[] = {0, -1};
    bool has_sign = strstr(sluiceGetFormatName(format), "SNORM") != NULL;
    const SluiceProceduralImage image = {&lowest[has_sign], texel};
    const SluiceImageInfo info = {sizeof info, WIDTH,  HEIGHT,
                                  0,           format, sluiceGetFormatName(format)};
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &source));
    return source;
}

static struct block_range expected(SluiceImageSource *source, SluiceFormat format, uint32_t level,
                                   uint32_t x, uint32_t y)
{
    struct block_range range;
    if (sluiceGetFormatTexelSize(format) == 0)
        return block_texel(format, level, x, y);
    uint8_t bytes[16];
    float rgba[4], slack = is_srgb(format) ? 0.005f : 1e-6f;
    const SluiceImageRegion region = {level, x, y, 1, 1};
    CHECK_OK(sluiceReadImageRegion(source, &region, bytes, sizeof bytes));
    slc_texels_to_rgba(format, bytes, rgba, 1);
    for (uint32_t i = 0; i < 4; i++) {
        range.low[i] = rgba[i] - slack;
        range.high[i] = rgba[i] + slack;
    }
    return range;
}

static void check(const struct runner *r, uint32_t sample, SluiceImageSource *source,
                  SluiceFormat format, uint32_t level, uint32_t x, uint32_t y)
{
    struct RunnerOutput out = runner_output(r, sample);
    struct block_range range = expected(source, format, level, x, y);
    bool gray = level == LEVELS - 1 && !is_decoded(format);
    for (uint32_t i = 0; i < 4; i++) {
        if (gray) {
            range.low[i] = range.high[i] = i < 3 ? 0.5f : 1;
        }
        if (!out.resident || !(out.color[i] >= range.low[i] - 1e-5f) ||
            !(out.color[i] <= range.high[i] + 1e-5f))
            fail_msg("%s, level %u (%u, %u), channel %u: %g is not within %g and %g",
                     sluiceGetFormatName(format), level, x, y, i, (double)out.color[i],
                     (double)range.low[i], (double)range.high[i]);
    }
}

static void texel_at(uint32_t level, uint32_t i, uint32_t *x, uint32_t *y)
{
    uint32_t w = WIDTH >> level ? WIDTH >> level : 1, t = HEIGHT >> level ? HEIGHT >> level : 1;
    *x = i % 3 * (w - 1) / 2;
    *y = i / 3 * (t - 1) / 2;
}

static void check_format(SluiceFormat format)
{
    struct runner r;
    SluiceDemandTextureId id;
    SluiceImageSource *source = create_source(format);
    runner_init(&r, &h, NULL);
    const SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info, .image.source = source, .pSampler = &runner_nearest};
    CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &id));
    for (uint32_t l = 0; l < LEVELS; l++)
        for (uint32_t i = 0, x, y; i < 9; i++) {
            texel_at(l, i, &x, &y);
            runner_add_texel(&r, id, WIDTH, HEIGHT, l, x, y);
        }
    runner_load(&r, 20);
    for (uint32_t l = 0; l < LEVELS; l++)
        for (uint32_t i = 0, x, y; i < 9; i++) {
            texel_at(l, i, &x, &y);
            check(&r, l * 9 + i, source, format, l, x, y);
        }
    runner_finish(&r);
    sluiceDestroyImageSource(source);
}

static void every_format_shows_what_is_in_the_image(void **state)
{
    (void)state;
    uint32_t count = 0;
    for (uint32_t f = 1; f < SLUICE_FORMAT_COUNT; f++) {
        if (!is_usable((SluiceFormat)f))
            continue;
        check_format((SluiceFormat)f);
        count++;
    }
    print_message("# formats %u\n", count);
    assert_true(count >= 10);
}

/* 2 x 2 texels, whose two levels are one block of random bits. */
struct random_block {
    SluiceImageSource base;
    SluiceImageInfo info;
    uint8_t block[16];
};

static SluiceResult get_block_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    *info = ((struct random_block *)source)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_block(SluiceImageSource *source, const SluiceImageRegion *region,
                               void *texels, size_t row_pitch)
{
    const struct random_block *random = (const struct random_block *)source;
    SluiceFormatInfo format = {.structSize = sizeof format};
    (void)region, (void)row_pitch;
    CHECK_OK(sluiceGetFormatInfo(random->info.format, &format));
    memcpy(texels, random->block, format.blockSize);
    return SLUICE_SUCCESS;
}

static void destroy_block(SluiceImageSource *source)
{
    (void)source;
}

/*
 * Tolerance that Direct3D allows between end points: a step, and 3 % of their distance. The
 * distance is up to 2 for signed formats, where devices may interpolate from -128. Decoding sRGB
 * enlarges differences up to 2.3 times.
 */
static float decoding_slack(SluiceFormat format)
{
    bool encoded = strstr(sluiceGetFormatName(format), "SRGB") != NULL;
    return is_signed(format) ? 2.0f / 127 + 0.06f : (1.0f / 255 + 0.03f) * (encoded ? 2.3f : 1);
}

static void the_color_of_a_block_is_what_the_device_decodes(void **state)
{
    (void)state;
    enum { COUNT = 256, FIRST = SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK };
    static const SluiceImageSourceInterface interface = {sizeof interface, get_block_info,
                                                         read_block, destroy_block};
    static struct random_block blocks[COUNT];
    uint32_t seed = 1;
    for (uint32_t f = FIRST; f <= SLUICE_FORMAT_BC7_SRGB_BLOCK; f++) {
        struct runner r;
        if (!is_usable((SluiceFormat)f) || !is_decoded((SluiceFormat)f))
            continue;
        runner_init(&r, &h, NULL);
        for (uint32_t i = 0; i < COUNT; i++) {
            SluiceDemandTextureId id;
            blocks[i] = (struct random_block){
                {&interface}, {sizeof(SluiceImageInfo), 2, 2, 2, (SluiceFormat)f, "random"}};
            for (uint32_t b = 0; b < 16; b++)
                blocks[i].block[b] = (uint8_t)((seed = seed * 1664525u + 1013904223u) >> 24);
            if (f >= SLUICE_FORMAT_BC7_UNORM_BLOCK) /* all modes */
                blocks[i].block[0] = (uint8_t)((blocks[i].block[0] | 1) << i % 8);
            const SluiceDemandTextureCreateInfo info = {.structSize = sizeof info,
                                                        .image.source = &blocks[i].base,
                                                        .pSampler = &runner_nearest};
            CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &id));
            runner_add_texel(&r, id, 2, 2, 0, 0, 0);
            runner_add_texel(&r, id, 2, 2, 1, 0, 0);
        }
        runner_load(&r, 9);
        assert_int_equal(runner_statistics(&r).residentTileCount, COUNT);
        for (uint32_t i = 0; i < COUNT; i++) {
            struct RunnerOutput decoded = runner_output(&r, 2 * i);
            struct RunnerOutput base = runner_output(&r, 2 * i + 1);
            assert_true(decoded.resident && base.resident);
            float slack = decoding_slack((SluiceFormat)f);
            for (uint32_t c = 0; c < 4; c++)
                if (!(fabsf(decoded.color[c] - base.color[c]) < slack))
                    fail_msg("%s, channel %u: %g, and the device decodes %g",
                             sluiceGetFormatName((SluiceFormat)f), c, (double)base.color[c],
                             (double)decoded.color[c]);
        }
        runner_finish(&r);
    }
}

/* Decodes one texel of each block, as the library does. */
static void mean_color(SluiceImageSource *source, SluiceFormat format, uint32_t level,
                       double mean[4])
{
    uint32_t w = WIDTH >> level, t = HEIGHT >> level, count = 0;
    uint32_t step = sluiceGetFormatTexelSize(format) ? 1 : 4;
    for (uint32_t y = 0; y < t; y += step)
        for (uint32_t x = 0; x < w; x += step, count++) {
            struct block_range range = expected(source, format, level, x, y);
            for (uint32_t c = 0; c < 4; c++)
                mean[c] += (range.low[c] + range.high[c]) / 2;
        }
    for (uint32_t c = 0; c < 4; c++)
        mean[c] /= count;
}

static void check_short_chain(SluiceFormat format, uint32_t level_count)
{
    struct runner r;
    SluiceDemandTextureId id;
    struct cut_source cut;
    uint32_t x, y;
    cut_source_init(&cut, create_source(format), level_count);
    runner_init(&r, &h, NULL);
    const SluiceDemandTextureCreateInfo info = {
        .structSize = sizeof info, .image.source = &cut.base, .pSampler = &runner_nearest};
    CHECK_OK(sluiceAddDemandTexture(r.loader, &info, &id));
    for (uint32_t l = 0; l < level_count; l++)
        for (uint32_t i = 0; i < 9; i++) {
            texel_at(l, i, &x, &y);
            runner_add_texel(&r, id, WIDTH, HEIGHT, l, x, y);
        }
    runner_add_texel(&r, id, WIDTH, HEIGHT, LEVELS - 1, 0, 0);
    runner_load(&r, 20);
    for (uint32_t l = 0; l < level_count; l++)
        for (uint32_t i = 0; i < 9; i++) {
            texel_at(l, i, &x, &y);
            check(&r, l * 9 + i, cut.whole, format, l, x, y);
        }
    struct RunnerOutput out = runner_output(&r, level_count * 9);
    double mean[4] = {0};
    mean_color(cut.whole, format, level_count - 1, mean);
    for (uint32_t c = 0; c < 4; c++)
        assert_true(fabs((double)out.color[c] - mean[c]) < 0.01);
    runner_finish(&r);
    sluiceDestroyImageSource(&cut.base);
}

static void chains_may_end_in_the_tail(void **state)
{
    (void)state;
    for (uint32_t count = 6; count < LEVELS; count += 2) {
        check_short_chain(SLUICE_FORMAT_R8G8B8A8_UNORM, count);
        if (is_usable(SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK))
            check_short_chain(SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, count);
    }
}

int main(void)
{
    int status = harness_init(&h);
    if (status)
        return status;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_shows_what_is_in_the_image),
        cmocka_unit_test(chains_may_end_in_the_tail),
        cmocka_unit_test(the_color_of_a_block_is_what_the_device_decodes),
    };
    return harness_finish(&h, RUN_TESTS(tests));
}
