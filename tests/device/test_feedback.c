/* Feedback of shaders against the C twins, and against brute force for required marks. */
#include "device/scene.h"

#include "base/checked.h"
#include "support/map_everything.h"
#include "support/roll.h"
#include "support/streamer_manager.h"
#include "support/test.h"
#include "vulkan/shader_twins.h"

#include <math.h>
#include <string.h>

#define SAMPLES 4096u

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

static const float extremes[] = {0.0f,    -0.0f,    1e-45f,    1e-38f, 1e-20f,    1.0f,
                                 -1.0f,   1e6f,     -1e6f,     1e18f,  1e30f,     -1e30f,
                                 3.4e38f, INFINITY, -INFINITY, NAN,    0.999999f, 0.5f};
#define EXTREMES (sizeof extremes / sizeof extremes[0])

/* Builds the streamer's table entry again from the public layout. */
static struct SluiceTextureEntry entry_of(struct scene *scene, uint32_t index)
{
    const struct scene_texture *texture = &scene->textures[index];
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    CHECK_OK(
        sluiceGetTextureLayout(manager_of(scene->streamer), texture->texture.textureId, &layout));
    struct SluiceTextureEntry e = {.width = texture->info.width,
                                   .height = texture->info.height,
                                   .mipLevelCount = texture->info.mipLevelCount,
                                   .regularMipCount = layout.desc.regularMipCount,
                                   .regionWidth = layout.desc.feedbackRegionWidth,
                                   .regionHeight = layout.desc.feedbackRegionHeight,
                                   .regionCountX = layout.feedbackWidth,
                                   .regionCountY = layout.feedbackHeight,
                                   .addressModeU = (uint32_t)texture->u,
                                   .addressModeV = (uint32_t)texture->v};
    for (uint32_t l = 1; l < e.mipLevelCount; l++)
        if ((slc_mip_size(e.width, l) * 2 != slc_mip_size(e.width, l - 1) &&
             slc_mip_size(e.width, l - 1) > 1) ||
            (slc_mip_size(e.height, l) * 2 != slc_mip_size(e.height, l - 1) &&
             slc_mip_size(e.height, l - 1) > 1))
            e.flags |= SLUICE_TEXTURE_FLAG_UNEVEN;
    return e;
}

struct dispatch {
    struct scene *scene;
    uint32_t texture, count, flags;
};

static void record_dispatch(void *user, VkCommandBuffer commands)
{
    struct dispatch *d = user;
    prober_record(&d->scene->prober, commands, d->scene->textures[d->texture].probe, 0, d->count,
                  d->flags);
}

static void run(struct scene *scene, uint32_t texture, uint32_t count, uint32_t flags)
{
    struct dispatch d = {scene, texture, count, flags};
    harness_run(scene->h, record_dispatch, &d);
}

static void random_input(struct ProbeInput *in, const struct SluiceTextureEntry *e, bool extreme)
{
    double scale = exp2(draw() * (e->mipLevelCount + 2) - 2), angle = draw() * 6.283;
    double ratio = roll() % 2 ? 1 : 1 + draw() * 20, skew = roll() % 2 ? 1 : draw();
    *in = (struct ProbeInput){
        .uv = {(float)(draw() * 3 - 1), (float)(draw() * 3 - 1)},
        .dx = {(float)(cos(angle) * scale / e->width), (float)(sin(angle) * scale / e->height)},
        .dy = {(float)(-sin(angle * skew) * scale * ratio / e->width),
               (float)(cos(angle * skew) * scale * ratio / e->height)},
        .lodBias = roll() % 3 ? 0.0f : (float)(draw() * 4 - 2),
        .maxAnisotropy = roll() % 2 ? 1.0f : (float)(1 << roll() % 5)};
    if (roll() % 3 == 0) /* on the border of a region, or half a texel beside it */
        in->uv[0] = ((float)(roll() % (int)(e->regionCountX + 1)) * (float)e->regionWidth +
                     (float)(roll() % 3 - 1) * 0.5f) /
                    (float)e->width;
    if (!extreme)
        return;
    float *all[] = {&in->uv[0], &in->uv[1], &in->dx[0],   &in->dx[1],
                    &in->dy[0], &in->dy[1], &in->lodBias, &in->maxAnisotropy};
    for (int i = roll() % 3; i >= 0; i--)
        *all[roll() % 8] = extremes[(size_t)roll() % EXTREMES];
}

