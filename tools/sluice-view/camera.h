/** The camera: where it is, how input moves it, and paths that it follows. */
#ifndef SLUICE_VIEW_CAMERA_H
#define SLUICE_VIEW_CAMERA_H

#include "settings.h"

#include "../../samples/common/vecmath.h"

#include <stddef.h>

/** Radians. Yaw 0 looks along -z, growing to the right; pitch is above the horizon. */
struct view_camera {
    struct vec3 position;
    float yaw, pitch;
    float fov;    ///< vertical; also of parallel cameras, for whoever draws lines with it
    float roll;   ///< to the right, seen along the camera
    float span;   ///< half of the height that parallel rays see; 0: perspective
    float aspect; ///< width / height that stays in view in narrower pictures; 0: any
};

struct vec3 view_camera_forward(const struct view_camera *camera);
struct vec3 view_camera_right(const struct view_camera *camera);
/** Half of what a picture of this aspect sees of a plane: at distance 1, or of any for parallel
 *  rays. */
struct view_extent {
    float x, y;
} view_camera_extent(const struct view_camera *camera, float aspect);
/** Rows of the matrix from the world to the camera, which looks along -z, as columns:
 * m[column][row].
 */
void view_camera_matrix(const struct view_camera *camera, float m[4][4]);
/** The camera of a rigid matrix as view_camera_matrix writes it, with the lens of `lens`. */
struct view_camera view_camera_of_matrix(const float m[16], const struct view_camera *lens);
/** A camera at `eye` whose axes are these; they need not be of length 1. */
struct view_camera view_camera_of_axes(struct vec3 eye, struct vec3 forward, struct vec3 up,
                                       const struct view_camera *lens);
/** A camera at `eye` that looks at `target`. */
struct view_camera view_camera_at(struct vec3 eye, struct vec3 target, float fov);
/** "x,y,z,yaw,pitch,fov", or these with ",roll,span,aspect" behind; also with blanks between. False
 *  for anything else. */
bool view_camera_read(const char *text, struct view_camera *camera);
/** As view_camera_read takes it, with commas. Returns `text`. */
const char *view_camera_write(const struct view_camera *camera, char *text, size_t size);
/** Angles take the shorter way. */
struct view_camera view_camera_mix(const struct view_camera *a, const struct view_camera *b,
                                   float part);

/** Moves that the user asks for in this frame. */
struct camera_wish {
    float forward, right, up;  ///< -1 to 1
    float look_right, look_up; ///< radians
    float pan_right, pan_up;   ///< part of the picture
    float dolly;               ///< turns of the wheel
    float factor;              ///< of the speed
    float seconds;
};

/** Moves the camera; `dolly` also makes the view of parallel rays lower. `center` is what
 * VIEW_ORBIT turns round, and moves with panning. */
void view_camera_move(struct view_camera *camera, const struct camera_wish *wish, int motion,
                      double speed, struct vec3 *center);

/** Cameras at times that grow from 0. Zeroed is empty. */
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
    struct camera_path path; ///< empty: it stands
};

bool camera_path_add(struct camera_path *path, float seconds, const struct view_camera *camera);
void camera_path_finish(struct camera_path *path);
/** False if the path is empty. Stays at the last point after the end. */
bool camera_path_get(const struct camera_path *path, float seconds, struct view_camera *camera);
float camera_path_length(const struct camera_path *path);
/** Text files: a line "seconds x y z yaw pitch fov" per point, or this with "roll span aspect"
 *  behind. Say on stderr what is wrong. */
bool camera_path_read(const char *file, struct camera_path *path);
bool camera_path_write(const char *file, const struct camera_path *path);

#endif /* SLUICE_VIEW_CAMERA_H */
