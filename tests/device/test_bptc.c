/* Random blocks: the decoders that test the encoders agree with the device. */
#include "device/scene.h"

#include "bake/bc6h_modes.h"
#include "image/half.h"
#include "support/bptc_decode.h"
#include "support/map_everything.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE = 256 };

struct random_source {
    SluiceImageSource base;
    SluiceImageInfo info;
};

static bool is_bc6h(SluiceFormat format)
{
    return format != SLUICE_FORMAT_BC7_UNORM_BLOCK;
}

/* Makes a block of random bits after those of a mode that the decoder knows. */
static void make_block(SluiceFormat format, uint32_t level, uint32_t x, uint32_t y,
                       uint8_t block[16])
{
    static const uint8_t modes[] = {1, 4, 5, 6};
    uint32_t random = (level * 1024 + y) * 1024 + x + 1;
    for (int i = 0; i < 16; i++) {
        random = random * 1664525u + 1013904223u;
        block[i] = (uint8_t)(random >> 24);
    }
    uint32_t number = x + y * 5;
    if (is_bc6h(format)) {
        const struct slc_bc6h_mode *mode = &slc_bc6h_modes[number % SLC_BC6H_MODE_COUNT];
        uint32_t mask = (1u << mode->value_bits) - 1;
        block[0] = (uint8_t)((block[0] & ~mask) | mode->value);
    } else {
        uint32_t mode = modes[number % 4];
        block[0] = (uint8_t)((block[0] & ~((2u << mode) - 1)) | 1u << mode);
    }
}

static SluiceResult get_info(SluiceImageSource *source, SluiceImageInfo *info)
{
    *info = ((struct random_source *)source)->info;
    return SLUICE_SUCCESS;
}

static SluiceResult read_region(SluiceImageSource *source, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    SluiceFormat format = ((struct random_source *)source)->info.format;
    for (uint32_t y = 0; y < region->height; y += 4)
        for (uint32_t x = 0; x < region->width; x += 4)
            make_block(format, region->mipLevel, (region->x + x) / 4, (region->y + y) / 4,
                       (uint8_t *)texels + y / 4 * row_pitch + (size_t)x / 4 * 16);
    return SLUICE_SUCCESS;
}

static void destroy(SluiceImageSource *source)
{
    free(source);
}

static SluiceImageSource *random_source(SluiceFormat format)
{
    static const SluiceImageSourceInterface interface = {sizeof interface, get_info, read_region,
                                                         destroy};
    struct random_source *source = malloc(sizeof *source);
    *source = (struct random_source){
        {&interface}, {sizeof(SluiceImageInfo), SIZE, SIZE, 9, format, "random blocks"}};
    return &source->base;
}

/* RGBA of texel (x, y) of level 0. False where a half is infinite, for which devices differ. */
static bool decode(SluiceFormat format, uint32_t x, uint32_t y, float rgba[4])
{
    uint8_t block[16], bytes[64];
    uint16_t halves[48];
    int mode;
    uint32_t texel = y % 4 * 4 + x % 4;
    make_block(format, 0, x / 4, y / 4, block);
    rgba[3] = 1.0f;
    if (!is_bc6h(format)) {
        assert_true(bc7_decode(block, bytes, &mode));
        for (uint32_t c = 0; c < 4; c++)
            rgba[c] = (float)bytes[4 * texel + c] / 255.0f;
        return true;
    }
    assert_true(bc6h_decode(format == SLUICE_FORMAT_BC6H_SFLOAT_BLOCK, block, halves, &mode));
    for (uint32_t c = 0; c < 3; c++) {
        if ((halves[3 * texel + c] & 0x7fff) >= 0x7c00)
            return false;
        rgba[c] = slc_float_from_half(halves[3 * texel + c]);
    }
    return true;
}

struct fetch {
    struct scene *scene;
    uint32_t texture, count;
};

static void record_fetch(void *user, VkCommandBuffer commands)
{
    struct fetch *fetch = user;
    prober_record(&fetch->scene->prober, commands, fetch->scene->textures[fetch->texture].probe, 0,
                  fetch->count, PROBE_FETCH);
}

static void fetch_and_check(struct fetch *fetch, SluiceFormat format)
{
    struct prober *prober = &fetch->scene->prober;
    harness_run(fetch->scene->h, record_fetch, fetch);
    for (uint32_t i = 0; i < fetch->count; i++) {
        float expected[4];
        uint32_t x = (uint32_t)prober_inputs(prober)[i].uv[0];
        uint32_t y = (uint32_t)prober_inputs(prober)[i].uv[1];
        const float *shown = prober_outputs(prober)[i].color;
        for (uint32_t c = 0; decode(format, x, y, expected) && c < 4; c++) {
            float off = shown[c] - expected[c];
            if (!(off <= 1e-6f && off >= -1e-6f))
                fail_msg("%s: (%u, %u) channel %u is %.9g, not %.9g", sluiceGetFormatName(format),
                         x, y, c, (double)shown[c], (double)expected[c]);
        }
    }
    fetch->count = 0;
}

static void check_format(struct harness *h, SluiceFormat format)
{
    struct scene scene;
    scene_init(
        &scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .pDebug = &map_everything});
    struct fetch fetch = {&scene, scene_add(&scene, random_source(format)), 0};
    scene_settle(&scene, 48);
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        prober_inputs(&scene.prober)[fetch.count++] =
            (struct ProbeInput){.uv = {(float)(i % SIZE), (float)(i / SIZE)}};
        if (fetch.count == PROBE_CAPACITY)
            fetch_and_check(&fetch, format);
    }
    fetch_and_check(&fetch, format);
    scene_finish(&scene);
}

static void decoders_say_what_the_device_shows(void **state)
{
    check_format(*state, SLUICE_FORMAT_BC7_UNORM_BLOCK);
    check_format(*state, SLUICE_FORMAT_BC6H_UFLOAT_BLOCK);
    check_format(*state, SLUICE_FORMAT_BC6H_SFLOAT_BLOCK);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {cmocka_unit_test(decoders_say_what_the_device_shows)};
    tests[0].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
