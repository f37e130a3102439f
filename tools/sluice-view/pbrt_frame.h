/** Conversion between cameras of the viewer and of pbrt scenes. Uses no device. */
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
    float unit;               ///< one unit of the viewer, in units of the world
    float scene_to_world[12]; ///< matrix of the scene's camera
    struct view_camera camera; ///< the scene's camera as a camera of the viewer
};

/** Computes the frame of a scene. Its diagonal becomes 20 units. `camera_to_world`: as in
 *  SluicePbrtSceneInfo. `fov`: vertical, in radians. */
void pbrt_frame_init(const float camera_to_world[12], const SluicePbrtBounds *box, float fov,
                     struct pbrt_frame *frame);
/** Writes the camera-to-world matrix for camera_constants. Writes the matrix of the scene unchanged
 *  if `camera` is the scene's camera. */
void pbrt_frame_matrix(const struct pbrt_frame *frame, const struct view_camera *camera,
                       float matrix[12]);
/** Returns a point of the world in coordinates of the viewer. */
struct vec3 pbrt_frame_position(const struct pbrt_frame *frame, const float world[3]);

#endif /* SLUICE_VIEW_PBRT_FRAME_H */
