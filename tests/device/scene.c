#include "device/scene.h"

#include "base/checked.h"
#include "support/roll.h"
#include "support/test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void scene_init(struct scene *scene, struct harness *h, SluiceVulkanStreamerCreateInfo info)
{
    *scene = (struct scene){.h = h};
    harness_fill(h, &info);
    CHECK_OK(sluiceCreateVulkanStreamer(&info, &scene->streamer));
    prober_init(&scene->prober, h, scene->streamer);
    scene_clear_outputs(scene);
}

void scene_finish(struct scene *scene)
{
    assert_int_equal(scene->h->DeviceWaitIdle(scene->h->device), VK_SUCCESS);
    prober_finish(&scene->prober);
    harness_destroy(scene->h, scene->streamer);
    for (uint32_t i = 0; i < SCENE_TEXTURES; i++)
        if (scene->textures[i].owns)
            sluiceDestroyImageSource(scene->textures[i].source);
    harness_check_silence(scene->h);
}

static uint32_t find_place(struct scene *scene)
{
    uint32_t index = 0;
    while (scene->textures[index].used)
        index++;
    assert_true(index < SCENE_TEXTURES);
    struct scene_texture *texture = &scene->textures[index];
    if (texture->owns) /* a removed texture's source */
        CHECK_OK(sluiceWaitVulkanStreamerIdle(scene->streamer));
    if (texture->owns)
        sluiceDestroyImageSource(texture->source);
    return index;
}

uint32_t scene_add_produced(struct scene *scene, const SluiceTileProducer *producer)
{
    uint32_t index = find_place(scene);
    const VkSamplerAddressMode repeat = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    struct scene_texture *texture = &scene->textures[index];
    *texture = (struct scene_texture){
        .used = true, .info = *producer->pImage, .u = repeat, .v = repeat, .anisotropy = 1};
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info, .pProducer = producer};
    CHECK_OK(sluiceAddVulkanTexture(scene->streamer, &info, &texture->texture));
    texture->info.mipLevelCount = texture->texture.mipLevelCount;
    texture->probe = prober_texture(&scene->prober, &texture->texture, repeat, repeat, 1);
    return index;
}

uint32_t scene_add_as(struct scene *scene, SluiceImageSource *source, VkSamplerAddressMode u,
                      VkSamplerAddressMode v, float anisotropy, SluiceTextureId primary)
{
    uint32_t index = find_place(scene);
    struct scene_texture *texture = &scene->textures[index];
    *texture = (struct scene_texture){
        .used = true, .source = source, .owns = true, .u = u, .v = v, .anisotropy = anisotropy};
    texture->info.structSize = sizeof texture->info;
    CHECK_OK(sluiceGetImageInfo(source, &texture->info));
    SluiceVulkanTextureCreateInfo info = {.structSize = sizeof info,
                                          .source = source,
                                          .primaryId = primary,
                                          .addressModeU = u,
                                          .addressModeV = v,
                                          .filter = scene->filter,
                                          .residencyMode = scene->texture_mode};
    CHECK_OK(sluiceAddVulkanTexture(scene->streamer, &info, &texture->texture));
    texture->probe = prober_texture(&scene->prober, &texture->texture, u, v, anisotropy);
    return index;
}

uint32_t scene_add(struct scene *scene, SluiceImageSource *source)
{
    return scene_add_as(scene, source, VK_SAMPLER_ADDRESS_MODE_REPEAT,
                        VK_SAMPLER_ADDRESS_MODE_REPEAT, 1.0f, SLUICE_NO_TEXTURE);
}

void scene_remove(struct scene *scene, uint32_t index)
{
    struct scene_texture *texture = &scene->textures[index];
    CHECK_OK(sluiceRemoveVulkanTexture(scene->streamer, texture->texture.textureId));
    texture->used = false;
    texture->sample_count = 0;
    prober_release(&scene->prober, texture->probe);
}

struct ProbeInput *scene_inputs(struct scene *scene, uint32_t texture)
{
    return prober_inputs(&scene->prober) + texture * SCENE_SAMPLES;
}

const struct ProbeOutput *scene_outputs(const struct scene *scene, uint32_t texture)
{
    return prober_outputs(&scene->prober) + texture * SCENE_SAMPLES;
}

static double draw(void)
{
    return (double)roll() / ROLL_MAX;
}

void scene_aim(struct scene *scene, uint32_t index, uint32_t count, const struct scene_aim *aim)
{
    struct scene_texture *texture = &scene->textures[index];
    struct ProbeInput *inputs = scene_inputs(scene, index);
    double w = texture->info.width, h = texture->info.height;
    assert_true(count <= SCENE_SAMPLES);
    texture->sample_count = count;
    for (uint32_t i = 0; i < count; i++) {
        double scale = exp2(aim->min_lod + draw() * (aim->max_lod - aim->min_lod));
        double ratio = aim->max_ratio > 0 ? 1 + draw() * (aim->max_ratio - 1) : 1;
        double angle = aim->max_ratio > 0 ? draw() * 6.2831853 : 0;
        double skew = aim->max_ratio > 0 && roll() % 2 ? angle + draw() * 6.2831853 : angle;
        inputs[i] = (struct ProbeInput){
            .uv = {(float)(aim->left + draw() * aim->width),
                   (float)(aim->top + draw() * aim->height)},
            .dx = {(float)(cos(angle) * scale * ratio / w),
                   (float)(sin(angle) * scale * ratio / h)},
            .dy = {(float)(-sin(skew) * scale / w), (float)(cos(skew) * scale / h)},
            .lodBias = aim->bias,
            .maxAnisotropy = texture->anisotropy};
    }
}

