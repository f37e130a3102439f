/*
 * Compares pictures of the tested mode with pictures of dense residency, where a driver's sampler
 * does everything: over tile borders, wrapped, mirrored, clamped, magnified, and partly resident.
 */
#include "device/scene.h"

#include "support/streamer_manager.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define SIDE 128u
#define PIXELS (SIDE * SIDE)

/* A plane seen through a window: uv is affine in the pixel, and farther away with each row. */
struct look {
    const char *name;
    double left, top;          /* uv of the first pixel */
    double across, down;       /* uv per pixel */
    double skew;               /* change of u per row */
    double farther;            /* growth of `across` from the first row to the last; 0: none */
    double texels_x, texels_y; /* texels of level 0 per pixel, instead of across and down */
    bool magnified, skewed;
};

struct picture_case {
    uint32_t width, height;
    SluiceFormat format;
    VkSamplerAddressMode u, v;
    float anisotropy;
};

struct session {
    struct scene scene;
    uint32_t texture;
    uint32_t feedback_count; /* number of leading pixels that write feedback */
};

static void record(void *user, VkCommandBuffer commands)
{
    struct session *s = user;
    const struct probe_texture probe = s->scene.textures[s->texture].probe;
    prober_record(&s->scene.prober, commands, probe, 0, PIXELS, PROBE_SAMPLE | PROBE_RESIDENCY);
    if (s->feedback_count)
        prober_record(&s->scene.prober, commands, probe, 0, s->feedback_count, PROBE_FEEDBACK);
}

static void aim(struct session *s, const struct picture_case *c, const struct look *look)
{
    struct ProbeInput *inputs = prober_inputs(&s->scene.prober);
    double across = look->texels_x > 0 ? look->texels_x / c->width : look->across;
    double down = look->texels_y > 0 ? look->texels_y / c->height : look->down;
    for (uint32_t y = 0; y < SIDE; y++)
        for (uint32_t x = 0; x < SIDE; x++) {
            double scale = 1 + look->farther * y / SIDE;
            double u = look->left + ((double)x - SIDE / 2) * across * scale + y * look->skew;
            inputs[y * SIDE + x] =
                (struct ProbeInput){.uv = {(float)u, (float)(look->top + y * down)},
                                    .dx = {(float)(across * scale), 0},
                                    .dy = {(float)look->skew, (float)down},
                                    .maxAnisotropy = c->anisotropy};
        }
}

#define MAX_LOOKS 5u

struct pictures {
    struct ProbeOutput pixels[MAX_LOOKS * PIXELS];
    uint32_t packed_level; ///< this level and coarser ones are always resident
};

/* Draws all looks in turn, each into a picture. The first pixels of each write feedback. */
static void draw_in(struct harness *h, SluiceResidencyMode mode, const struct picture_case *c,
                    enum pattern_kind kind, const struct look *looks, uint32_t look_count,
                    uint32_t feedback_count, struct pictures *out)
{
    struct ProbeOutput *pictures = out->pixels;
    struct session s = {.feedback_count = feedback_count};
    scene_init(
        &s.scene, h,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .residencyMode = mode,
                                         .feedbackTimeoutTicks = 1000});
    s.texture = scene_add_as(&s.scene, pattern_source(kind, c->width, c->height, c->format), c->u,
                             c->v, c->anisotropy, SLUICE_NO_TEXTURE);
    for (uint32_t l = 0; l < look_count; l++) {
        struct ProbeOutput *picture = &pictures[(size_t)l * PIXELS];
        aim(&s, c, &looks[l]);
        harness_settle(h, s.scene.streamer, l ? 7 : 10, record, &s);
        memcpy(picture, prober_outputs(&s.scene.prober), PIXELS * sizeof *picture);
        for (uint32_t i = 0; i < feedback_count; i++)
            assert_int_equal(picture[i].missingLevels, 0);
    }
    assert_int_equal(scene_non_resident(&s.scene), 0);
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(sluiceGetTextureLayout(manager_of(s.scene.streamer),
                                    s.scene.textures[s.texture].texture.textureId, &layout));
    out->packed_level = layout.desc.regularMipCount;
    scene_finish(&s.scene);
}

