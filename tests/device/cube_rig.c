#include "device/cube_rig.h"

#include "device/conform.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include "cube_array_comp.h"
#include "cube_comp.h"
#include "cube_hlsl.h"
#include "cube_number_comp.h"

#include <math.h>

static uint32_t layer_numbers[CUBE_RIG_LAYERS] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};

void cube_rig_texel(uint32_t cube, uint32_t face, uint32_t level, uint32_t x, uint32_t y,
                    float rgba[4])
{
    pattern_texel(PATTERN_HASH, level, x + 65536 * (cube * CUBE_ORACLE_FACES + face), y, rgba);
    rgba[0] = (float)(level + 1) / 16;
}

static void write_texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                        uint32_t height, float rgba[4])
{
    uint32_t layer = *(uint32_t *)user;
    (void)width, (void)height;
    cube_rig_texel(layer / CUBE_ORACLE_FACES, layer % CUBE_ORACLE_FACES, level, x, y, rgba);
}

static VkShaderModule create_module(struct harness *h, enum cube_form form)
{
    if (form == CUBE_FORM_HLSL)
        return conform_module(h, cube_hlsl, sizeof cube_hlsl);
    if (form == CUBE_FORM_ARRAY)
        return conform_module(h, cube_array_comp, sizeof cube_array_comp);
    return form == CUBE_FORM_NUMBER ? conform_module(h, cube_number_comp, sizeof cube_number_comp)
                                    : conform_module(h, cube_comp, sizeof cube_comp);
}

static VkPipeline create_pipeline(const struct prober *p, enum cube_form form)
{
    struct harness *h = p->h;
    struct prober_specialization specialization;
    return conform_compute_pipeline(h, p->layout, create_module(h, form),
                                    prober_specialize(p, &specialization));
}

/* Chooses the pipeline of a form. The harness owns it, as it does those of probers. */
void cube_rig_use(struct cube_rig *rig, enum cube_form form)
{
    const struct prober *p = &rig->scene.prober;
    uint32_t kind = HARNESS_PROBE_KINDS - 1 - 2 * (uint32_t)form - (p->paged ? 1 : 0);
    VkPipeline *pipeline = &p->h->probe_pipelines[kind];
    if (!*pipeline)
        *pipeline = create_pipeline(p, form);
    rig->pipeline = *pipeline;
}

static void create_sources(struct cube_rig *rig)
{
    for (uint32_t i = 0; i < CUBE_RIG_LAYERS; i++) {
        SluiceProceduralImage image = {&layer_numbers[i], write_texel};
        SluiceImageInfo info = {.structSize = sizeof info,
                                .width = rig->size,
                                .height = rig->size,
                                .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                .pName = "face"};
        CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &rig->layers[i]));
    }
    CHECK_OK(sluiceCreateArrayImageSource(rig->layers, CUBE_RIG_LAYERS, NULL, &rig->source));
}

bool cube_rig_init(struct cube_rig *rig, struct harness *h, SluiceVulkanStreamerCreateInfo info,
                   uint32_t size, float anisotropy)
{
    *rig = (struct cube_rig){.size = size,
                             .level_count = slc_mip_count(size),
                             .anisotropy = anisotropy,
                             .pipeline = VK_NULL_HANDLE};
    scene_init(&rig->scene, h, info);
    create_sources(rig);
    SluiceVulkanTextureCreateInfo create = {
        .structSize = sizeof create, .source = rig->source, .cube = true};
    bool refused = h->mode == SLUICE_RESIDENCY_MODE_SPARSE && !h->caps.sparseCubes;
    h->quiet = refused;
    CHECK_RESULT(
        sluiceAddVulkanTextureArray(rig->scene.streamer, &create, CUBE_RIG_LAYERS, rig->textures),
        refused ? SLUICE_ERROR_UNSUPPORTED : SLUICE_SUCCESS);
    h->quiet = false;
    if (refused)
        return false;
    for (uint32_t i = 0; i < CUBE_RIG_CUBES; i++)
        rig->sets[i] =
            prober_cube(&rig->scene.prober, &rig->textures[i * CUBE_ORACLE_FACES], anisotropy);
    cube_rig_use(rig, CUBE_FORM_CUBE);
    return true;
}

