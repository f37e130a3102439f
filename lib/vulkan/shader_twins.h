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

#include <sluice/shared/texture_table.h>

/* stochastic.glsl */

static inline uint32_t slc_twin_hash(uint32_t x, uint32_t y, uint32_t z)
{
    uint32_t h = (x * 0x9E3779B1u) ^ (y * 0x85EBCA77u) ^ (z * 0xC2B2AE3Du);
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    return h ^ (h >> 15);
}

static inline bool slc_twin_select_random_quad(uint32_t x, uint32_t y, uint32_t frame_seed,
                                               float probability)
{
    if (probability >= 1.0f)
        return true;
    float draw = (float)(slc_twin_hash(x >> 1, y >> 1, frame_seed) >> 8) * (1.0f / 16777216.0f);
    return draw < probability;
}

static inline bool slc_twin_select_lattice(uint32_t pixel_x, uint32_t pixel_y, uint32_t frame_index)
{
    uint32_t f = frame_index & 63;
    uint32_t x = (f & 1) << 2 | (f & 4) >> 1 | (f & 16) >> 4;
    uint32_t y = (f & 2) << 1 | (f & 8) >> 2 | (f & 32) >> 5;
    return (pixel_x & 7) == (x ^ y) && (pixel_y & 7) == y;
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

#define SLC_TWIN_FOOTPRINT_STEPS_LOG2 6

/* From the first to the second; where the third is another, on from 0 to the third. */
struct slc_twin_footprint {
    uint32_t x[3], y[3];
};

static inline uint32_t slc_twin_region_index(float coordinate, float regions_per_unit,
                                             uint32_t region_count)
{
    float at = coordinate > 0.0f ? fminf(coordinate, 1.0f) * regions_per_unit : 0.0f;
    uint32_t index = (uint32_t)at;
    return index < region_count - 1 ? index : region_count - 1;
}

static inline void slc_twin_region_range(float coordinate, float below, float above,
                                         uint32_t address_mode, float regions_per_unit,
                                         uint32_t region_count, uint32_t out[3])
{
    if (address_mode == SLUICE_ADDRESS_MODE_REPEAT) {
        below = below < 0.5f ? below : 0.5f;
        above = above < 0.5f ? above : 0.5f;
        float middle = coordinate - floorf(coordinate);
        middle = middle >= 0.0f ? fminf(middle, 1.0f) : 0.0f;
        float low = middle - below, high = middle + above;
        bool wraps = low < 0.0f || high >= 1.0f;
        out[0] =
            slc_twin_region_index(low < 0.0f ? low + 1.0f : low, regions_per_unit, region_count);
        out[2] = slc_twin_region_index(high >= 1.0f ? high - 1.0f : high, regions_per_unit,
                                       region_count);
        out[1] = wraps ? region_count - 1 : out[2];
        if (wraps && out[2] == region_count - 1)
            out[0] = 0;
        return;
    }
    float middle = coordinate;
    if (address_mode == SLUICE_ADDRESS_MODE_MIRRORED_REPEAT) {
        middle = coordinate - 2.0f * floorf(coordinate * 0.5f);
        middle = middle > 1.0f ? 2.0f - middle : middle;
        below = above = fmaxf(below, above);
    } else if (address_mode == SLUICE_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE) {
        middle = fabsf(coordinate);
        below = above = fmaxf(below, above);
    }
    out[0] = slc_twin_region_index(middle - below, regions_per_unit, region_count);
    out[1] = slc_twin_region_index(middle + above, regions_per_unit, region_count);
    out[1] = out[1] > out[0] ? out[1] : out[0]; /* NaN */
    out[2] = out[1];
}

static inline struct slc_twin_footprint
slc_twin_compute_footprint(const struct SluiceTextureEntry *entry, struct slc_twin_vec2 uv,
                           struct slc_twin_vec2 half_box, uint32_t coarsest_level)
{
    float below =
        entry->flags & SLUICE_TEXTURE_FLAG_UNEVEN ? SLC_TWIN_APRON_UNEVEN : SLC_TWIN_APRON;
    uint32_t width = entry->width >> coarsest_level, height = entry->height >> coarsest_level;
    float texel_x = 1.0f / (float)(width ? width : 1);
    float texel_y = 1.0f / (float)(height ? height : 1);
    struct slc_twin_footprint footprint;
    slc_twin_region_range(uv.x, below * texel_x + half_box.x, SLC_TWIN_APRON * texel_x + half_box.x,
                          entry->addressModeU, (float)entry->width / (float)entry->regionWidth,
                          entry->regionCountX, footprint.x);
    slc_twin_region_range(uv.y, below * texel_y + half_box.y, SLC_TWIN_APRON * texel_y + half_box.y,
                          entry->addressModeV, (float)entry->height / (float)entry->regionHeight,
                          entry->regionCountY, footprint.y);
    return footprint;
}

static inline struct slc_twin_vec2 slc_twin_half_box(struct slc_twin_vec2 dx,
                                                     struct slc_twin_vec2 dy, float lod_bias,
                                                     float max_anisotropy)
{
    if (!(max_anisotropy > 1.0f))
        return (struct slc_twin_vec2){0.0f, 0.0f};
    float scale = lod_bias > 0.0f ? exp2f(fminf(lod_bias, SLC_TWIN_LOD_LIMIT)) : 1.0f;
    return (struct slc_twin_vec2){0.5f * scale * sqrtf(dx.x * dx.x + dy.x * dy.x),
                                  0.5f * scale * sqrtf(dx.y * dx.y + dy.y * dy.y)};
}

static inline bool slc_twin_footprint_is_one_region(const struct slc_twin_footprint *f)
{
    return f->x[0] == f->x[1] && f->x[0] == f->x[2] && f->y[0] == f->y[1] && f->y[0] == f->y[2];
}

static inline uint32_t slc_twin_range_shift(const uint32_t range[3], uint32_t level)
{
    uint32_t distance = range[1] - range[0] + (range[2] == range[1] ? 0 : range[2]);
    uint32_t bits = 0;
    while (bits < 32 && distance >> bits)
        bits++;
    uint32_t shift =
        bits > SLC_TWIN_FOOTPRINT_STEPS_LOG2 ? bits - SLC_TWIN_FOOTPRINT_STEPS_LOG2 : 0;
    return level > shift ? level : shift;
}

static inline uint32_t slc_twin_count_steps(uint32_t distance, uint32_t shift)
{
    return ((distance + (1u << shift) - 1) >> shift) + 1;
}

static inline uint32_t slc_twin_range_steps(const uint32_t range[3], uint32_t level)
{
    uint32_t shift = slc_twin_range_shift(range, level);
    uint32_t count = slc_twin_count_steps(range[1] - range[0], shift);
    return range[2] == range[1] ? count : count + slc_twin_count_steps(range[2], shift);
}

static inline uint32_t slc_twin_range_region(const uint32_t range[3], uint32_t level, uint32_t i)
{
    uint32_t shift = slc_twin_range_shift(range, level);
    uint32_t count = slc_twin_count_steps(range[1] - range[0], shift);
    uint32_t at = i < count ? range[0] + (i << shift) : (i - count) << shift;
    uint32_t end = i < count ? range[1] : range[2];
    return at < end ? at : end;
}

/* feedback.glsl: what one sample marks */

struct slc_twin_wants {
    uint32_t level;
    struct slc_twin_footprint regions;
    uint32_t wide_level; /* of wide_regions, UINT32_MAX where nothing more is marked */
    struct slc_twin_footprint wide_regions;
};

static inline struct slc_twin_wants slc_twin_wants(const struct SluiceTextureEntry *entry,
                                                   struct slc_twin_vec2 uv, struct slc_twin_vec2 dx,
                                                   struct slc_twin_vec2 dy, float lod_bias,
                                                   float max_anisotropy)
{
    float w = (float)entry->width, h = (float)entry->height;
    struct slc_twin_vec2 tx = {dx.x * w, dx.y * h}, ty = {dy.x * w, dy.y * h};
    struct slc_twin_vec2 lods = {SLC_TWIN_LOD_LIMIT, SLC_TWIN_LOD_LIMIT};
    if (slc_twin_is_finite(uv))
        lods = slc_twin_compute_lods(tx, ty, lod_bias, max_anisotropy);
    struct slc_twin_wants wants;
    wants.level =
        slc_twin_finest_level(lods.x, slc_twin_lod_margin(max_anisotropy), entry->mipLevelCount);
    uint32_t coarsest = slc_twin_coarsest_level(lods.y, entry->mipLevelCount);
    struct slc_twin_vec2 half_box = slc_twin_half_box(dx, dy, lod_bias, max_anisotropy);
    wants.regions = slc_twin_compute_footprint(entry, uv, half_box, coarsest);
    wants.wide_level = UINT32_MAX;
    wants.wide_regions = wants.regions;
    if (!(max_anisotropy > 1.0f))
        return wants;
    uint32_t widest = slc_twin_coarsest_level(slc_twin_compute_lods(tx, ty, lod_bias, 1.0f).y,
                                              entry->mipLevelCount);
    if (widest > coarsest) {
        wants.wide_level = coarsest + 1;
        wants.wide_regions = slc_twin_compute_footprint(entry, uv, half_box, widest);
    }
    return wants;
}

#endif /* SLC_VULKAN_SHADER_TWINS_H */