static struct slc_twin_wants twin_of(const struct SluiceTextureEntry *e,
                                     const struct ProbeInput *in, struct slc_twin_vec2 *lods)
{
    struct slc_twin_vec2 uv = {in->uv[0], in->uv[1]}, dx = {in->dx[0], in->dx[1]};
    struct slc_twin_vec2 dy = {in->dy[0], in->dy[1]};
    struct slc_twin_vec2 tx = {dx.x * (float)e->width, dx.y * (float)e->height};
    struct slc_twin_vec2 ty = {dy.x * (float)e->width, dy.y * (float)e->height};
    *lods = slc_twin_compute_lods(tx, ty, in->lodBias, in->maxAnisotropy);
    return slc_twin_wants(e, uv, dx, dy, in->lodBias, in->maxAnisotropy);
}

/* Returns whether rounding may decide: at the border of a level or region. */
static bool is_close_to_a_step(float x)
{
    return fabsf(x - roundf(x)) < 1e-3f;
}

static void check_finite_twin(const struct SluiceTextureEntry *e, const struct ProbeInput *in,
                              const struct ProbeOutput *out, uint32_t *compared)
{
    struct slc_twin_vec2 lods;
    struct slc_twin_wants wants = twin_of(e, in, &lods);
    assert_float_equal(out->lod, lods.x, 2e-3f);
    if (is_close_to_a_step(lods.y) ||
        is_close_to_a_step(lods.x - slc_twin_lod_margin(in->maxAnisotropy)))
        return;
    assert_int_equal(out->wantedLevel, wants.level);
    assert_int_equal(out->level, slc_twin_coarsest_level(lods.y, e->mipLevelCount));
    /* an index may differ by one if an end of the box is on a border */
    for (int i = 0; i < 2; i++) {
        *compared += out->footprint[i] == wants.regions.first[i];
        *compared += out->footprint[2 + i] == wants.regions.last[i];
    }
}

static void glsl_and_c_twins_agree(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .pDebug = &map_everything});
    const uint32_t sizes[][2] = {{1024, 1024}, {1000, 700}, {1, 3000}, {4096, 1}, {129, 65}};
    roll_seed(31);
    for (uint32_t i = 0; i < 5; i++)
        scene_add_as(
            &scene,
            pattern_source(PATTERN_LEVEL, sizes[i][0], sizes[i][1], SLUICE_FORMAT_R8G8B8A8_UNORM),
            i, 4 - i, 1, SLUICE_NO_TEXTURE);
    harness_frame(scene.h, scene.streamer, true, NULL, NULL);
    for (uint32_t t = 0; t < 5; t++) {
        struct SluiceTextureEntry e = entry_of(&scene, t);
        for (uint32_t i = 0; i < SAMPLES; i++)
            random_input(&prober_inputs(&scene.prober)[i], &e, false);
        run(&scene, t, SAMPLES, PROBE_TWINS);
        uint32_t compared = 0;
        for (uint32_t i = 0; i < SAMPLES; i++) {
            const struct ProbeInput *in = &prober_inputs(&scene.prober)[i];
            const struct ProbeOutput *out = &prober_outputs(&scene.prober)[i];
            check_finite_twin(&e, in, out, &compared);
            uint32_t bits;
            memcpy(&bits, &in->lodBias, sizeof bits);
            assert_int_equal(out->missingLevels, slc_twin_hash(i % 128, i / 128, bits));
            uint32_t selected =
                (slc_twin_select_random_quad(i % 128, i / 128, i / 7, in->maxAnisotropy) ? 1u : 0) |
                (slc_twin_select_lattice(i % 128, i / 128, i / 5) ? 2u : 0);
            assert_int_equal(out->nonResident, selected);
        }
        assert_true(compared > SAMPLES * 4 * 98 / 100);
    }
    scene_finish(&scene);
}

