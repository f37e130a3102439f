#include "scene_pbrt.h"

#include "traced_parts.h"

#include "../../samples/streaming/cache.h"
#include "../common/files.h"
#include "../common/text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CLUSTER_SIZE 1024u /* same value as in demand-pbrt */

bool scene_pbrt_takes(const char *path)
{
    return files_has_suffix(path, ".pbrt|.pbrt.gz");
}

static const char *end_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash && slash[1] ? slash + 1 : path;
}

static void add_picture(struct scene_pbrt *p, const char *path)
{
    for (uint32_t i = 0; path && i < p->picture_count; i++)
        if (strcmp(p->pictures[i].path, path) == 0)
            return;
    if (path)
        p->pictures[p->picture_count++] = (struct scene_pbrt_picture){path, end_of(path)};
}

static uint32_t find_picture(const struct scene_pbrt *p, const char *path)
{
    for (uint32_t i = 0; path && i < p->picture_count; i++)
        if (strcmp(p->pictures[i].path, path) == 0)
            return i;
    return UINT32_MAX;
}

/* Textures follow their inputs. Many ways may lead to an input, so each texture is visited once. */
static bool find_texture_pictures(struct scene_pbrt *p)
{
    const uint32_t count = p->scene.info.textureCount;
    p->texture_pictures = malloc((count + 1u) * sizeof *p->texture_pictures);
    for (uint32_t i = 0; p->texture_pictures && i < count; i++) {
        const SluicePbrtTexture texture = scene_texture(&p->scene, i);
        uint32_t found = find_picture(p, texture.pImagePath);
        for (int k = 0; k < 2 && found == UINT32_MAX; k++)
            if (texture.inputs[k].texture < i)
                found = p->texture_pictures[texture.inputs[k].texture];
        p->texture_pictures[i] = found;
    }
    return p->texture_pictures;
}

static bool list_pictures(struct scene_pbrt *p)
{
    const SluicePbrtSceneInfo *info = &p->scene.info;
    p->pictures = calloc(info->textureCount + info->lightCount + 1u, sizeof *p->pictures);
    for (uint32_t i = 0; p->pictures && i < info->textureCount; i++)
        add_picture(p, scene_texture(&p->scene, i).pImagePath);
    for (uint32_t i = 0; p->pictures && i < info->lightCount; i++)
        add_picture(p, scene_light(&p->scene, i).pImagePath);
    if (p->pictures && find_texture_pictures(p))
        return true;
    text_say("sluice-view: out of memory");
    return false;
}

/* Returns the vertical field of view, in radians. The scene has the field of view of the shorter
 * side. The viewer uses the vertical one for lines only. */
static float vertical_fov(const SluicePbrtSceneInfo *info)
{
    const float fov = info->fieldOfView * 3.14159265f / 180.0f;
    return info->cameraKind == SLUICE_PBRT_CAMERA_PERSPECTIVE && fov > 0.02f && fov < 3.0f ? fov
                                                                                           : 0.9f;
}

static void describe(struct scene_data *scene, const struct scene_pbrt *p)
{
    const SluicePbrtBounds *box = &p->scene.box;
    if (scene_box_is_empty(box)) {
        scene->camera = p->frame.camera;
        return;
    }
    const struct vec3 a = pbrt_frame_position(&p->frame, box->least);
    const struct vec3 b = pbrt_frame_position(&p->frame, box->most);
    scene->bounds[0] = (struct vec3){fminf(a.x, b.x), fminf(a.y, b.y), fminf(a.z, b.z)};
    scene->bounds[1] = (struct vec3){fmaxf(a.x, b.x), fmaxf(a.y, b.y), fmaxf(a.z, b.z)};
    scene->camera = p->frame.camera;
}

static bool open_text(const char *path, struct scene_data *scene, struct scene_pbrt *p)
{
    struct scene_progress *progress = scene->progress;
    const struct scene_watch watch = {progress ? &progress->canceled : NULL,
                                      progress ? &progress->read_size : NULL};
    const bool opened = scene_open(path, NULL, progress ? &watch : NULL, &p->scene) &&
                        scene_cluster(&p->scene, CLUSTER_SIZE);
    p->scene.watch = NULL;
    return opened && !scene_data_canceled(scene);
}

bool scene_pbrt_open(const char *path, const char *cache, struct scene_data *scene)
{
    struct scene_pbrt *p = calloc(1, sizeof *p);
    const char *name = end_of(path);
    scene->pbrt = p;
    scene->name = malloc(strlen(name) + 1);
    if (!p || !scene->name) {
        text_say("sluice-view: out of memory");
        return false;
    }
    strcpy(scene->name, name);
    if (!cache_path(cache, "pictures", p->cache, sizeof p->cache) ||
        !files_make_folders(p->cache) || !open_text(path, scene, p) || !list_pictures(p))
        return false;
    pbrt_frame_init(p->scene.info.cameraToWorld, &p->scene.box, vertical_fov(&p->scene.info),
                    &p->frame);
    describe(scene, p);
    return true;
}

bool scene_pbrt_share(struct scene_pbrt *p, const struct scene_data *from, struct scene_data *scene)
{
    scene->name = malloc(strlen(from->name) + 1);
    if (!scene->name)
        return false;
    strcpy(scene->name, from->name);
    memcpy(scene->bounds, from->bounds, sizeof scene->bounds);
    scene->camera = from->camera;
    scene->pbrt = p;
    p->share_count++;
    return true;
}

void scene_pbrt_close(struct scene_pbrt *p)
{
    if (!p || p->share_count-- > 0)
        return;
    traced_parts_destroy(p->parts);
    free(p->pictures);
    free(p->texture_pictures);
    scene_finish(&p->scene);
    free(p);
}

uint32_t scene_pbrt_picture_of(const struct scene_pbrt *p, const SluicePbrtValue *value)
{
    return value->texture < p->scene.info.textureCount ? p->texture_pictures[value->texture]
                                                       : UINT32_MAX;
}