/*
 * Returns whether equal levels are resident. Packed levels always are: a driver's mip tail may
 * begin with a finer level than dense residency packs.
 */
static bool is_comparable(const struct ProbeOutput *a, uint32_t a_packed,
                          const struct ProbeOutput *b, uint32_t b_packed)
{
    if (a->level == b->level)
        return true;
    bool packed = a->level < b->level ? a->level >= a_packed : b->level >= b_packed;
    if (!packed)
        fail_msg("level %u is sampled (packed from %u), not %u (packed from %u)", a->level,
                 a_packed, b->level, b_packed);
    return false;
}

static double psnr(const struct pictures *pictures, const struct pictures *truth, uint32_t look)
{
    const struct ProbeOutput *a = &pictures->pixels[(size_t)look * PIXELS];
    const struct ProbeOutput *b = &truth->pixels[(size_t)look * PIXELS];
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        if (!is_comparable(&a[i], pictures->packed_level, &b[i], truth->packed_level))
            continue;
        count++;
        for (uint32_t k = 0; k < 4; k++) {
            double d = (double)a[i].color[k] - (double)b[i].color[k];
            assert_true(isfinite(d));
            sum += d * d;
        }
    }
    assert_true(count >= PIXELS / 4);
    double mean = sum / (count * 4.0);
    return mean > 0 ? -10 * log10(mean) : 999;
}

static const struct look looks[] = {
    {"corner of four tiles, magnified", 0.5, 0.49, .texels_x = 0.11, .texels_y = 0.09,
     .magnified = true},
    {"corner of the texture, wrapped", 0.003, -0.05, .texels_x = 0.7, .texels_y = 0.8,
     .magnified = true},
    {"seam, magnified", 1.0, 0.999, .texels_x = 0.02, .texels_y = 0.02, .magnified = true},
    {"whole, minified and skewed", 0.4, -0.3, 0.011, 0.013, .skew = 0.004, .skewed = true},
    {"floor", 0.3, 0.1, .texels_x = 0.6, .texels_y = 1.3, .farther = 7},
};
#define LOOKS (sizeof looks / sizeof looks[0])
static_assert(LOOKS <= MAX_LOOKS, "pictures");

static const struct picture_case cases[] = {
    {512, 512, SLUICE_FORMAT_R8G8B8A8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
     VK_SAMPLER_ADDRESS_MODE_REPEAT, 1},
    {1000, 600, SLUICE_FORMAT_R8G8B8A8_SRGB, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
     VK_SAMPLER_ADDRESS_MODE_REPEAT, 1},
    {777, 1311, SLUICE_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
     VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT, 1},
    {2048, 100, SLUICE_FORMAT_R32_SFLOAT, VK_SAMPLER_ADDRESS_MODE_REPEAT,
     VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 1},
    {1, 3000, SLUICE_FORMAT_R8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
     VK_SAMPLER_ADDRESS_MODE_REPEAT, 1},
    {900, 700, SLUICE_FORMAT_R8_UNORM, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
     VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, 1},
    {600, 500, SLUICE_FORMAT_R32G32B32A32_SFLOAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER,
     VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER, 1},
};
/* Drivers filter these cases differently, one by the finer level only. Finds gross errors only. */
static const struct picture_case anisotropic_cases[] = {
    {1024, 1024, SLUICE_FORMAT_R8G8B8A8_UNORM, VK_SAMPLER_ADDRESS_MODE_REPEAT,
     VK_SAMPLER_ADDRESS_MODE_REPEAT, 8},
    {1000, 600, SLUICE_FORMAT_R16G16B16A16_SFLOAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
     VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, 16},
};

#define CASES (sizeof cases / sizeof cases[0])

