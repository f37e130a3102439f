/** The camera: position, motion by input, and paths. */
#ifndef SLUICE_VIEW_CAMERA_H
#define SLUICE_VIEW_CAMERA_H

#include "settings.h"

#include "../../samples/common/vecmath.h"

#include <stddef.h>

/** Radians. Yaw 0 looks along -z, growing to the right; pitch is above the horizon. */
struct view_camera {
    struct vec3 position;
    float yaw, pitch;
    float fov;    ///< vertical field of view; unused while `span` is above 0
    float roll;   ///< to the right, seen along the camera
    float span;   ///< half of the visible height of an orthographic camera; 0: perspective
    float aspect; ///< width / height that stays in view in narrower pictures; 0: any
};

struct vec3 view_camera_forward(const struct view_camera *camera);
struct vec3 view_camera_right(const struct view_camera *camera);
/** Half of the width and height that a camera sees: at distance 1, or at any distance if it is
 *  orthographic. */
struct view_extent {
    float x, y;
} view_camera_extent(const struct view_camera *camera, float aspect);
/** Rows of the matrix from the world to the camera, which looks along -z, as columns:
 * m[column][row].
 */
void view_camera_matrix(const struct view_camera *camera, float m[4][4]);
/** Returns the camera of a rigid matrix, as view_camera_matrix writes it, with the lens of `lens`.
 */
struct view_camera view_camera_of_matrix(const float m[16], const struct view_camera *lens);
/** Returns a camera at `eye` with these axes, which need not have length 1. */
struct view_camera view_camera_of_axes(struct vec3 eye, struct vec3 forward, struct vec3 up,
                                       const struct view_camera *lens);
/** Returns a camera at `eye` that looks at `target`. */
struct view_camera view_camera_at(struct vec3 eye, struct vec3 target, float fov);
/** Reads "x,y,z,yaw,pitch,fov", optionally followed by ",roll,span,aspect". Blanks may replace the
 *  commas. False for any other text. */
bool view_camera_read(const char *text, struct view_camera *camera);
/** Writes the camera in the syntax of view_camera_read, with commas. Returns `text`. */
const char *view_camera_write(const struct view_camera *camera, char *text, size_t size);
/** Interpolates between two cameras. Angles turn the shorter way. */
struct view_camera view_camera_mix(const struct view_camera *a, const struct view_camera *b,
                                   float part);

/** Motion that input requests in this frame. */
struct camera_wish {
    float forward, right, up;  ///< -1 to 1
    float look_right, look_up; ///< radians
    float pan_right, pan_up;   ///< part of the picture
    float dolly;               ///< turns of the wheel
    float factor;              ///< factor of the speed
    float seconds;
};

/** Moves the camera. `dolly` also narrows the view of an orthographic camera. `center`: point that
 *  VIEW_ORBIT turns around; panning moves it. */
void view_camera_move(struct view_camera *camera, const struct camera_wish *wish, int motion,
                      double speed, struct vec3 *center);

/** Cameras at ascending times from 0 on. A zeroed path is empty. */
struct camera_path {
    struct camera_path_point {
        float seconds;
        struct view_camera camera;
    } * points; ///< owned
    size_t count, capacity;
};

/** A camera of a file, and the path along which an animation moves it. */
struct file_camera {
    char *name; ///< owned
    struct view_camera camera;
    struct camera_path path; ///< empty: the camera stands still
};

bool camera_path_add(struct camera_path *path, float seconds, const struct view_camera *camera);
void camera_path_finish(struct camera_path *path);
/** Writes the camera at a time. Stays at the last point after the end. False if the path is empty.
 */
bool camera_path_get(const struct camera_path *path, float seconds, struct view_camera *camera);
float camera_path_length(const struct camera_path *path);
/** Reads a text file with one line per point: "seconds x y z yaw pitch fov", optionally followed by
 *  "roll span aspect". False, with a line on stderr, on failure. */
bool camera_path_read(const char *file, struct camera_path *path);
/** Writes a path in the syntax of camera_path_read. False, with a line on stderr, on failure. */
bool camera_path_write(const char *file, const struct camera_path *path);

#endif /* SLUICE_VIEW_CAMERA_H */
