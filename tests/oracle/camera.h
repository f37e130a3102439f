/** The rays of a scene's camera. */
#ifndef TESTS_ORACLE_CAMERA_H
#define TESTS_ORACLE_CAMERA_H

#include "oracle/rays.h"

/** Zeroed is not usable. */
struct oracle_camera {
    uint32_t width, height; ///< pixels
    bool is_perspective;
    double to_world[12];
    double window[4]; ///< x0, x1, y0, y1 of the picture on the plane z = 1, or in the plane z = 0
};

/** `dim` of 0: the part of the film that its crop window shows. */
void oracle_camera_init(struct oracle_camera *camera, const SluicePbrtSceneInfo *info,
                        const uint32_t dim[2]);

/** The ray through a point of the picture, in pixels from its upper left corner. */
struct oracle_ray oracle_camera_ray(const struct oracle_camera *camera, double x, double y);

/** Radians of a pixel in the middle of a picture; 0 for parallel rays. */
double oracle_camera_spread(const struct oracle_camera *camera);

#endif /* TESTS_ORACLE_CAMERA_H */
