/**
 * The functions of shaders/include/sluice in C, line by line, so that one can be tested against the
 * other. Integer functions agree exactly, the others up to the precision of the device's float
 * division, log2 and exp2. Denormal numbers may be taken for 0 on either side.
 */
#ifndef SLC_VULKAN_SHADER_TWINS_H
#define SLC_VULKAN_SHADER_TWINS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include <sluice/shared/texture_table.h>

/* stochastic.glsl */

static inline uint32_t slc_twin_mix(uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t h = x * 0x9E3779B1u + y * 0x85EBCA77u + z * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    return (h ^ (h >> 13)) * 0x297A2D39u;
}

static inline uint32_t slc_twin_hash(uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t h = slc_twin_mix(x, y, z);
    return h ^ (h >> 15);
}

/* 2^23 as a float's bits: what adding to a whole number leaves of it */
#define SLC_TWIN_FLOAT_ORIGIN 0x4B000000u

static inline bool slc_twin_select_random(uint32_t x, uint32_t y, uint32_t frame_seed,
                                          float probability)
{
    return (float)(slc_twin_mix(x, y, frame_seed) >> 9) * (1.0f / 8388608.0f) < probability;
}

static inline bool slc_twin_select_random_quad(uint32_t x, uint32_t y, uint32_t frame_seed,
                                               float probability)
{
    return slc_twin_select_random((x >> 1) + SLC_TWIN_FLOAT_ORIGIN,
                                  (y >> 1) + SLC_TWIN_FLOAT_ORIGIN, frame_seed, probability);
}

static inline bool slc_twin_select_lattice(uint32_t pixel_x, uint32_t pixel_y, uint32_t frame_index)
{
    uint32_t f = frame_index & 63;
    uint32_t x = (f & 1) << 2 | (f & 4) >> 1 | (f & 16) >> 4;
    uint32_t y = (f & 2) << 1 | (f & 8) >> 2 | (f & 32) >> 5;
    return (pixel_x & 7) == (x ^ y) && (pixel_y & 7) == y;
}

static inline bool slc_twin_select_block(uint32_t pixel_x, uint32_t pixel_y, uint32_t frame_index)
{
    uint32_t f = frame_index & 15;
    uint32_t x = (f & 1) << 1 | (f & 4) >> 2;
    uint32_t y = (f & 2) | (f & 8) >> 3;
    return ((pixel_x >> 2) & 3) == (x ^ y) && ((pixel_y >> 2) & 3) == y;
}

/* lod.glsl */

#define SLC_TWIN_LOD_LIMIT 32.0f

struct slc_twin_vec2 {
    float x, y;
};

static inline float slc_twin_clamp(float x, float low, float high)
{
    return x < low ? low : x > high ? high : x;
}

static inline float slc_twin_clamp_anisotropy(float max_anisotropy)
{
    return max_anisotropy > 1.0f ? fminf(max_anisotropy, 16.0f) : 1.0f;
}

static inline float slc_twin_lod_margin(float max_anisotropy)
{
    return max_anisotropy > 1.0f ? 0.1875f : 0.125f;
}

static inline float slc_twin_clamp_lod(float lod)
{
    return lod <= SLC_TWIN_LOD_LIMIT ? fmaxf(lod, -SLC_TWIN_LOD_LIMIT) : SLC_TWIN_LOD_LIMIT;
}

static inline float slc_twin_clamp_lod_bias(float lod_bias)
{
    return slc_twin_clamp_lod(lod_bias);
}

static inline bool slc_twin_is_finite(struct slc_twin_vec2 v)
{
    return fabsf(v.x) <= 1.0e33f && fabsf(v.y) <= 1.0e33f;
}

#define SLC_TWIN_LOD_COARSER_MARGIN 0.125f

static inline float slc_twin_lod_of_square(float minor2, float lod_bias)
{
    float lod = 0.5f * log2f(slc_twin_clamp(minor2, 5.4e-20f, 1.8e19f));
    return slc_twin_clamp(lod + lod_bias, -SLC_TWIN_LOD_LIMIT, SLC_TWIN_LOD_LIMIT);
}

