/*
 * For any resident tiles: no sample touches a texel that is not resident, and each sample equals
 * the fully resident texture at the used level. Missing texels show in three ways: in the shader's
 * counter, as transparent texels, and by the difference to the whole texture, sampled with equal
 * derivatives.
 */
#include "device/scene.h"

#include "support/map_everything.h"
#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"

#include <math.h>
#include <string.h>

#define TEXTURES 16u
#define ROUNDS 16u
#define SAMPLES (ROUNDS * TEXTURES * SCENE_SAMPLES)

/* A source some of whose tiles cannot be read, so that finer tiles are under holes. */
struct holed_source {
    SluiceImageSource base;
    SluiceImageSource *inner;
    uint32_t seed;
};

struct kind {
    uint32_t width, height;
    SluiceFormat format;
    VkSamplerAddressMode u, v;
    float anisotropy;
};

/* Samples of all rounds, to be repeated with everything resident. */
struct sample {
    struct ProbeInput in;
    struct ProbeOutput out;
};

static struct kind kinds[TEXTURES];
static struct holed_source sources[TEXTURES];
static uint32_t regular_levels[TEXTURES];
static uint64_t fade_time;
static struct sample samples[ROUNDS][TEXTURES][SCENE_SAMPLES];

static SluiceResult get_info(SluiceImageSource *base, SluiceImageInfo *info)
{
    return sluiceGetImageInfo(((struct holed_source *)base)->inner, info);
}

/* One in eight tiles is a hole. Levels that may be packed have none. */
static bool is_hole(const struct holed_source *source, const SluiceImageRegion *region)
{
    SluiceImageInfo info = {.structSize = sizeof info}; /* on the loader's threads: no checks */
    sluiceGetImageInfo(source->inner, &info);
    if (info.width >> region->mipLevel <= 128 && info.height >> region->mipLevel <= 128)
        return false;
    uint32_t h = source->seed ^ region->x * 0x9E3779B1u ^ region->y * 0x85EBCA77u ^
                 region->mipLevel * 0xC2B2AE3Du;
    h = (h ^ h >> 15) * 0x2C1B3C6Du;
    return (h ^ h >> 13) % 8 == 0;
}

static SluiceResult read_region(SluiceImageSource *base, const SluiceImageRegion *region,
                                void *texels, size_t row_pitch)
{
    struct holed_source *source = (struct holed_source *)base;
    if (is_hole(source, region))
        return SLUICE_ERROR_IO;
    return sluiceReadImageRegion(source->inner, region, texels, row_pitch);
}

static void destroy(SluiceImageSource *base)
{
    (void)base; /* member of an array */
}

static const SluiceImageSourceInterface holed_interface = {sizeof holed_interface, get_info,
                                                           read_region, destroy};

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

