/** Cameras of a glTF file. */
#ifndef SLUICE_VIEW_GLTF_CAMERAS_H
#define SLUICE_VIEW_GLTF_CAMERAS_H

#include "camera.h"
#include "gltf_file.h"

#define GLTF_MOST_CAMERAS 64u

struct file_cameras {
    struct file_camera *items; ///< owned
    uint32_t count;
};

/** One camera for each node that has one, with the path of the first animation that moves it, and
 *  one more for each further animation; GLTF_MOST_CAMERAS at most. `note` hears of cameras that
 *  cannot be used. False without memory; finish them in any case. */
bool gltf_read_cameras(struct gltf_file *file,
                       void (*note)(void *user, const char *where, const char *problem), void *user,
                       struct file_cameras *cameras);
void file_cameras_finish(struct file_cameras *cameras);

#endif /* SLUICE_VIEW_GLTF_CAMERAS_H */
