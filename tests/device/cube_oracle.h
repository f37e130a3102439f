/**
 * Cube maps in double precision, by the table of the Vulkan specification ("Cube Map Face
 * Selection") and by search: the texel beyond an edge is the one whose center is nearest.
 */
#ifndef TESTS_DEVICE_CUBE_ORACLE_H
#define TESTS_DEVICE_CUBE_ORACLE_H

#include <stdbool.h>
#include <stdint.h>

#define CUBE_ORACLE_FACES 6u

struct cube_texel {
    uint32_t face, x, y;
};

/** The texels of a bilinear sample and their weights, which sum to 1. */
struct cube_taps {
    struct cube_texel texels[4];
    double weights[4];
    uint32_t count;
};

/** A position on a face, 0 to 1, or beyond on its plane. */
void cube_oracle_direction(uint32_t face, double u, double v, double direction[3]);
/** The derivative of that by u and v, times (du, dv). */
void cube_oracle_derivative(uint32_t face, double du, double dv, double derivative[3]);
void cube_oracle_position(const double direction[3], uint32_t *face, double uv[2]);

/** Returns the taps for faces of size x size texels. Where three faces meet, three texels have
 * equal extra weight. */
struct cube_taps cube_oracle_bilinear(uint32_t size, const double direction[3]);

/** The distance of a direction's point on the cube, whose edges have length 2, to a rectangle of
 *  texels of a face. */
double cube_oracle_distance(const double direction[3], uint32_t size, uint32_t face, uint32_t left,
                            uint32_t top, uint32_t right, uint32_t bottom);

#endif /* TESTS_DEVICE_CUBE_ORACLE_H */
