#include "scene_played.h"

#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool tell_progress(void *user, double part)
{
    struct scene_data *scene = user;
    if (scene->progress)
        atomic_store(&scene->progress->percent, 1 + (unsigned)(100.0 * part));
    return !scene_data_canceled(scene);
}

bool scene_played_open(const char *path, struct scene_data *scene)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash && slash[1] ? slash + 1 : path;
    scene->played = played_open(path, tell_progress, scene);
    if (!scene->played)
        return false;
    scene->name = malloc(strlen(name) + 1);
    if (!scene->name) {
        text_say("sluice-view: out of memory");
        return false;
    }
    strcpy(scene->name, name);
    if (scene->played->message[0])
        scene_data_keep_note(scene, scene->played->message);
    return true;
}

struct stage_texture *scene_played_textures(const struct played *p)
{
    struct stage_texture *textures = calloc(p->texture_count + 1u, sizeof *textures);
    for (uint32_t i = 0; textures && i < p->texture_count; i++) {
        const struct played_texture *t = &p->textures[i];
        textures[i] = (struct stage_texture){.id = t->id,
                                             .name = t->name,
                                             .path = "",
                                             .width = t->desc.width,
                                             .height = t->desc.height,
                                             .level_count = t->desc.mipLevelCount,
                                             .primary = t->primary,
                                             .format = "",
                                             .size = (uint64_t)t->tile_count * p->begin.tileSize};
    }
    return textures;
}