/* x: the finest, y: the coarsest */
static inline struct slc_twin_vec2 slc_twin_compute_lods(struct slc_twin_vec2 dx,
                                                         struct slc_twin_vec2 dy, float lod_bias,
                                                         float max_anisotropy)
{
    float x2 = dx.x * dx.x + dx.y * dx.y;
    float y2 = dy.x * dy.x + dy.y * dy.y;
    if (!(x2 >= 0.0f && y2 >= 0.0f)) /* NaN */
        return (struct slc_twin_vec2){SLC_TWIN_LOD_LIMIT, SLC_TWIN_LOD_LIMIT};
    float n = slc_twin_clamp_anisotropy(max_anisotropy);
    float fine_major2 = fmaxf(x2, y2), coarse_major2 = fine_major2;
    float fine2 = fminf(x2, y2), coarse2 = fine2;
    float sum = x2 + y2;
    if (sum > 1.0e-30f && sum < 1.0e30f) {
        float area = (dx.x * dy.y - dx.y * dy.x) / sum;
        float root = 1.0f + sqrtf(fmaxf(1.0f - 4.0f * area * area, 0.0f));
        fine2 = fminf(fine2, 2.0f * area * area * sum / root);
        coarse_major2 = fmaxf(coarse_major2, 0.5f * root * sum);
    }
    fine2 = fmaxf(fine2, fine_major2 / (n * n));
    coarse2 = fmaxf(coarse2, coarse_major2 / (n * n));
    float bias = slc_twin_clamp_lod_bias(lod_bias);
    return (struct slc_twin_vec2){
        slc_twin_lod_of_square(fine2, bias),
        slc_twin_lod_of_square(coarse2, bias + SLC_TWIN_LOD_COARSER_MARGIN)};
}

static inline float slc_twin_compute_lod(struct slc_twin_vec2 dx, struct slc_twin_vec2 dy,
                                         float lod_bias, float max_anisotropy)
{
    return slc_twin_compute_lods(dx, dy, lod_bias, max_anisotropy).x;
}

static inline uint32_t slc_twin_finest_level(float lod, float margin, uint32_t count)
{
    return (uint32_t)slc_twin_clamp(lod - margin, 0.0f, (float)(count - 1));
}

static inline uint32_t slc_twin_coarsest_level(float lod, uint32_t count)
{
    uint32_t level = (uint32_t)slc_twin_clamp(lod, 0.0f, (float)(count - 1)) + 1;
    return level < count - 1 ? level : count - 1;
}

/* 4 to the power of LODs, without bias and margins */

struct slc_twin_squares {
    float fine, coarse, widest, sum;
};

#define SLC_TWIN_QUICK_SQUARES 1.0e14f
#define SLC_TWIN_QUICK_BIAS 16.0f

static inline struct slc_twin_squares
slc_twin_square_lods(struct slc_twin_vec2 dx, struct slc_twin_vec2 dy, float max_anisotropy)
{
    float x2 = dx.x * dx.x + dx.y * dx.y;
    float y2 = dy.x * dy.x + dy.y * dy.y;
    float area = dx.x * dy.y - dx.y * dy.x;
    float major = fmaxf(x2, y2);
    struct slc_twin_squares s;
    s.sum = x2 + y2;
    s.widest =
        fmaxf(0.5f * (s.sum + sqrtf(fmaxf(s.sum * s.sum - 4.0f * area * area, 0.0f))), major);
    s.fine = major;
    s.coarse = s.widest;
    if (max_anisotropy > 1.0f) {
        float n = slc_twin_clamp_anisotropy(max_anisotropy);
        float minor = fminf(x2, y2);
        s.fine = fmaxf(fminf(minor, area * area / fmaxf(s.widest, 1.0e-30f)), major / (n * n));
        s.coarse = fmaxf(minor, s.widest / (n * n));
    }
    return s;
}

static inline uint32_t slc_twin_floor_log4(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    int32_t exponent = (int32_t)(bits >> 23) - 127;
    return (uint32_t)(exponent > 0 ? exponent : 0) >> 1;
}

static inline float slc_twin_lod_limit(uint32_t shown, float margin)
{
    return shown == 0
               ? -SLC_TWIN_LOD_LIMIT
               : ((float)shown - (float)SLUICE_SHOWN_MARGIN) / (float)SLUICE_SHOWN_STEPS + margin;
}

static inline uint32_t slc_twin_shown_level(uint32_t shown)
{
    return ((shown > SLUICE_SHOWN_MARGIN ? shown : SLUICE_SHOWN_MARGIN) - SLUICE_SHOWN_MARGIN) /
           SLUICE_SHOWN_STEPS;
}

/* footprint.glsl */