/* Borders are excluded: their color would look like missing texels. */
static VkSamplerAddressMode address_mode(const struct harness *h)
{
    const VkSamplerAddressMode modes[] = {
        VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
        VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
        h->mirror_clamp ? VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE
                        : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
    return modes[roll() % 4];
}

static void make_kinds(struct harness *h)
{
    const uint32_t sizes[][2] = {{1024, 1024}, {1000, 1500}, {2048, 300}, {129, 2000}, {700, 700}};
    const SluiceFormat formats[] = {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_FORMAT_R16G16B16A16_SFLOAT,
                                    SLUICE_FORMAT_R32G32B32A32_SFLOAT};
    for (uint32_t i = 0; i < TEXTURES; i++)
        kinds[i] =
            (struct kind){sizes[i % 5][0], sizes[i % 5][1], formats[i % 3],
                          address_mode(h), address_mode(h), h->anisotropy && i % 2 ? 16.0f : 1.0f};
}

/* Returns a random coordinate, or one within two to sixteen texels of a tile's corner at the level,
 * in the image or beside it. */
static float coordinate(uint32_t size, double texels)
{
    if (roll() % 2)
        return (float)(draw() * 3 - 1);
    uint32_t tile = 64u << roll() % 2;
    double corner = floor(draw() * size / (tile * texels) + 0.5) * tile * texels;
    return (float)((corner + (draw() - 0.5) * (4 << roll() % 4) * texels) / size +
                   (roll() % 4 ? 0 : roll() % 3 - 1));
}

/* Magnified by up to 16, up to the end of the chain, and up to twice as long as anisotropy
 * allows. */
static struct ProbeInput random_input(const struct kind *kind)
{
    double texels = exp2(draw() * 10 - 4), angle = draw() * 6.2831853;
    double ratio = roll() % 3 ? exp2(draw() * (kind->anisotropy > 1 ? 6 : 2)) : 1;
    double turn = roll() % 3 ? 1.5707963 : draw() * 3;
    angle = roll() % 2 ? angle : roll() % 4 * 1.5707963;
    double w = texels / kind->width, h = texels / kind->height;
    return (struct ProbeInput){
        .uv = {coordinate(kind->width, fmax(texels, 1)), coordinate(kind->height, fmax(texels, 1))},
        .dx = {(float)(cos(angle) * w * ratio), (float)(sin(angle) * h * ratio)},
        .dy = {(float)(cos(angle + turn) * w), (float)(sin(angle + turn) * h)},
        .lodBias = roll() % 4 ? 0 : (float)(roll() % 17 - 8) / 4,
        .maxAnisotropy = kind->anisotropy};
}

typedef void aim_function(struct scene *scene, bool no_feedback);

static void aim_anywhere(struct scene *scene, bool no_feedback)
{
    for (uint32_t t = 0; t < TEXTURES; t++) {
        struct ProbeInput *inputs = scene_inputs(scene, t);
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            inputs[i] = random_input(&kinds[t]);
        scene->textures[t].sample_count = no_feedback ? SCENE_SAMPLES : 1u << roll() % 6;
        scene->textures[t].no_feedback = no_feedback;
    }
}

/* Requests one tile of level 0 in its middle, and samples along its edges, so that filters beyond
 * the edges find the coarsest levels. */
static void aim_at_islands(struct scene *scene, bool no_feedback)
{
    static uint32_t column, row;
    if (!no_feedback) {
        column = (uint32_t)roll() % 16;
        row = (uint32_t)roll() % 16;
    }
    for (uint32_t t = 0; t < TEXTURES; t++) {
        struct ProbeInput *inputs = scene_inputs(scene, t);
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++) {
            bool along = roll() % 2;
            double texel = 1.0 / kinds[t].width, tile = 64 * texel;
            double minor = exp2(draw() * 2) * texel, major = minor * exp2(draw() * 6);
            double edge = (roll() % 2 ? tile : 0) + (draw() - 0.5) * 64 * texel, at = tile * draw();
            inputs[i] =
                (struct ProbeInput){.uv = {(float)(column * tile + (along ? at : edge)),
                                           (float)(row * tile + (along ? edge : at))},
                                    .dx = {(float)(along ? major : 0), (float)(along ? 0 : major)},
                                    .dy = {(float)(along ? 0 : minor), (float)(along ? minor : 0)},
                                    .maxAnisotropy = kinds[t].anisotropy};
            if (no_feedback)
                continue;
            inputs[i].uv[0] = (float)((column + 0.5) * tile);
            inputs[i].uv[1] = (float)((row + 0.5) * tile);
            memset(inputs[i].dx, 0, sizeof inputs[i].dx);
            memset(inputs[i].dy, 0, sizeof inputs[i].dy);
        }
        scene->textures[t].sample_count = no_feedback ? SCENE_SAMPLES : 1;
        scene->textures[t].no_feedback = no_feedback;
    }
}

static void scene_begin(struct scene *scene, struct harness *h, SluiceResidencyMode mode,
                        bool whole)
{
    SluiceVulkanStreamerCreateInfo info = {.structSize = sizeof info,
                                           .residencyMode = mode,
                                           .feedbackTimeoutTicks = 6,
                                           .retryDelayTicks = 1u << 30,
                                           .texturesPerFrame = TEXTURES,
                                           .heapTileCapacity = 64,
                                           .maxHeapCount = whole ? 0 : 6,
                                           .pDebug = whole ? &map_everything : NULL,
                                           .residencyFadeTicks = fade_time};
    scene_init(scene, h, info);
    for (uint32_t t = 0; t < TEXTURES; t++) {
        const struct kind *k = &kinds[t];
        SluiceImageSource *inner = pattern_source(PATTERN_LEVEL, k->width, k->height, k->format);
        sources[t] = (struct holed_source){{.pInterface = &holed_interface}, inner, t};
        scene_add_as(scene, whole ? inner : &sources[t].base, k->u, k->v, k->anisotropy,
                     SLUICE_NO_TEXTURE);
        scene->textures[t].owns = whole;
    }
}

