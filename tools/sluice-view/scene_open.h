/** Scenes of all kinds. */
#ifndef SLUICE_VIEW_SCENE_OPEN_H
#define SLUICE_VIEW_SCENE_OPEN_H

#include "scene_data.h"

struct gpu;

struct scene_request {
    const char *const *paths; ///< pictures and folders, or one file of a scene; none: the room
    uint32_t path_count;
    const char *cache;               ///< folder for baked pictures
    bool wait;                       ///< until all pictures are baked
    struct scene_progress *progress; ///< NULL: nobody watches
    /** Programs of scenes of pbrt are compiled for it. NULL: when they are shown. */
    const struct gpu *gpu;
    uint32_t threads; ///< of loaders; 0: as many as the library chooses
};

/** Says on stderr what is wrong, and which images cannot be shown. False, with nothing left in
 *  `scene`, if there is nothing to show or it was canceled. */
bool scene_open_paths(const struct scene_request *request, struct scene_data *scene);
/** False, with a line on stderr, for paths that are no scene together. */
bool scene_open_takes(const char *const *paths, uint32_t count);

#endif /* SLUICE_VIEW_SCENE_OPEN_H */
