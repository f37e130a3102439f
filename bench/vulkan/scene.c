#include "scene.h"

#include <string.h>

#include "bench_scene_comp.h"
#include "bench_scene_frag.h"
#include "bench_scene_paged_comp.h"
#include "bench_scene_paged_frag.h"

static struct rig_info rig_info(const struct bench *bench, float anisotropy)
{
    uint32_t regions = bench->texture_size / 128 * (bench->texture_size / 128) + 1;
    return (struct rig_info){.bench = bench,
                             .streamer = {.maxTextureCount = 1,
                                          .texturesPerFrame = 1,
                                          .tilesPerFrame = 2048,
                                          .maxLoadsInFlight = 4096,
                                          .feedbackTimeoutTicks = UINT64_MAX / 4},
                             .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                             .texture_size = bench->texture_size,
                             .texture_count = 1,
                             .output_words = regions,
                             .picture_words = bench->size[0] * bench->size[1],
                             .anisotropy = anisotropy};
}

static bool load_everything(struct rig *rig)
{
    struct rig_wants wants = {.pipeline = rig_wants_pipeline(rig),
                              .params = {.kind = BENCH_WANTS_PATCH}};
    return wants.pipeline && rig_load(rig, &wants);
}

bool scene_create(struct scene *scene, const struct bench *bench, float anisotropy, bool everything)
{
    *scene = (struct scene){.rig.bench = bench, .plain.bench = bench};
    struct rig_info info = rig_info(bench, anisotropy);
    struct rig_info plain = info;
    plain.streamer.residencyMode = SLUICE_RESIDENCY_MODE_DENSE;
    plain.picture_words = 1;
    if (everything) {
        if (!rig_create(&scene->plain, &plain) || !load_everything(&scene->plain))
            return false;
        info.plain_view = scene->plain.textures[0].imageView;
    } else {
        info.streamer.tilesPerFrame = 8192; /* all at once */
        info.streamer.maxLoadsInFlight = 16384;
    }
    scene->has_target =
        target_create(&bench->gpu, bench->size[0], bench->size[1], 1, &scene->target);
    return scene->has_target && rig_create(&scene->rig, &info) &&
           (!everything || load_everything(&scene->rig));
}

void scene_destroy(struct scene *scene)
{
    rig_destroy(&scene->rig);
    target_destroy(&scene->rig.bench->gpu, &scene->target);
    rig_destroy(&scene->plain);
}

VkPipeline scene_pipeline(struct scene *scene, const struct scene_constants *constants)
{
    SluiceResidencyMode mode = SLUICE_RESIDENCY_MODE_AUTO;
    sluiceGetVulkanResidencyMode(scene->rig.streamer, &mode);
    bool paged = mode == SLUICE_RESIDENCY_MODE_PAGED;
    struct rig_constants values = {{
        [BENCH_CONSTANT_STREAMED] = constants->streamed,
        [BENCH_CONSTANT_SCENE] = constants->scene,
        [BENCH_CONSTANT_FEEDBACK] = constants->feedback,
        [BENCH_CONSTANT_COUNTING] = constants->counting,
    }};
    memcpy(&values.values[BENCH_CONSTANT_ANISOTROPY], &constants->anisotropy, 4);
    struct rig *rig = &scene->rig;
    VkRenderPass pass = scene->target.pass;
    if (constants->fragment && paged)
        return rig_screen_pipeline(rig, bench_scene_paged_frag, sizeof bench_scene_paged_frag,
                                   &values, pass);
    if (constants->fragment)
        return rig_screen_pipeline(rig, bench_scene_frag, sizeof bench_scene_frag, &values, pass);
    if (paged)
        return rig_compute_pipeline(rig, bench_scene_paged_comp, sizeof bench_scene_paged_comp,
                                    &values);
    return rig_compute_pipeline(rig, bench_scene_comp, sizeof bench_scene_comp, &values);
}

struct BenchParams scene_params(const struct scene *scene)
{
    float size = (float)scene->rig.bench->texture_size;
    return (struct BenchParams){.width = scene->rig.bench->size[0],
                                .height = scene->rig.bench->size[1],
                                .textureSize = {size, size},
                                .tableIndex = scene->rig.textures[0].tableIndex};
}

static void draw(struct rig *rig, VkCommandBuffer commands, const struct scene_draw *d,
                 VkPipeline pipeline)
{
    static const float black[4] = {0, 0, 0, 0};
    struct BenchParams params = d->params;
    params.seed = (uint32_t)rig->frame;
    if (d->fragment) {
        target_begin(&d->scene->target, commands, black);
        rig_bind(rig, commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline, &params);
        vkCmdDraw(commands, 3, 1, 0, 0);
        target_end(&d->scene->target, commands);
    } else {
        rig_bind(rig, commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline, &params);
        vkCmdDispatch(commands, (params.width + 7) / 8, (params.height + 7) / 8, 1);
    }
}

void scene_record(struct rig *rig, VkCommandBuffer commands, void *user)
{
    const struct scene_draw *d = user;
    draw(rig, commands, d, d->pipeline);
}

void scene_record_warm_up(struct rig *rig, VkCommandBuffer commands, void *user)
{
    const struct scene_draw *d = user;
    draw(rig, commands, d, d->warm_up);
}
