/** Values of materials and textures at points of surfaces. */
#ifndef TESTS_ORACLE_VALUES_H
#define TESTS_ORACLE_VALUES_H

#include "oracle/pictures.h"
#include "oracle/scene.h"

/** Pictures of a scene's textures and lights: read when they are first sampled. */
struct oracle_values {
    const struct oracle_scene *scene;
    struct oracle_picture *pictures; ///< owned; of textures, then of lights
    uint8_t *states;                 ///< owned; 0: not read yet, 1: there, 2: cannot be read
    bool nearest;                    ///< no filter, whatever textures say
};

bool oracle_values_create(struct oracle_values *values, const struct oracle_scene *scene);
void oracle_values_finish(struct oracle_values *values);

/** A point of a surface as far as textures see it. */
struct oracle_point {
    double u, v;
    struct vec world;
};

/** Coordinates of a texture at a point; (0, 0) is the lower left corner of a picture. */
void oracle_map(const SluicePbrtTexture *texture, const struct oracle_point *point, double *s,
                double *t);

/** A color, or a constant. */
struct vec oracle_value(struct oracle_values *values, const SluicePbrtValue *value,
                        const struct oracle_point *point);

/** A number: of pictures with an alpha channel that channel (pbrt-v4), of colors their luminance
 *  (pbrt-v3) or mean (pbrt-v4). */
double oracle_number(struct oracle_values *values, const SluicePbrtValue *value,
                     const struct oracle_point *point);

/** Radiance of an infinite light from a direction. */
struct vec oracle_sky(struct oracle_values *values, uint32_t light, struct vec direction);

/** Mean of an infinite light over the texels of its picture. */
struct vec oracle_mean_sky(struct oracle_values *values, uint32_t light);

#endif /* TESTS_ORACLE_VALUES_H */
