/** Opens scenes of all kinds. */
#ifndef SLUICE_VIEW_SCENE_OPEN_H
#define SLUICE_VIEW_SCENE_OPEN_H

#include "scene_data.h"

struct gpu;

struct scene_request {
    const char *const *paths; ///< pictures and folders, or one file of a scene; none: the room
    uint32_t path_count;
    const char *cache;               ///< folder for baked pictures
    bool wait;                       ///< waits until all pictures are baked
    struct scene_progress *progress; ///< NULL: progress is not reported
    /** Device that programs of pbrt scenes are compiled for. NULL: compiles them when shown. */
    const struct gpu *gpu;
    uint32_t threads; ///< threads of loaders; 0: chosen by the library
};

/** Opens a scene. Reports faults, and images that cannot be shown, on stderr. False, with `scene`
 *  empty, if there is nothing to show or the load was canceled. */
bool scene_open_paths(const struct scene_request *request, struct scene_data *scene);
/** Returns true if the paths form a scene. Otherwise false, with a line on stderr. */
bool scene_open_takes(const char *const *paths, uint32_t count);

#endif /* SLUICE_VIEW_SCENE_OPEN_H */
