#include "scene_open.h"

#include "scene_import.h"
#include "scene_pbrt.h"
#include "scene_played.h"
#include "scene_pictures.h"
#include "traced_parts.h"
#include "traced_rehearsal.h"

#include "../common/text.h"

bool scene_open_takes(const char *const *paths, uint32_t count)
{
    for (uint32_t i = 0; count > 1 && i < count; i++)
        if (!scene_pictures_takes(paths[i])) {
            text_say("sluice-view: %s is no picture and no folder: one scene at a time", paths[i]);
            return false;
        }
    return true;
}

static bool prepare_device(const struct scene_request *r, struct scene_data *scene)
{
    if (!r->gpu)
        return true;
    traced_rehearse(r->gpu, scene);
    if (!scene_data_canceled(scene))
        scene->pbrt->parts = traced_parts_create(r->gpu, r->threads);
    return scene->pbrt->parts;
}

static bool open_any(const struct scene_request *r, struct scene_data *scene)
{
    if (r->path_count == 0)
        return scene_data_make_room(scene);
    if (!scene_open_takes(r->paths, r->path_count))
        return false;
    if (played_takes(r->paths[0]))
        return scene_played_open(r->paths[0], scene);
    if (scene_pbrt_takes(r->paths[0]))
        return scene_pbrt_open(r->paths[0], r->cache, scene) && prepare_device(r, scene);
    if (scene_pictures_takes(r->paths[0]))
        return scene_pictures(r->paths, r->path_count, r->cache, r->wait, scene);
    return scene_import(r->paths[0], r->cache, r->wait, scene);
}

bool scene_open_paths(const struct scene_request *request, struct scene_data *scene)
{
    *scene = (struct scene_data){.progress = request->progress};
    const bool opened = open_any(request, scene) && !scene_data_canceled(scene);
    scene->progress = NULL;
    if (!opened)
        scene_data_finish(scene);
    return opened;
}
