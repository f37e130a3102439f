/*
 * PSNR and Mpixel/s of block encoders on pictures: one JSON object per picture, format and quality.
 *
 *     BUILD/tests/bake/encoder_figures FORMAT[,FORMAT...] PICTURE...
 *
 * mpixel_per_s is processor time of one thread in the encoder, not wall time. psnr is over R, G and
 * B, and A if the picture has it; for BC6H, over colors clamped to [0, 1] and encoded as sRGB.
 * rms_steps, for BC6H alone, is the root mean square of steps between halves.
 */
#define _XOPEN_SOURCE 700

#include "bake/blocks.h"
#include "bake/picture.h"
#include "bake/plan.h"
#include "support/bptc_decode.h"

#include "../../tools/common/chosen_names.h"

#include "base/alloc.h"
#include "image/half.h"
#ifdef HAVE_SQUISH
#include "bake/squish_back.h"
#endif

#ifdef HAVE_ASTC
#include "bake/astc_back.h"
#endif

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <vips/vips.h>

static const struct {
    const char *name;
    SluiceFormat format;
    int squish; ///< kind for squish_back; -1: another decoder
} formats[] = {
    {"bc1", SLUICE_FORMAT_BC1_RGBA_UNORM_BLOCK, 0},
    {"bc3", SLUICE_FORMAT_BC3_UNORM_BLOCK, 1},
    {"bc7", SLUICE_FORMAT_BC7_UNORM_BLOCK, -1},
    {"bc6h", SLUICE_FORMAT_BC6H_UFLOAT_BLOCK, -1},
    {"bc6hs", SLUICE_FORMAT_BC6H_SFLOAT_BLOCK, -1},
    {"astc-4x4", SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK, -1},
    {"astc-8x8", SLUICE_FORMAT_ASTC_8x8_UNORM_BLOCK, -1},
};
static const char *const qualities[] = {"normal", "fast", "best"};

struct texels {
    SluiceFormat format; ///< blocks
    uint32_t width, height, size;
    bool alpha;
    char *bytes; ///< RGBA bytes or halves
};

static double processor_time(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static bool load(const char *path, SluiceFormat format, struct texels *texels)
{
    static float decoded16[65536];
    static const SluiceLogCallback log;
    const SluiceAllocationCallbacks cb = slc_allocator(NULL);
    const struct slc_picture_opening opening = {.max_memory = (uint64_t)4 << 30};
    SluiceBakeSettings settings = {.structSize = sizeof settings, .format = format};
    struct slc_picture *picture;
    struct slc_replaced replaced;
    struct slc_plan plan;
    slc_decode_srgb16(decoded16);
    settings.transfer = SLUICE_BAKE_TRANSFER_SRGB;
    if (slc_picture_open(path, &opening, &cb, &log, &picture) != SLUICE_SUCCESS)
        return false;
    if (picture->sample == SLC_SAMPLE_F16 || picture->sample == SLC_SAMPLE_F32)
        settings.transfer = SLUICE_BAKE_TRANSFER_LINEAR;
    SluiceFormat twin = slc_format_twin(format, true);
    settings.format = twin;
    picture->alpha = picture->alpha && twin != format;
    if (slc_plan_make(picture, &settings, decoded16, &plan) != SLUICE_SUCCESS)
        return false;
    plan.rules.straight = false;
    if (twin != format) /* floats are shown as sRGB bytes, too */
        plan.rules.format = SLUICE_FORMAT_R8G8B8A8_SRGB;
    texels->format = format;
    texels->width = picture->width;
    texels->height = picture->height;
    texels->alpha = picture->alpha;
    texels->size = sluiceGetFormatTexelSize(plan.rules.format);
    texels->bytes = malloc((size_t)picture->width * picture->height * texels->size);
    float *row = malloc((size_t)picture->width * 16);
    for (uint32_t y = 0; y < picture->height; y++) {
        const void *samples;
        if (picture->implementation->row(picture, y, &samples) != SLUICE_SUCCESS)
            return false;
        slc_read_texels(&plan.rules, samples, row, picture->width, &replaced);
        slc_write_texels(&plan.rules, row, 1.0f,
                         texels->bytes + (size_t)y * picture->width * texels->size, picture->width);
    }
    free(row);
    slc_picture_close(picture);
    return true;
}

static double encode_srgb(double value)
{
    value = value < 0 ? 0 : value > 1 ? 1 : value;
    return 255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * pow(value, 1 / 2.4) - 0.055);
}

static int steps_of(uint16_t half)
{
    return half & 0x8000 ? -(half & 0x7fff) : half;
}

/* Sums of squared errors: in bytes or sRGB, and in steps between halves. */
struct errors {
    double bytes, steps;
};