/* NaN, infinities and denormals: results are inside the map, finite, and a level of the chain. */
static void extremes_stay_inside_the_map(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .pDebug = &map_everything});
    roll_seed(32);
    for (uint32_t mode = 0; mode < 4; mode++)
        scene_add_as(&scene, pattern_source(PATTERN_LEVEL, 1000, 700, SLUICE_FORMAT_R8G8B8A8_UNORM),
                     mode, mode, 1, SLUICE_NO_TEXTURE);
    scene_settle(&scene, 8);
    for (uint32_t t = 0; t < 4; t++) {
        struct SluiceTextureEntry e = entry_of(&scene, t);
        for (uint32_t i = 0; i < SAMPLES; i++)
            random_input(&prober_inputs(&scene.prober)[i], &e, true);
        run(&scene, t, SAMPLES, PROBE_TWINS);
        for (uint32_t i = 0; i < SAMPLES; i++) {
            const struct ProbeOutput *out = &prober_outputs(&scene.prober)[i];
            assert_true(out->lod >= -32 && out->lod <= 32);
            assert_true(out->level < e.mipLevelCount && out->wantedLevel <= out->level);
            for (int k = 0; k < 4; k += 2) {
                assert_true(out->footprint[k] < e.regionCountX);
                assert_true(out->footprint[k + 1] < e.regionCountY);
            }
        }
        scene_clear_outputs(&scene);
        run(&scene, t, SAMPLES, PROBE_SAMPLE | PROBE_RESIDENCY | PROBE_FEEDBACK);
        assert_int_equal(scene_non_resident(&scene), 0);
        for (uint32_t i = 0; i < SAMPLES; i++) {
            const struct ProbeOutput *out = &prober_outputs(&scene.prober)[i];
            for (int c = 0; c < 4; c++)
                if (!(out->color[c] >= 0 && out->color[c] <= 1)) {
                    const struct ProbeInput *in = &prober_inputs(&scene.prober)[i];
                    fail_msg("color %g for uv %g %g dx %g %g dy %g %g bias %g anisotropy %g",
                             (double)out->color[c], (double)in->uv[0], (double)in->uv[1],
                             (double)in->dx[0], (double)in->dx[1], (double)in->dy[0],
                             (double)in->dy[1], (double)in->lodBias, (double)in->maxAnisotropy);
                }
        }
    }
    scene_finish(&scene);
}

/* Paints every region of a footprint: the shader may mark its corners, or any one of several
 * regions. */
static void paint(uint8_t *map, const struct SluiceTextureEntry *e,
                  const struct slc_twin_footprint *regions, uint32_t level)
{
    const uint32_t last[2] = {e->regionCountX - 1, e->regionCountY - 1};
    uint32_t at[2];
    for (at[1] = regions->first[1];;) {
        for (at[0] = regions->first[0];;) {
            uint8_t *word = &map[at[1] * e->regionCountX + at[0]];
            if (level < *word)
                *word = (uint8_t)level;
            if (at[0] == regions->last[0])
                break;
            at[0] = slc_twin_next_region(at[0], regions->last[0], last[0], 1);
        }
        if (at[1] == regions->last[1])
            break;
        at[1] = slc_twin_next_region(at[1], regions->last[1], last[1], 1);
    }
}

/* Returns a texel of one axis that a sample certainly reads; -1: border. */
static int64_t texel_of(double coordinate, uint32_t size, uint32_t mode)
{
    int64_t n = size, t = (int64_t)floor(coordinate * size);
    switch (mode) {
    case SLUICE_ADDRESS_MODE_REPEAT: return ((t % n) + n) % n;
    case SLUICE_ADDRESS_MODE_MIRRORED_REPEAT:
        t = ((t % (2 * n)) + 2 * n) % (2 * n);
        return t < n ? t : 2 * n - 1 - t;
    case SLUICE_ADDRESS_MODE_CLAMP_TO_BORDER: return t < 0 || t >= n ? -1 : t;
    default: return t < 0 ? 0 : t >= n ? n - 1 : t;
    }
}

/* Returns the tile of `level` over a region along one axis, as the manager finds it. */
static uint32_t tile_over(uint32_t region, uint32_t size, uint32_t tile, uint32_t level)
{
    for (uint32_t l = 1; l <= level; l++)
        region = slc_min_u32(region >> 1, slc_div_up_u32(slc_mip_size(size, l), tile) - 1);
    return region;
}

