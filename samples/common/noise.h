/** Noise and small functions for pictures that are computed: pure, fast, the same everywhere. */
#ifndef SAMPLES_COMMON_NOISE_H
#define SAMPLES_COMMON_NOISE_H

#include <math.h>
#include <stdint.h>

#define NOISE_TAU 6.2831853f

/** A well mixed word for two coordinates and a seed. */
static inline uint32_t noise_hash(int32_t x, int32_t y, uint32_t seed)
{
    uint32_t h = (uint32_t)x * 0x9e3779b1u ^ (uint32_t)y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
    h = (h ^ h >> 15) * 0x2c1b3c6du;
    h = (h ^ h >> 12) * 0x297a2d39u;
    return h ^ h >> 15;
}

/** [0, 1) */
static inline float noise_unit(uint32_t hash)
{
    return (float)(hash >> 8) * (1.0f / 16777216.0f);
}

static inline float noise_clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static inline float noise_mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

static inline float noise_smoothstep(float low, float high, float x)
{
    float t = noise_clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

static inline int32_t noise_floor(float x)
{
    int32_t i = (int32_t)x;
    return i - (x < (float)i);
}

/** Value noise in [-1, 1] and its derivatives. */
static inline float noise_value(float x, float y, uint32_t seed, float *dx, float *dy)
{
    int32_t ix = noise_floor(x), iy = noise_floor(y);
    float fx = x - (float)ix, fy = y - (float)iy;
    float a = noise_unit(noise_hash(ix, iy, seed)), b = noise_unit(noise_hash(ix + 1, iy, seed));
    float c = noise_unit(noise_hash(ix, iy + 1, seed));
    float d = noise_unit(noise_hash(ix + 1, iy + 1, seed));
    float u = fx * fx * (3.0f - 2.0f * fx), v = fy * fy * (3.0f - 2.0f * fy);
    float k = a - b - c + d;
    *dx = 12.0f * fx * (1.0f - fx) * (b - a + k * v);
    *dy = 12.0f * fy * (1.0f - fy) * (c - a + k * u);
    return 2.0f * (a + (b - a) * u + (c - a) * v + k * u * v) - 1.0f;
}

/** Returns the visible share, 0 to 1, of a wave of `frequency` under a texel of `footprint`. */
static inline float noise_visible(float frequency, float footprint)
{
    return 1.0f - noise_smoothstep(0.2f, 0.6f, frequency * footprint);
}

struct noise_sum {
    float value, dx, dy;
};

/** Octaves of value noise from `frequency` on; those finer than the footprint are left out. */
static inline struct noise_sum noise_octaves(float x, float y, float frequency, int octaves,
                                             float gain, float footprint, uint32_t seed)
{
    struct noise_sum sum = {0, 0, 0};
    float amplitude = 1.0f;
    for (int i = 0; i < octaves; i++, frequency *= 2.03f, amplitude *= gain) {
        float weight = amplitude * noise_visible(frequency, footprint), dx, dy;
        if (weight == 0.0f)
            break;
        sum.value +=
            weight * noise_value(x * frequency, y * frequency, seed + (uint32_t)i, &dx, &dy);
        sum.dx += weight * frequency * dx;
        sum.dy += weight * frequency * dy;
    }
    return sum;
}

/** 1 within |x| < half_width, 0 outside, as seen through the footprint. */
static inline float noise_line(float x, float half_width, float footprint)
{
    float soft = footprint > 1e-9f ? footprint : 1e-9f;
    float covered = noise_clamp((half_width - fabsf(x)) / soft + 0.5f, 0.0f, 1.0f);
    float most = 2.0f * half_width / soft; /* a line thinner than the footprint is a fainter one */
    return most < 1.0f ? covered * most : covered;
}

/** A palette of cosines. */
static inline void noise_palette(float t, const float phase[3], float rgb[3])
{
    for (int i = 0; i < 3; i++)
        rgb[i] = 0.5f + 0.5f * cosf(NOISE_TAU * (t + phase[i]));
}

#endif /* SAMPLES_COMMON_NOISE_H */