#define SLC_TWIN_APRON 0.5625f
#define SLC_TWIN_APRON_UNEVEN 1.5625f
#define SLC_TWIN_APRON_SPLINE 1.0f

#define SLC_TWIN_FOOTPRINT_STEPS_LOG2 6

/* x, then y: where the first is behind the last, it goes on at 0. */
struct slc_twin_footprint {
    uint32_t first[2], last[2];
};

static inline uint32_t slc_twin_region_index(float texel, float size, uint32_t shift, uint32_t last)
{
    uint32_t index = (uint32_t)(texel > 0.0f ? fminf(texel, size) : 0.0f) >> shift;
    return index < last ? index : last;
}

static inline void slc_twin_region_range(float coordinate, float below, float above,
                                         uint32_t address_mode, float size, uint32_t shift,
                                         uint32_t last, uint32_t out[2])
{
    bool repeats = address_mode == SLUICE_ADDRESS_MODE_REPEAT;
    float low, high;
    out[0] = 0;
    out[1] = last;
    if (repeats) {
        if (!(below + above < size))
            return;
        float middle = (coordinate - floorf(coordinate)) * size;
        low = middle - below;
        high = middle + above;
        low += low < 0.0f ? size : 0.0f;
        high -= high >= size ? size : 0.0f;
    } else {
        float middle = coordinate;
        if (address_mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
            middle = coordinate - 2.0f * floorf(coordinate * 0.5f);
            middle = middle > 1.0f ? 2.0f - middle : middle;
            below = above = fmaxf(below, above);
        } else if (address_mode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE) {
            middle = fabsf(coordinate);
            below = above = fmaxf(below, above);
        }
        low = middle * size - below;
        high = middle * size + above;
    }
    uint32_t first = slc_twin_region_index(low, size, shift, last);
    uint32_t end = slc_twin_region_index(high, size, shift, last);
    bool wraps = repeats && low > high;
    if (wraps && first == end)
        return;
    out[0] = first;
    out[1] = wraps || end > first ? end : first; /* NaN */
}

static inline uint32_t slc_twin_shift(uint32_t power)
{
    uint32_t shift = 0;
    while (power >>= 1)
        shift++;
    return shift;
}

/* Finds the regions in the box around `uv`; half_box in texels. */
static inline struct slc_twin_footprint
slc_twin_compute_footprint(const struct SluiceTextureEntry *entry, struct slc_twin_vec2 uv,
                           struct slc_twin_vec2 half_box, uint32_t coarsest_level)
{
    bool uneven = entry->flags & SLUICE_TEXTURE_FLAG_UNEVEN;
    float more = entry->flags & SLUICE_TEXTURE_FLAG_SPLINE ? SLC_TWIN_APRON_SPLINE : 0;
    float below = (uneven ? SLC_TWIN_APRON_UNEVEN : SLC_TWIN_APRON) + more;
    float above = SLC_TWIN_APRON + more;
    struct slc_twin_footprint footprint;
    for (int axis = 0; axis < 2; axis++) {
        uint32_t size = axis ? entry->height : entry->width, level_size = size >> coarsest_level;
        float texel = uneven ? (float)size / (float)(level_size ? level_size : 1)
                             : fminf(ldexpf(1.0f, (int)coarsest_level), (float)size);
        float half = axis ? half_box.y : half_box.x;
        uint32_t range[2];
        slc_twin_region_range(axis ? uv.y : uv.x, below * texel + half, above * texel + half,
                              axis ? entry->addressModeV : entry->addressModeU, (float)size,
                              slc_twin_shift(axis ? entry->regionHeight : entry->regionWidth),
                              (axis ? entry->regionCountY : entry->regionCountX) - 1, range);
        footprint.first[axis] = range[0];
        footprint.last[axis] = range[1];
    }
    return footprint;
}

/* Returns half the box in texels, the unit of the derivatives. */
static inline struct slc_twin_vec2 slc_twin_half_box(struct slc_twin_vec2 dx,
                                                     struct slc_twin_vec2 dy, float lod_bias,
                                                     float max_anisotropy)
{
    if (!(max_anisotropy > 1.0f))
        return (struct slc_twin_vec2){0.0f, 0.0f};
    float scale = lod_bias <= 0.0f ? 1.0f : exp2f(slc_twin_clamp_lod_bias(lod_bias));
    return (struct slc_twin_vec2){scale * sqrtf(dx.x * dx.x + dy.x * dy.x),
                                  scale * sqrtf(dx.y * dx.y + dy.y * dy.y)};
}

