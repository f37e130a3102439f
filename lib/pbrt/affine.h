/** Affine transforms in double precision: three rows of four. */
#ifndef SLC_PBRT_AFFINE_H
#define SLC_PBRT_AFFINE_H

#include <sluice/pbrt.h>

struct slc_pbrt_affine {
    double m[3][4];
};

struct slc_pbrt_affine slc_pbrt_identity(void);
/** Returns a * b: b is applied first. */
struct slc_pbrt_affine slc_pbrt_product(const struct slc_pbrt_affine *a,
                                        const struct slc_pbrt_affine *b);
/** Inverts. False: singular. */
bool slc_pbrt_inverse(const struct slc_pbrt_affine *a, struct slc_pbrt_affine *inverse);
/** Returns the determinant. Negative: mirrors. 0: singular. */
double slc_pbrt_determinant(const struct slc_pbrt_affine *a);
bool slc_pbrt_is_finite(const struct slc_pbrt_affine *a);

/** Makes a rotation by `degrees` around an axis of any length. False: length 0. */
bool slc_pbrt_rotation(double degrees, const double axis[3], struct slc_pbrt_affine *rotation);
/** Makes world-to-camera. False: the directions are parallel or 0. */
bool slc_pbrt_look_at(const double eye[3], const double look[3], const double up[3],
                      struct slc_pbrt_affine *transform);

void slc_pbrt_apply_point(const struct slc_pbrt_affine *a, const double point[3], double out[3]);
void slc_pbrt_apply_vector(const struct slc_pbrt_affine *a, const double vector[3], double out[3]);

/** Returns the nearest finite float. */
float slc_pbrt_clamped_float(double value);
void slc_pbrt_to_floats(const struct slc_pbrt_affine *a, float out[12]);
struct slc_pbrt_affine slc_pbrt_from_floats(const float in[12]);

/** Returns empty bounds: least > most. */
SluicePbrtBounds slc_pbrt_no_bounds(void);
void slc_pbrt_add_point(SluicePbrtBounds *bounds, const float point[3]);
/** Returns the box around a transformed box. */
SluicePbrtBounds slc_pbrt_apply_bounds(const struct slc_pbrt_affine *a,
                                       const SluicePbrtBounds *bounds);

#endif /* SLC_PBRT_AFFINE_H */
