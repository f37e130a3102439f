#include "scene_open.h"

#include "scene_import.h"
#include "scene_pictures.h"

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

bool scene_open(const char *const *paths, uint32_t count, const char *cache, bool wait,
                struct scene_data *scene)
{
    *scene = (struct scene_data){0};
    if (count == 0)
        return scene_data_make_room(scene);
    if (!scene_open_takes(paths, count))
        return false;
    return scene_pictures_takes(paths[0]) ? scene_pictures(paths, count, cache, wait, scene)
                                          : scene_import(paths[0], cache, wait, scene);
}
