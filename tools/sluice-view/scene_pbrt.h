/** Pbrt scenes: the part that needs no device. */
#ifndef SLUICE_VIEW_SCENE_PBRT_H
#define SLUICE_VIEW_SCENE_PBRT_H

#include "pbrt_frame.h"
#include "scene_data.h"

#include "../../samples/demand-pbrt/scene.h"

struct traced_parts;

/** A picture file that textures and skies name. */
struct scene_pbrt_picture {
    const char *path; ///< path in the scene
    const char *name; ///< end of `path`
};

struct scene_pbrt {
    struct scene scene;
    struct pbrt_frame frame;
    char cache[4096];                    ///< folder for baked pictures
    struct scene_pbrt_picture *pictures; ///< owned
    uint32_t picture_count;
    uint32_t *texture_pictures; ///< owned; first picture of each texture; UINT32_MAX: none
    struct traced_parts *parts; ///< owned; made by the thread that opens the scene; or NULL
    uint32_t share_count;       ///< number of further owners
};

bool scene_pbrt_takes(const char *path);
/** Reads the text and the boxes of all shapes, but no picture. Sets name, camera and bounds of the
 *  scene. False, with file, line and cause on stderr, on failure. */
bool scene_pbrt_open(const char *path, const char *cache, struct scene_data *scene);
/** Fills a zeroed scene that shares `pbrt`. Each share needs scene_pbrt_close. False without
 * memory. */
bool scene_pbrt_share(struct scene_pbrt *pbrt, const struct scene_data *from,
                      struct scene_data *scene);
/** Closes a share, and frees the scene with the last one. NULL is allowed. */
void scene_pbrt_close(struct scene_pbrt *pbrt);
/** Returns the first picture in a value; UINT32_MAX: none. */
uint32_t scene_pbrt_picture_of(const struct scene_pbrt *pbrt, const SluicePbrtValue *value);

#endif /* SLUICE_VIEW_SCENE_PBRT_H */