static void find_regular_levels(const struct scene *scene)
{
    for (uint32_t t = 0; t < TEXTURES; t++) {
        SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
        CHECK_OK(sluiceGetTextureLayout(manager_of(scene->streamer),
                                        scene->textures[t].texture.textureId, &layout));
        regular_levels[t] = layout.desc.regularMipCount;
    }
}

/* Runs frames in which few samples request tiles, then a frame in which many samples look at
 * them. */
static void draw_round(struct scene *scene, uint32_t round, aim_function *aim)
{
    struct harness *h = scene->h;
    aim(scene, false);
    harness_settle(h, scene->streamer, 1 + (uint32_t)roll() % 6, scene_record, scene);
    aim(scene, true);
    harness_settle(h, scene->streamer, 1, scene_record, scene);
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            samples[round][t][i] =
                (struct sample){scene_inputs(scene, t)[i], scene_outputs(scene, t)[i]};
    assert_int_equal(scene_non_resident(scene), 0);
}

/* Repeats the samples on the whole texture, with the used derivatives. */
static void aim_at_truth(struct scene *scene, uint32_t round, bool paged)
{
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++) {
            const struct sample *s = &samples[round][t][i];
            struct ProbeInput *in = &scene_inputs(scene, t)[i];
            *in = s->in;
            memcpy(in->dx, &s->out.footprint[0], sizeof in->dx);
            memcpy(in->dy, &s->out.footprint[2], sizeof in->dy);
            /* packed levels use the sampler in every mode */
            bool row = paged && s->out.lod < (float)regular_levels[t];
            in->lodBias = row ? fmaxf(s->out.lod, 0) : -1 - s->out.minLod;
        }
}

static void record_truth(void *user, VkCommandBuffer commands)
{
    struct scene *scene = user;
    for (uint32_t t = 0; t < TEXTURES; t++)
        prober_record(&scene->prober, commands, scene->textures[t].probe, t * SCENE_SAMPLES,
                      SCENE_SAMPLES, PROBE_TRUTH);
}

/* Filter weights have eight bits. Devices may differ in the last bit between modes. */
static float tolerance(SluiceResidencyMode mode)
{
    return mode == SLUICE_RESIDENCY_MODE_DENSE    ? 0
           : mode == SLUICE_RESIDENCY_MODE_SPARSE ? 0.008f
                                                  : 0.02f;
}

static void check_sample(const struct kind *k, const struct sample *s, const float *truth,
                         float at_most, float *worst)
{
    float used[4];
    memcpy(used, s->out.footprint, sizeof used);
    for (uint32_t c = 0; c < 4; c++) {
        float error = fabsf(s->out.color[c] - truth[c]);
        *worst = fmaxf(*worst, error);
        if (error <= at_most && fabsf(s->out.color[3] - 1) <= at_most)
            continue;
        fail_msg(
            "%ux%u %s, modes %d %d, anisotropy %g: uv %.9g %.9g dx %.9g %.9g dy %.9g %.9g "
            "bias %g; channel %u is %g, of the whole texture %g; alpha %g; lod %g, level %u of %u, "
            "sampled with dx %.9g %.9g dy %.9g %.9g, at least %g",
            k->width, k->height, sluiceGetFormatName(k->format), (int)k->u, (int)k->v,
            (double)k->anisotropy, (double)s->in.uv[0], (double)s->in.uv[1], (double)s->in.dx[0],
            (double)s->in.dx[1], (double)s->in.dy[0], (double)s->in.dy[1], (double)s->in.lodBias, c,
            (double)s->out.color[c], (double)truth[c], (double)s->out.color[3], (double)s->out.lod,
            s->out.level, s->out.wantedLevel, (double)used[0], (double)used[1], (double)used[2],
            (double)used[3], (double)s->out.minLod);
    }
}

/*
 * Packed levels of paged textures are a separate image. Samplers cannot read the level before from
 * it, as devices that deviate from the formula do from the whole image.
 */
static bool is_beside_packed(const struct scene *truth, uint32_t t, float lod)
{
    float first = (float)regular_levels[t], error = harness_level_error(truth->h) * 1.5f;
    return lod >= first && lod < first + error;
}

