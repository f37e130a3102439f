/** Pictures and folders of pictures as a scene. */
#ifndef SLUICE_VIEW_SCENE_PICTURES_H
#define SLUICE_VIEW_SCENE_PICTURES_H

#include "scene_data.h"

/** Whether a path is a folder, or a file whose name is that of a picture. */
bool scene_pictures_takes(const char *path);
/** Fills a zeroed scene; hangs pictures, and those of folders and the folders below, in the
 * gallery's room. A picture that cannot be shown is named and shown by a checkerboard. False, with
 * lines on stderr, if none can be shown. `cache` and `wait` are those of scene_import. */
bool scene_pictures(const char *const *paths, uint32_t count, const char *cache, bool wait,
                    struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_PICTURES_H */
