/** From the camera of the viewer to that of a scene of pbrt. No device. */
#ifndef SLUICE_VIEW_PBRT_FRAME_H
#define SLUICE_VIEW_PBRT_FRAME_H

#include "camera.h"

#include <sluice/pbrt.h>

/**
 * The viewer's camera has y up and no roll. Scenes of pbrt have any axis up, any unit, and cameras
 * that roll or mirror. A frame maps directions and positions, and keeps the roll and the mirroring
 * of the scene's camera.
 */
struct pbrt_frame {
    struct vec3 axes[3];      ///< x, y and z of the viewer in the world, of length 1, perpendicular
    float unit;               ///< of the viewer, in units of the world
    float scene_to_world[12]; ///< camera of the scene
    struct view_camera camera; ///< ... as the viewer has it
};

/** `camera_to_world` as in SluicePbrtSceneInfo. The scene's diagonal becomes 20 units. `fov`:
 *  vertical, in radians. */
void pbrt_frame_init(const float camera_to_world[12], const SluicePbrtBounds *box, float fov,
                     struct pbrt_frame *frame);
/** Camera to world, for camera_constants. The scene's own camera, while `camera` is it. */
void pbrt_frame_matrix(const struct pbrt_frame *frame, const struct view_camera *camera,
                       float matrix[12]);
/** A point of the world as the viewer has it. */
struct vec3 pbrt_frame_position(const struct pbrt_frame *frame, const float world[3]);

#endif /* SLUICE_VIEW_PBRT_FRAME_H */