static void add_errors(const struct texels *texels, int squish, const uint8_t *block, uint32_t x,
                       uint32_t y, struct errors *errors)
{
    uint8_t rgba[64];
    uint16_t rgb[48];
    int mode;
    bool is_bc6h = texels->size == 8;
    if (is_bc6h)
        bc6h_decode(texels->format == SLUICE_FORMAT_BC6H_SFLOAT_BLOCK, block, rgb, &mode);
#ifdef HAVE_SQUISH
    else if (squish >= 0)
        squish_back(squish, block, rgba);
#endif
    else
        bc7_decode(block, rgba, &mode);
    for (uint32_t i = 0; i < 16; i++) {
        uint32_t column = x + i % 4, row = y + i / 4;
        if (column >= texels->width || row >= texels->height)
            continue;
        const char *texel = texels->bytes + ((size_t)row * texels->width + column) * texels->size;
        for (uint32_t c = 0; c < (texels->alpha ? 4u : 3u); c++) {
            double off = is_bc6h ? 0 : (double)((const uint8_t *)texel)[c] - rgba[4 * i + c];
            if (is_bc6h) {
                uint16_t half;
                memcpy(&half, texel + 2 * c, 2);
                double steps = steps_of(half) - steps_of(rgb[3 * i + c]);
                errors->steps += steps * steps;
                off = encode_srgb(slc_float_from_half(half)) -
                      encode_srgb(slc_float_from_half(rgb[3 * i + c]));
            }
            errors->bytes += off * off;
        }
    }
}

/* Adds the errors of ASTC blocks, as astcenc's decoder decodes them. */
static void add_astc_errors(const struct texels *texels, uint32_t extent, uint8_t *blocks,
                            size_t size, struct errors *errors)
{
    size_t count = (size_t)texels->width * texels->height;
    uint8_t *back = calloc(count, 4);
#ifdef HAVE_ASTC
    if (!back || !astc_back(extent, blocks, size, texels->width, texels->height, back))
        abort();
#else
    (void)extent, (void)blocks, (void)size;
#endif
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < (texels->alpha ? 4u : 3u); c++) {
            double off = (double)((const uint8_t *)texels->bytes)[4 * i + c] - back[4 * i + c];
            errors->bytes += off * off;
        }
    free(back);
}

static void measure(const char *path, size_t f, SluiceBakeQuality quality,
                    const struct texels *texels, struct slc_astc_pool *astc)
{
    struct errors errors = {0};
    SluiceFormatInfo info = {.structSize = sizeof info};
    (void)sluiceGetFormatInfo(texels->format, &info);
    size_t size = (size_t)sluiceGetFormatRegionSize(texels->format, texels->width, texels->height);
    uint8_t *blocks = malloc(size);
    double begin = processor_time();
    const struct slc_block_encoder encoder = {texels->format, quality, astc};
    if (slc_encode_blocks(&encoder, texels->bytes, (size_t)texels->width * texels->size,
                          texels->width, texels->height, blocks) != SLUICE_SUCCESS)
        abort();
    double seconds = processor_time() - begin;
    const uint8_t *block = blocks;
    if (texels->format >= SLUICE_FORMAT_ASTC_4x4_UNORM_BLOCK)
        add_astc_errors(texels, info.blockWidth, blocks, size, &errors);
    else
        for (uint32_t y = 0; y < texels->height; y += 4)
            for (uint32_t x = 0; x < texels->width; x += 4, block += info.blockSize)
                add_errors(texels, formats[f].squish, block, x, y, &errors);
    double texel_count = (double)texels->width * texels->height;
    double count = texel_count * (texels->alpha ? 4 : 3);
    const char *slash = strrchr(path, '/');
    printf("{\"picture\": \"%s\", \"width\": %u, \"height\": %u, \"format\": \"%s\", "
           "\"quality\": \"%s\", \"mpixel_per_s\": %.2f, \"psnr\": %.2f",
           slash ? slash + 1 : path, texels->width, texels->height, formats[f].name,
           qualities[quality], texel_count / seconds / 1e6,
           10 * log10(255.0 * 255.0 * count / errors.bytes));
    if (texels->size == 8)
        printf(", \"rms_steps\": %.2f", sqrt(errors.steps / count));
    printf("}\n");
    free(blocks);
}

int main(int argc, char **argv)
{
    if (argc < 3 || VIPS_INIT(argv[0])) {
        fprintf(stderr, "usage: encoder_figures FORMAT[,FORMAT...] PICTURE...\n");
        return 2;
    }
    const SluiceAllocationCallbacks cb = slc_allocator(NULL);
    struct slc_astc_pool astc;
    slc_astc_pool_init(&astc, &cb);
    for (int a = 2; a < argc; a++)
        for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++) {
            struct texels texels;
            if (!names_have(argv[1], formats[f].name) || !slc_can_encode_blocks(formats[f].format))
                continue;
            if (!load(argv[a], formats[f].format, &texels)) {
                fprintf(stderr, "encoder_figures: %s cannot be read\n", argv[a]);
                return 1;
            }
            for (int q = 0; q < (formats[f].squish >= 0 ? 1 : 3); q++)
                measure(argv[a], f, (SluiceBakeQuality)q, &texels, &astc);
            free(texels.bytes);
        }
    slc_astc_pool_finish(&astc);
    return 0;
}
