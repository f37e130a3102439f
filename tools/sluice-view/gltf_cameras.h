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

/** Reads one camera per node with a camera, with the path of the first animation that moves it.
 * Each further animation adds a camera. At most GLTF_MOST_CAMERAS. `note` is called for cameras
 * that cannot be used. False without memory. Always call file_cameras_finish. */
bool gltf_read_cameras(struct gltf_file *file,
                       void (*note)(void *user, const char *where, const char *problem), void *user,
                       struct file_cameras *cameras);
void file_cameras_finish(struct file_cameras *cameras);

#endif /* SLUICE_VIEW_GLTF_CAMERAS_H */