static void check_round(struct scene *truth, uint32_t round, SluiceResidencyMode mode, float *worst)
{
    bool paged = mode == SLUICE_RESIDENCY_MODE_PAGED;
    aim_at_truth(truth, round, mode == SLUICE_RESIDENCY_MODE_PAGED);
    harness_settle(truth->h, truth->streamer, 1, record_truth, truth);
    for (uint32_t t = 0; t < TEXTURES; t++)
        for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
            if (samples[round][t][i].out.level != SLUICE_MIP_UNTOUCHED &&
                !(paged && is_beside_packed(truth, t, samples[round][t][i].out.lod)))
                check_sample(&kinds[t], &samples[round][t][i], scene_outputs(truth, t)[i].color,
                             tolerance(mode), worst);
}

static void destroy_sources(void)
{
    for (uint32_t t = 0; t < TEXTURES; t++)
        sluiceDestroyImageSource(sources[t].inner);
}

/* Enough of the samples must be clamped, and enough must not. */
static void compare(struct harness *h, aim_function *aim)
{
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    struct scene scene;
    uint32_t clamped = 0;
    float worst = 0;
    h->quiet = true; /* holes are failed reads */
    scene_begin(&scene, h, h->mode, false);
    find_regular_levels(&scene);
    harness_settle(h, scene.streamer, 4, NULL, NULL);
    for (uint32_t round = 0; round < ROUNDS; round++)
        draw_round(&scene, round, aim);
    scene_finish(&scene);
    destroy_sources();
    h->quiet = false;
    scene_begin(&scene, h, SLUICE_RESIDENCY_MODE_DENSE, true);
    do {
        harness_settle(h, scene.streamer, 4, NULL, NULL);
        sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    } while (stats.mappedTileCount < stats.tileCount);
    for (uint32_t round = 0; round < ROUNDS; round++)
        check_round(&scene, round, h->mode, &worst);
    scene_finish(&scene);
    for (uint32_t round = 0; round < ROUNDS; round++)
        for (uint32_t t = 0; t < TEXTURES; t++)
            for (uint32_t i = 0; i < SCENE_SAMPLES; i++)
                clamped += samples[round][t][i].out.missingLevels != 0;
    print_message("# clamped %u of %u samples\n# worst %g\n", clamped, SAMPLES, (double)worst);
    assert_in_range(clamped, SAMPLES / 16, SAMPLES - SAMPLES / 16);
}

static void make_islands(const struct harness *h)
{
    const float anisotropies[] = {1, 2, 4, 8, 16};
    for (uint32_t t = 0; t < TEXTURES; t++)
        kinds[t] = (struct kind){1024,
                                 1024,
                                 SLUICE_FORMAT_R32G32B32A32_SFLOAT,
                                 address_mode(h),
                                 address_mode(h),
                                 h->anisotropy ? anisotropies[t % 5] : 1};
}

static void random_residency_shows_no_texel_that_is_not_there(void **state)
{
    roll_seed(31);
    make_kinds(*state);
    compare(*state, aim_anywhere);
}

static void random_residency_that_fades_shows_no_texel_that_is_not_there(void **state)
{
    roll_seed(33);
    make_kinds(*state);
    fade_time = 7;
    compare(*state, aim_anywhere);
    fade_time = 0;
}

static void residency_that_the_sampler_clamps_shows_no_texel_that_is_not_there(void **state)
{
    struct harness *h = *state;
    if (!h->caps.shaderResourceMinLod)
        SKIP_TEST("the device has no shaderResourceMinLod");
    h->min_lod = true;
    roll_seed(34);
    make_kinds(h);
    fade_time = 7;
    compare(h, aim_anywhere);
    fade_time = 0;
    make_islands(h);
    compare(h, aim_at_islands);
    h->min_lod = false;
}

static void what_reaches_over_an_edge_of_residency_finds_it(void **state)
{
    roll_seed(32);
    make_islands(*state);
    compare(*state, aim_at_islands);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(random_residency_shows_no_texel_that_is_not_there),
        cmocka_unit_test(random_residency_that_fades_shows_no_texel_that_is_not_there),
        cmocka_unit_test(residency_that_the_sampler_clamps_shows_no_texel_that_is_not_there),
        cmocka_unit_test(what_reaches_over_an_edge_of_residency_finds_it),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