/* Returns the number of pixels that are coarser than they should be. */
static uint32_t compare(struct harness *h, const struct picture_case *c, enum pattern_kind kind,
                        const struct look *look, uint32_t look_count, uint32_t feedback_count,
                        const double *at_least)
{
    static struct pictures truth, pictures;
    draw_in(h, SLUICE_RESIDENCY_MODE_DENSE, c, kind, look, look_count, feedback_count, &truth);
    draw_in(h, h->mode, c, kind, look, look_count, feedback_count, &pictures);
    for (uint32_t l = 0; l < look_count; l++) {
        double db = psnr(&pictures, &truth, l);
        fprintf(stderr, "# %s, %s, %ux%u %s: %.1f dB of %.0f\n",
                kind == PATTERN_HASH ? "noise" : "waves", look[l].name, c->width, c->height,
                sluiceGetFormatName(c->format), db, at_least[l]);
        if (db < at_least[l])
            fail_msg("%s, %s, %ux%u %s, modes %d %d, anisotropy %g, feedback of %u pixels: %.1f dB",
                     kind == PATTERN_HASH ? "noise" : "waves", look[l].name, c->width, c->height,
                     sluiceGetFormatName(c->format), (int)c->u, (int)c->v, (double)c->anisotropy,
                     feedback_count, db);
    }
    uint32_t missing = 0;
    for (uint32_t i = 0; i < look_count * PIXELS; i++)
        missing += pictures.pixels[i].missingLevels != 0;
    return missing;
}

static bool is_cpu(struct harness *h)
{
    VkPhysicalDeviceProperties properties;
    h->GetPhysicalDeviceProperties(h->physical_device, &properties);
    return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

/*
 * In dB. A GPU samples sparse images like others; lavapipe uses floats instead of 8 bits. Pages are
 * sampled at the formula's level. A GPU's own level deviates by up to 0.12, which noise shows. It
 * is up to half a level coarser if the derivatives are not at right angles (docs/drivers.md). Only
 * a fragment shader can query it.
 */
static double least_psnr(struct harness *h, enum pattern_kind kind, const struct look *look)
{
    if (is_cpu(h))
        return 45;
    if (h->mode == SLUICE_RESIDENCY_MODE_SPARSE)
        return 55;
    if (look->magnified)
        return 45;
    return kind == PATTERN_HASH ? 25 : look->skewed ? 30 : 45;
}

static void settled_pictures_are_those_of_dense_residency(void **state)
{
    struct harness *h = *state;
    double noise[LOOKS], waves[LOOKS];
    for (size_t l = 0; l < LOOKS; l++) {
        noise[l] = least_psnr(h, PATTERN_HASH, &looks[l]);
        waves[l] = least_psnr(h, PATTERN_WAVES, &looks[l]);
    }
    for (size_t c = 0; c < CASES; c++) {
        compare(h, &cases[c], PATTERN_HASH, looks, LOOKS, PIXELS, noise);
        if (c % 3 == 0)
            compare(h, &cases[c], PATTERN_WAVES, looks, LOOKS, PIXELS, waves);
    }
}

static void half_resident_pictures_are_those_of_dense_residency(void **state)
{
    struct harness *h = *state;
    uint32_t missing = 0;
    for (size_t c = 0; c < 3; c++)
        for (size_t l = 0; l < LOOKS; l++) {
            enum pattern_kind kind = is_cpu(h) || looks[l].magnified ? PATTERN_HASH : PATTERN_WAVES;
            double at_least = least_psnr(h, kind, &looks[l]);
            missing += compare(h, &cases[c], kind, &looks[l], 1, PIXELS / 2, &at_least);
        }
    assert_true(missing > PIXELS / 4);
}

static void anisotropic_pictures_are_about_those_of_dense_residency(void **state)
{
    struct harness *h = *state;
    if (!h->anisotropy)
        SKIP_TEST("the device has no anisotropic filtering");
    double at_least[LOOKS];
    for (size_t l = 0; l < LOOKS; l++)
        at_least[l] = 20;
    for (size_t c = 0; c < 2; c++)
        compare(h, &anisotropic_cases[c], PATTERN_WAVES, looks, LOOKS, PIXELS, at_least);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    if (h.mode == SLUICE_RESIDENCY_MODE_DENSE) {
        printf("1..0 # SKIP dense residency is what others are compared with\n");
        return harness_finish(&h, 77);
    }
    struct CMUnitTest tests[] = {
        cmocka_unit_test(settled_pictures_are_those_of_dense_residency),
        cmocka_unit_test(half_resident_pictures_are_those_of_dense_residency),
        cmocka_unit_test(anisotropic_pictures_are_about_those_of_dense_residency),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