/* A mark of level m in a region requests the tiles over it at level m and all coarser levels. */
static bool is_asked_for(const struct ProbeOutput *marked, const struct SluiceTextureEntry *e,
                         uint32_t level, uint32_t tile_x, uint32_t tile_y)
{
    for (uint32_t y = 0; y < e->regionCountY; y++)
        for (uint32_t x = 0; x < e->regionCountX; x++)
            if (marked[y * e->regionCountX + x].level <= level &&
                tile_over(x, e->width, e->regionWidth, level) == tile_x &&
                tile_over(y, e->height, e->regionHeight, level) == tile_y)
                return true;
    return false;
}

/* Checks the middle texel at the level that an exact sampler begins with. */
static void check_required(const struct ProbeOutput *marked, const struct SluiceTextureEntry *e,
                           const struct ProbeInput *in)
{
    struct slc_twin_vec2 lods;
    twin_of(e, in, &lods);
    uint32_t level = (uint32_t)slc_twin_clamp(lods.x, 0, (float)(e->mipLevelCount - 1));
    if (level >= e->regularMipCount)
        return; /* packed levels are always wanted */
    int64_t x = texel_of(in->uv[0], slc_mip_size(e->width, level), e->addressModeU);
    int64_t y = texel_of(in->uv[1], slc_mip_size(e->height, level), e->addressModeV);
    if (x >= 0 && y >= 0 &&
        !is_asked_for(marked, e, level, (uint32_t)x / e->regionWidth,
                      (uint32_t)y / e->regionHeight))
        fail_msg("%ux%u, modes %u %u: uv %.9g %.9g does not ask for level %u", e->width, e->height,
                 e->addressModeU, e->addressModeV, (double)in->uv[0], (double)in->uv[1], level);
}

static void check_map(struct scene *scene, uint32_t t, uint32_t count)
{
    struct SluiceTextureEntry e = entry_of(scene, t);
    uint32_t regions = e.regionCountX * e.regionCountY;
    static uint8_t allowed[PROBE_CAPACITY];
    memset(allowed, SLUICE_MIP_UNTOUCHED, sizeof allowed);
    for (uint32_t i = 0; i < count; i++) {
        const struct ProbeInput *in = &prober_inputs(&scene->prober)[i];
        struct slc_twin_vec2 lods;
        struct slc_twin_wants wants = twin_of(&e, in, &lods);
        /* rounding may differ from the twin by one level or one texel */
        float margin = slc_twin_lod_margin(in->maxAnisotropy) + 2e-3f;
        wants.level = slc_twin_finest_level(lods.x, margin, e.mipLevelCount);
        float w = (float)e.width, h = (float)e.height;
        struct slc_twin_vec2 axis = slc_twin_half_box(
            (struct slc_twin_vec2){in->dx[0] * w, in->dx[1] * h},
            (struct slc_twin_vec2){in->dy[0] * w, in->dy[1] * h}, in->lodBias, in->maxAnisotropy);
        axis.x += 0.01f;
        axis.y += 0.01f;
        wants.regions =
            slc_twin_compute_footprint(&e, (struct slc_twin_vec2){in->uv[0], in->uv[1]}, axis,
                                       slc_twin_coarsest_level(lods.y + 2e-3f, e.mipLevelCount));
        paint(allowed, &e, &wants.regions, wants.level);
        wants = twin_of(&e, in, &lods);
        paint(allowed, &e, &wants.regions, slc_twin_finest_level(lods.x, margin, e.mipLevelCount));
        if (wants.wide_level != UINT32_MAX)
            paint(allowed, &e, &wants.wide_regions, wants.wide_level);
    }
    run(scene, t, count, PROBE_FEEDBACK);
    run(scene, t, regions, PROBE_WORDS);
    const struct ProbeOutput *marked = prober_outputs(&scene->prober);
    for (uint32_t i = 0; i < regions; i++)
        if (marked[i].level < allowed[i])
            fail_msg("%ux%u, modes %u %u, region %u of %u: marked %u, allowed %u", e.width,
                     e.height, e.addressModeU, e.addressModeV, i, regions, marked[i].level,
                     allowed[i]);
    for (uint32_t i = 0; i < count; i++)
        check_required(marked, &e, &prober_inputs(&scene->prober)[i]);
}