void scene_record(void *user, VkCommandBuffer commands)
{
    struct scene *scene = user;
    for (uint32_t i = 0; i < SCENE_TEXTURES; i++) {
        const struct scene_texture *texture = &scene->textures[i];
        uint32_t flags = PROBE_SAMPLE | PROBE_RESIDENCY;
        if (!texture->no_feedback)
            flags |= PROBE_FEEDBACK;
        if (texture->used && texture->sample_count)
            prober_record(&scene->prober, commands, texture->probe, i * SCENE_SAMPLES,
                          texture->sample_count, flags);
    }
}

void scene_settle(struct scene *scene, uint32_t frame_count)
{
    harness_settle(scene->h, scene->streamer, frame_count, scene_record, scene);
}

void scene_clear_outputs(struct scene *scene)
{
    assert_int_equal(scene->h->DeviceWaitIdle(scene->h->device), VK_SUCCESS);
    memset(scene->prober.outputs.mapped, 0, PROBE_CAPACITY * sizeof(struct ProbeOutput));
}

uint64_t scene_non_resident(struct scene *scene)
{
    assert_int_equal(scene->h->DeviceWaitIdle(scene->h->device), VK_SUCCESS);
    uint64_t count = 0;
    for (uint32_t i = 0; i < PROBE_CAPACITY; i++) {
        const struct ProbeOutput *out = &prober_outputs(&scene->prober)[i];
        const struct ProbeInput *in = &prober_inputs(&scene->prober)[i];
        const struct scene_texture *texture = &scene->textures[i / SCENE_SAMPLES];
        if (out->nonResident && count == 0)
            fprintf(stderr,
                    "# not resident, texture %u (%ux%u, modes %d %d): uv %.9g %.9g, dx %.9g %.9g, "
                    "dy %.9g %.9g, bias %g, anisotropy %g; now lod %g, level %u of %u\n",
                    i / SCENE_SAMPLES, texture->info.width, texture->info.height, (int)texture->u,
                    (int)texture->v, (double)in->uv[0], (double)in->uv[1], (double)in->dx[0],
                    (double)in->dx[1], (double)in->dy[0], (double)in->dy[1], (double)in->lodBias,
                    (double)in->maxAnisotropy, (double)out->lod, out->level, out->wantedLevel);
        count += out->nonResident;
    }
    return count;
}

double scene_ellipse_lod(const struct ProbeOutput *out, const struct scene_texture *texture)
{
    float d[4];
    memcpy(d, out->footprint, sizeof d);
    double w = texture->info.width, h = texture->info.height;
    double ax = (double)d[0] * w, ay = (double)d[1] * h, bx = (double)d[2] * w,
           by = (double)d[3] * h;
    double sum = ax * ax + ay * ay + bx * bx + by * by, det = fabs(ax * by - ay * bx);
    double major2 = 0.5 * (sum + sqrt(fmax(sum * sum - 4 * det * det, 0)));
    double n = texture->anisotropy;
    double lod = n > 1 ? log2(fmax(det / sqrt(major2), sqrt(major2) / n))
                       : 0.5 * log2(fmax(ax * ax + ay * ay, bx * bx + by * by));
    return out->minLod > 0 ? fmax(lod, (double)out->minLod) : lod;
}

void scene_check_levels(const struct scene *scene)
{
    for (uint32_t t = 0; t < SCENE_TEXTURES; t++)
        for (uint32_t i = 0; i < scene->textures[t].sample_count; i++) {
            const struct ProbeOutput *out = &scene_outputs(scene, t)[i];
            const struct ProbeInput *inputs = scene->prober.inputs.mapped;
            const struct ProbeInput *in = &inputs[t * SCENE_SAMPLES + i];
            if (out->level == SLUICE_MIP_UNTOUCHED ||
                (pattern_level(out->color) >= (float)out->level - PATTERN_LEVEL_ERROR &&
                 (out->level == 0 || scene_ellipse_lod(out, &scene->textures[t]) >= out->level)))
                continue;
            fail_msg("texture %u (%ux%u, modes %d %d): shows level %g (ellipse %g), allowed %u, "
                     "wanted %u, lod "
                     "%g; uv %.9g %.9g, dx %.9g %.9g, dy %.9g %.9g, bias %g, anisotropy %g",
                     t, scene->textures[t].info.width, scene->textures[t].info.height,
                     (int)scene->textures[t].u, (int)scene->textures[t].v,
                     (double)pattern_level(out->color), scene_ellipse_lod(out, &scene->textures[t]),
                     out->level, out->wantedLevel, (double)out->lod, (double)in->uv[0],
                     (double)in->uv[1], (double)in->dx[0], (double)in->dx[1], (double)in->dy[0],
                     (double)in->dy[1], (double)in->lodBias, (double)in->maxAnisotropy);
        }
}

uint32_t scene_missing(const struct scene *scene)
{
    uint32_t count = 0;
    for (uint32_t t = 0; t < SCENE_TEXTURES; t++)
        for (uint32_t i = 0; i < scene->textures[t].sample_count; i++)
            count += scene_outputs(scene, t)[i].missingLevels != 0;
    return count;
}
