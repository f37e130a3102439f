/** Noise over the unit square that repeats at its edges. */
#ifndef TRACER_PERIODIC_H
#define TRACER_PERIODIC_H

#include "../common/noise.h"

/** Value noise in [-1, 1] of `period_x` x `period_y` cells, powers of two. */
static inline float periodic_noise(float u, float v, int32_t period_x, int32_t period_y,
                                   uint32_t seed)
{
    float x = u * (float)period_x, y = v * (float)period_y;
    int32_t ix = noise_floor(x), iy = noise_floor(y);
    float fx = x - (float)ix, fy = y - (float)iy;
    int32_t x0 = ix & (period_x - 1), x1 = (ix + 1) & (period_x - 1);
    int32_t y0 = iy & (period_y - 1), y1 = (iy + 1) & (period_y - 1);
    float a = noise_unit(noise_hash(x0, y0, seed)), b = noise_unit(noise_hash(x1, y0, seed));
    float c = noise_unit(noise_hash(x0, y1, seed)), d = noise_unit(noise_hash(x1, y1, seed));
    float s = fx * fx * (3.0f - 2.0f * fx), t = fy * fy * (3.0f - 2.0f * fy);
    return 2.0f * (a + (b - a) * s + (c - a) * t + (a - b - c + d) * s * t) - 1.0f;
}

/** Sums octaves of noise from a period on, down to the footprint. */
static inline float periodic_octaves(float u, float v, int32_t period_x, int32_t period_y,
                                     int octaves, float gain, float footprint, uint32_t seed)
{
    float sum = 0.0f, amplitude = 1.0f;
    for (int i = 0; i < octaves; i++, period_x *= 2, period_y *= 2, amplitude *= gain) {
        int32_t finest = period_x > period_y ? period_x : period_y;
        float visible = noise_visible((float)finest, footprint);
        if (visible == 0.0f)
            break;
        sum += amplitude * visible *
               periodic_noise(u, v, period_x, period_y, seed + 101u * (uint32_t)i);
    }
    return sum;
}

/** Distances to the two nearest feature points. Each cell of a `period` x `period` grid has one
 * point. */
struct periodic_cell {
    float nearest, second; ///< distances, in cells
    uint32_t id;           ///< hash of the nearest point's cell
};

static inline struct periodic_cell periodic_cells(float u, float v, int32_t period, uint32_t seed)
{
    float x = u * (float)period, y = v * (float)period;
    struct periodic_cell cell = {9.0f, 9.0f, 0};
    int32_t ix = noise_floor(x), iy = noise_floor(y);
    for (int32_t row = iy - 1; row <= iy + 1; row++)
        for (int32_t column = ix - 1; column <= ix + 1; column++) {
            uint32_t hash = noise_hash(column & (period - 1), row & (period - 1), seed);
            float dx = (float)column + 0.1f + 0.8f * (float)(hash & 0xffff) / 65536.0f - x;
            float dy = (float)row + 0.1f + 0.8f * (float)(hash >> 16) / 65536.0f - y;
            float distance = dx * dx + dy * dy;
            if (distance < cell.nearest) {
                cell.second = cell.nearest;
                cell.nearest = distance;
                cell.id = hash;
            } else if (distance < cell.second) {
                cell.second = distance;
            }
        }
    cell.nearest = sqrtf(cell.nearest);
    cell.second = sqrtf(cell.second);
    return cell;
}

#endif /* TRACER_PERIODIC_H */