void cube_rig_finish(struct cube_rig *rig)
{
    scene_finish(&rig->scene);
    sluiceDestroyImageSource(rig->source);
    for (uint32_t i = 0; i < CUBE_RIG_LAYERS; i++)
        sluiceDestroyImageSource(rig->layers[i]);
}

struct CubeInput *cube_rig_inputs(struct cube_rig *rig)
{
    return (struct CubeInput *)prober_inputs(&rig->scene.prober);
}

const struct ProbeOutput *cube_rig_outputs(const struct cube_rig *rig)
{
    return prober_outputs(&rig->scene.prober);
}

void cube_rig_record(void *user, VkCommandBuffer commands)
{
    struct cube_rig *rig = user;
    VkPipeline own = rig->scene.prober.pipeline;
    rig->scene.prober.pipeline = rig->pipeline;
    prober_record(&rig->scene.prober, commands, rig->sets[rig->cube], rig->first, rig->count,
                  rig->flags | rig->cube << CUBE_INDEX_SHIFT);
    rig->scene.prober.pipeline = own;
}

void cube_rig_settle(struct cube_rig *rig, uint32_t frame_count, uint32_t cube, uint32_t count,
                     uint32_t flags)
{
    rig->cube = cube;
    rig->first = 0;
    rig->count = count;
    rig->flags = flags;
    harness_settle(rig->scene.h, rig->scene.streamer, frame_count, cube_rig_record, rig);
    assert_int_equal(rig->scene.h->DeviceWaitIdle(rig->scene.h->device), VK_SUCCESS);
}

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

struct CubeInput cube_rig_input_with(const struct cube_rig *rig, uint32_t face, double u, double v,
                                     const double dx[2], const double dy[2])
{
    struct CubeInput input = {.maxAnisotropy = rig->anisotropy};
    double at[3], x[3], y[3], length = exp2(draw() * 4 - 2);
    double longer_x = draw() - 0.5, longer_y = draw() - 0.5;
    cube_oracle_direction(face, u, v, at);
    cube_oracle_derivative(face, dx[0] / rig->size, dx[1] / rig->size, x);
    cube_oracle_derivative(face, dy[0] / rig->size, dy[1] / rig->size, y);
    for (int i = 0; i < 3; i++) {
        input.direction[i] = (float)(at[i] * length);
        input.dx[i] = (float)(x[i] * length + at[i] * longer_x);
        input.dy[i] = (float)(y[i] * length + at[i] * longer_y);
    }
    return input;
}

struct CubeInput cube_rig_input(const struct cube_rig *rig, uint32_t face, double u, double v,
                                double texels)
{
    const double dx[2] = {texels, 0}, dy[2] = {0, texels};
    return cube_rig_input_with(rig, face, u, v, dx, dy);
}

static void add_level(const struct cube_rig *rig, uint32_t cube, const struct CubeInput *input,
                      uint32_t level, double weight, double rgba[4])
{
    const double direction[3] = {(double)input->direction[0], (double)input->direction[1],
                                 (double)input->direction[2]};
    struct cube_taps taps = cube_oracle_bilinear(slc_mip_size(rig->size, level), direction);
    for (uint32_t i = 0; i < taps.count; i++) {
        float texel[4];
        cube_rig_texel(cube, taps.texels[i].face, level, taps.texels[i].x, taps.texels[i].y, texel);
        for (uint32_t c = 0; c < 4; c++)
            rgba[c] += weight * taps.weights[i] * round((double)texel[c] * 255) / 255;
    }
}

void cube_rig_expect(const struct cube_rig *rig, uint32_t cube, const struct CubeInput *input,
                     double lod, double rgba[4])
{
    lod = fmin(fmax(lod, 0), rig->level_count - 1);
    uint32_t level = (uint32_t)lod;
    for (uint32_t c = 0; c < 4; c++)
        rgba[c] = 0;
    add_level(rig, cube, input, level, 1 - (lod - level), rgba);
    if (lod > level)
        add_level(rig, cube, input, level + 1, lod - level, rgba);
}