static void marked_is_between_required_and_allowed(void **state)
{
    const uint32_t sizes[][2] = {{1024, 1024}, {1000, 1500}, {2048, 1}, {1, 1000},
                                 {129, 257},   {16, 16},     {700, 300}};
    roll_seed(33);
    for (uint32_t round = 0; round < 12; round++) {
        struct scene scene;
        scene_init(
            &scene, *state,
            (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                             .texturesPerFrame = 32});
        for (uint32_t i = 0; i < 7; i++)
            scene_add_as(&scene,
                         pattern_source(PATTERN_LEVEL, sizes[i][0], sizes[i][1],
                                        SLUICE_FORMAT_R8G8B8A8_UNORM),
                         (uint32_t)roll() % 4, (uint32_t)roll() % 4, 1, SLUICE_NO_TEXTURE);
        harness_frame(scene.h, scene.streamer, true, NULL, NULL); /* clears the maps */
        for (uint32_t t = 0; t < 7; t++) {
            struct SluiceTextureEntry e = entry_of(&scene, t);
            uint32_t count = round < 8 ? 1 + round * round : SAMPLES / 8;
            for (uint32_t i = 0; i < count; i++)
                random_input(&prober_inputs(&scene.prober)[i], &e, false);
            check_map(&scene, t, count);
        }
        scene_finish(&scene);
    }
}

static void resolve_hands_over_and_clears_only_the_maps_of_its_turn(void **state)
{
    struct scene scene;
    scene_init(
        &scene, *state,
        (SluiceVulkanStreamerCreateInfo){.structSize = sizeof(SluiceVulkanStreamerCreateInfo),
                                         .texturesPerFrame = 1,
                                         .feedbackTimeoutTicks = 1000});
    for (uint32_t i = 0; i < 3; i++)
        scene_add(&scene, pattern_source(PATTERN_LEVEL, 512, 512, SLUICE_FORMAT_R8G8B8A8_UNORM));
    harness_frame(scene.h, scene.streamer, true, NULL, NULL); /* the turn of the first */
    prober_inputs(&scene.prober)[0] = (struct ProbeInput){
        .uv = {0.6f, 0.6f}, .dx = {1 / 512.0f, 0}, .dy = {0, 1 / 512.0f}, .maxAnisotropy = 1};
    for (uint32_t t = 0; t < 3; t++)
        run(&scene, t, 1, PROBE_FEEDBACK);
    for (uint32_t turn = 1; turn <= 3; turn++) {
        harness_frame(scene.h, scene.streamer, true, NULL, NULL);
        for (uint32_t t = 0; t < 3; t++) {
            run(&scene, t, 16, PROBE_WORDS);
            bool cleared = (t + 2) % 3 < turn;
            for (uint32_t i = 0; i < 16; i++)
                assert_int_equal(prober_outputs(&scene.prober)[i].level,
                                 i == 10 && !cleared ? 0 : SLUICE_MIP_UNTOUCHED);
        }
    }
    SluiceVulkanStreamerStatistics stats = {.structSize = sizeof stats};
    harness_frame(scene.h, scene.streamer, true, NULL, NULL);
    sluiceGetVulkanStreamerStatistics(scene.streamer, &stats);
    assert_int_equal(stats.feedbackMaps, 4);
    scene_settle(&scene, 6);
    /* levels 0 and 1 of the one region that each texture requests, and the packed levels */
    for (uint32_t t = 0; t < 3; t++) {
        uint8_t map[16];
        CHECK_OK(sluiceWriteMinMipData(manager_of(scene.streamer),
                                       scene.textures[t].texture.textureId, 4, 16, map));
        for (uint32_t i = 0; i < 16; i++)
            assert_true(i == 10 ? map[i] == 0 : map[i] > 0 && map[i] < SLUICE_MIP_UNTOUCHED);
    }
    scene_finish(&scene);
}

int main(void)
{
    struct harness h;
    int status = harness_init(&h);
    if (status)
        return status;
    struct CMUnitTest tests[] = {
        cmocka_unit_test(glsl_and_c_twins_agree),
        cmocka_unit_test(extremes_stay_inside_the_map),
        cmocka_unit_test(marked_is_between_required_and_allowed),
        cmocka_unit_test(resolve_hands_over_and_clears_only_the_maps_of_its_turn),
    };
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tests[i].initial_state = &h;
    return harness_finish(&h, RUN_TESTS(tests));
}
