/** Makes a scene of pictures and folders of pictures. */
#ifndef SLUICE_VIEW_SCENE_PICTURES_H
#define SLUICE_VIEW_SCENE_PICTURES_H

#include "scene_data.h"

/** Returns true if a path is a folder, or has the name of a picture file. */
bool scene_pictures_takes(const char *path);
/** Fills a zeroed scene: hangs pictures, also from folders and subfolders, in the room. Reports a
 *  picture that cannot be shown, and hangs a checkerboard instead. False, with lines on stderr, if
 *  no picture can be shown. `cache`, `wait`: as in scene_import. */
bool scene_pictures(const char *const *paths, uint32_t count, const char *cache, bool wait,
                    struct scene_data *scene);

#endif /* SLUICE_VIEW_SCENE_PICTURES_H */
