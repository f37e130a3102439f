/** Scenes of all kinds. */
#ifndef SLUICE_VIEW_SCENE_OPEN_H
#define SLUICE_VIEW_SCENE_OPEN_H

#include "scene_data.h"

/** Opens pictures and folders of pictures, or one file of a scene; without a path, a room of
 * computed pictures. `cache`: folder for baked pictures. `wait`: until all pictures are baked. Says
 * on stderr what is wrong, and which images cannot be shown. */
bool scene_open(const char *const *paths, uint32_t count, const char *cache, bool wait,
                struct scene_data *scene);
/** False, with a line on stderr, for paths that are no scene together. */
bool scene_open_takes(const char *const *paths, uint32_t count);

#endif /* SLUICE_VIEW_SCENE_OPEN_H */
