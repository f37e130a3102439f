/** Vectors and matrices for a camera. Column-major, right-handed, depth 0 to 1. */
#ifndef SAMPLES_COMMON_VECMATH_H
#define SAMPLES_COMMON_VECMATH_H

#include <math.h>

struct vec3 {
    float x, y, z;
};

/** m[column][row] */
struct mat4 {
    float m[4][4];
};

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec3 vec3_scale(struct vec3 a, float s)
{
    return (struct vec3){a.x * s, a.y * s, a.z * s};
}

static inline struct vec3 vec3_mix(struct vec3 a, struct vec3 b, float t)
{
    return vec3_add(vec3_scale(a, 1.0f - t), vec3_scale(b, t));
}

static inline float vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline struct vec3 vec3_normalize(struct vec3 a)
{
    return vec3_scale(a, 1.0f / sqrtf(vec3_dot(a, a)));
}

static inline struct mat4 mat4_multiply(const struct mat4 *a, const struct mat4 *b)
{
    struct mat4 product = {0};
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++)
            for (int i = 0; i < 4; i++)
                product.m[column][row] += a->m[i][row] * b->m[column][i];
    return product;
}

/** World space to the space of a camera at `eye` that looks at `target`, y up. */
static inline struct mat4 mat4_look_at(struct vec3 eye, struct vec3 target)
{
    struct vec3 back = vec3_normalize(vec3_sub(eye, target));
    struct vec3 right = vec3_normalize(vec3_cross((struct vec3){0, 1, 0}, back));
    struct vec3 up = vec3_cross(back, right);
    return (struct mat4){{
        {right.x, up.x, back.x, 0},
        {right.y, up.y, back.y, 0},
        {right.z, up.z, back.z, 0},
        {-vec3_dot(right, eye), -vec3_dot(up, eye), -vec3_dot(back, eye), 1},
    }};
}

/** Projection to Vulkan's clip space: y down, depth 0 at `near` and 1 at `far`. `fov` is vertical,
 * in radians. */
static inline struct mat4 mat4_perspective(float fov, float aspect, float near, float far)
{
    float f = 1.0f / tanf(fov / 2.0f);
    return (struct mat4){{
        {f / aspect, 0, 0, 0},
        {0, -f, 0, 0},
        {0, 0, far / (near - far), -1},
        {0, 0, near * far / (near - far), 0},
    }};
}

#endif /* SAMPLES_COMMON_VECMATH_H */
