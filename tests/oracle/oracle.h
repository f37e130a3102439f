/** A scene with everything that rendering requires. */
#ifndef TESTS_ORACLE_ORACLE_H
#define TESTS_ORACLE_ORACLE_H

#include "oracle/camera.h"
#include "oracle/census.h"
#include "oracle/path.h"
#include "oracle/tiles.h"

#include <stdio.h>

enum oracle_mode { ORACLE_CAST, ORACLE_PRIMARY, ORACLE_DIRECT, ORACLE_PATH };

struct oracle_settings {
    uint32_t dim[2];  ///< picture size; 0: as in the scene's film
    int mode;         ///< enum oracle_mode
    uint32_t samples; ///< samples per pixel; the first is the pixel's center
    uint32_t bounces; ///< mode path only
    uint32_t seed;
    float background[3];
    bool face_forward, is_quiet;
    bool nearest; ///< true: pictures are not filtered
};

/** Zeroed is empty. Must not move. */
struct oracle {
    struct oracle_settings settings;
    struct oracle_scene scene;
    struct oracle_values values;
    struct oracle_camera camera;
    struct oracle_rays *rays;
    struct oracle_tracer tracer;
};

/** Call VIPS_INIT before. Reports errors on stderr. Call oracle_finish even after an error. */
bool oracle_init(struct oracle *oracle, const char *path, const struct oracle_settings *settings);
void oracle_finish(struct oracle *oracle);

/** Renders [height][width] RGBA floats, row 0 on top. */
void oracle_render(const struct oracle *oracle, float *rgba);
/** Casts one ray through the center of each pixel. `hits`: array of the hits, or NULL. `tiles` may
 * be NULL. Returns false if tiles cannot be counted. */
bool oracle_cast(struct oracle *oracle, struct oracle_census *census, struct oracle_tiles *tiles,
                 FILE *hits);

#endif /* TESTS_ORACLE_ORACLE_H */