static inline uint32_t slc_twin_range_step(uint32_t first, uint32_t last, uint32_t axis_last,
                                           uint32_t level)
{
    uint32_t length = last - first + (last < first ? axis_last + 1 : 0);
    uint32_t step = (length >> SLC_TWIN_FOOTPRINT_STEPS_LOG2) + 1;
    return step > 1u << level ? step : 1u << level;
}

static inline uint32_t slc_twin_next_region(uint32_t at, uint32_t last, uint32_t axis_last,
                                            uint32_t step)
{
    uint32_t end = at < last ? last : axis_last;
    if (at >= end)
        return 0;
    return at + step < end ? at + step : end;
}

/* feedback.glsl: what one sample marks */

struct slc_twin_levels {
    uint32_t level, coarsest, widest;
};

static inline uint32_t slc_twin_min(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static inline struct slc_twin_levels slc_twin_quick_levels(struct slc_twin_squares s,
                                                           float lod_bias, float max_anisotropy,
                                                           uint32_t count)
{
    float scale = exp2f(2.0f * lod_bias);
    float margin = max_anisotropy > 1.0f ? 0.77108f : 0.84087f;
    return (struct slc_twin_levels){
        slc_twin_min(slc_twin_floor_log4(s.fine * scale * margin), count - 1),
        slc_twin_min(slc_twin_floor_log4(s.coarse * scale * 1.18924f) + 1, count - 1),
        slc_twin_min(slc_twin_floor_log4(s.widest * scale * 1.18924f) + 1, count - 1)};
}

/* Derivatives in texels. */
static inline struct slc_twin_levels slc_twin_safe_levels(struct slc_twin_vec2 uv,
                                                          struct slc_twin_vec2 dx,
                                                          struct slc_twin_vec2 dy, float lod_bias,
                                                          float max_anisotropy, uint32_t count)
{
    if (!slc_twin_is_finite(uv))
        return (struct slc_twin_levels){count - 1, count - 1, count - 1};
    struct slc_twin_vec2 lods = slc_twin_compute_lods(dx, dy, lod_bias, max_anisotropy);
    return (struct slc_twin_levels){
        slc_twin_finest_level(lods.x, slc_twin_lod_margin(max_anisotropy), count),
        slc_twin_coarsest_level(lods.y, count),
        slc_twin_coarsest_level(slc_twin_compute_lods(dx, dy, lod_bias, 1.0f).y, count)};
}

struct slc_twin_wants {
    uint32_t level;
    struct slc_twin_footprint regions;
    uint32_t wide_level; /* level of wide_regions; UINT32_MAX: no wide regions */
    struct slc_twin_footprint wide_regions;
};

static inline struct slc_twin_wants slc_twin_wants(const struct SluiceTextureEntry *entry,
                                                   struct slc_twin_vec2 uv, struct slc_twin_vec2 dx,
                                                   struct slc_twin_vec2 dy, float lod_bias,
                                                   float max_anisotropy)
{
    float w = (float)entry->width, h = (float)entry->height;
    struct slc_twin_vec2 tx = {dx.x * w, dx.y * h}, ty = {dy.x * w, dy.y * h};
    struct slc_twin_squares squares = slc_twin_square_lods(tx, ty, max_anisotropy);
    bool quick = squares.sum < SLC_TWIN_QUICK_SQUARES && fabsf(lod_bias) <= SLC_TWIN_QUICK_BIAS &&
                 slc_twin_is_finite(uv);
    struct slc_twin_levels levels =
        quick ? slc_twin_quick_levels(squares, lod_bias, max_anisotropy, entry->mipLevelCount)
              : slc_twin_safe_levels(uv, tx, ty, lod_bias, max_anisotropy, entry->mipLevelCount);
    struct slc_twin_vec2 half_box = slc_twin_half_box(tx, ty, lod_bias, max_anisotropy);
    struct slc_twin_wants wants = {
        .level = levels.level,
        .regions = slc_twin_compute_footprint(entry, uv, half_box, levels.coarsest),
        .wide_level = UINT32_MAX};
    wants.wide_regions = wants.regions;
    if (max_anisotropy > 1.0f && levels.widest > levels.coarsest) {
        wants.wide_level = levels.coarsest + 1;
        wants.wide_regions = slc_twin_compute_footprint(entry, uv, half_box, levels.widest);
    }
    return wants;
}

#endif /* SLC_VULKAN_SHADER_TWINS_H */
