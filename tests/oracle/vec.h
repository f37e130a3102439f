/** Vectors and matrices in double precision. Matrices are those of pbrt.h: three rows of four. */
#ifndef TESTS_ORACLE_VEC_H
#define TESTS_ORACLE_VEC_H

#include <math.h>

#define ORACLE_PI 3.14159265358979323846

struct vec {
    double x, y, z;
};

static inline struct vec vec(double x, double y, double z)
{
    return (struct vec){x, y, z};
}

static inline struct vec vec_of(const float v[3])
{
    return vec(v[0], v[1], v[2]);
}

static inline struct vec add(struct vec a, struct vec b)
{
    return vec(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct vec sub(struct vec a, struct vec b)
{
    return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct vec scale(struct vec a, double s)
{
    return vec(a.x * s, a.y * s, a.z * s);
}

static inline struct vec mul(struct vec a, struct vec b)
{
    return vec(a.x * b.x, a.y * b.y, a.z * b.z);
}

/** a + b * s */
static inline struct vec along(struct vec a, struct vec b, double s)
{
    return add(a, scale(b, s));
}

static inline double dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec cross(struct vec a, struct vec b)
{
    return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double length(struct vec a)
{
    return sqrt(dot(a, a));
}

/** A vector of length 0 stays as it is. */
static inline struct vec unit(struct vec a)
{
    double l = length(a);
    return l > 0 ? scale(a, 1 / l) : a;
}

static inline double mean(struct vec a)
{
    return (a.x + a.y + a.z) / 3;
}

/** Weights of Rec. 709. */
static inline double luminance(struct vec a)
{
    return 0.2126 * a.x + 0.7152 * a.y + 0.0722 * a.z;
}

static inline struct vec turn_to(struct vec n, struct vec side)
{
    return dot(n, side) < 0 ? scale(n, -1) : n;
}

static inline struct vec apply_vector(const double m[12], struct vec v)
{
    return vec(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
               m[8] * v.x + m[9] * v.y + m[10] * v.z);
}

static inline struct vec apply_point(const double m[12], struct vec p)
{
    return add(apply_vector(m, p), vec(m[3], m[7], m[11]));
}

static inline double determinant(const double m[12])
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

/** Along the transposed inverse, of any length. */
static inline struct vec apply_normal(const double m[12], struct vec n)
{
    struct vec r0 = vec(m[0], m[1], m[2]), r1 = vec(m[4], m[5], m[6]), r2 = vec(m[8], m[9], m[10]);
    double sign = determinant(m) < 0 ? -1 : 1;
    return scale(vec(dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n)), sign);
}

/** The product of the linear part's inverse and v. */
static inline struct vec apply_inverse_vector(const double m[12], struct vec v)
{
    struct vec c0 = vec(m[0], m[4], m[8]), c1 = vec(m[1], m[5], m[9]), c2 = vec(m[2], m[6], m[10]);
    double d = determinant(m);
    return scale(vec(dot(cross(c1, c2), v), dot(cross(c2, c0), v), dot(cross(c0, c1), v)), 1 / d);
}

static inline void matrix_of(const float in[12], double out[12])
{
    for (int i = 0; i < 12; i++)
        out[i] = in[i];
}

/** out = a * b */
static inline void matrix_product(const double a[12], const double b[12], double out[12])
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = column == 3 ? a[4 * row + 3] : 0;
            for (int i = 0; i < 3; i++)
                sum += a[4 * row + i] * b[4 * i + column];
            out[4 * row + column] = sum;
        }
}

#endif /* TESTS_ORACLE_VEC_H */
