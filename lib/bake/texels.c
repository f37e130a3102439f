#include "bake/texels.h"

#include "base/checked.h"
#include "image/convert.h"
#include "image/format_size.h"
#include "image/half.h"
#include "image/srgb.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Weight of colors with alpha 0. */
#define LEAST_WEIGHT 0x1p-24f
/* Least divisor if alpha may ring. */
#define LEAST_RINGING 0x1p-10f
#define CHUNK 256u

uint32_t slc_sample_size(enum slc_sample sample)
{
    return sample == SLC_SAMPLE_U8 ? 1 : sample == SLC_SAMPLE_F32 ? 4 : 2;
}

/* Decodes by the curve of IEC 61966-2-1. */
void slc_decode_srgb16(float *values)
{
    for (uint32_t i = 0; i < 65536; i++) {
        double v = i / 65535.0;
        values[i] = (float)(v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4));
    }
}

static float sample_value(const struct slc_rules *rules, const char *sample)
{
    uint16_t word;
    float value;
    switch (rules->sample) {
    case SLC_SAMPLE_U8: return (float)*(const uint8_t *)sample / 255.0f;
    case SLC_SAMPLE_U16: memcpy(&word, sample, 2); return (float)word / 65535.0f;
    case SLC_SAMPLE_F16: memcpy(&word, sample, 2); return slc_float_from_half(word);
    default: memcpy(&value, sample, 4); return value;
    }
}

/* Decodes sRGB, also values above 1. */
static float decode_float(float value)
{
    if (value <= 0.04045f)
        return value / 12.92f;
    float decoded = powf((value + 0.055f) / 1.055f, 2.4f);
    return isinf(decoded) && isfinite(value) ? FLT_MAX : decoded;
}

/* Returns the decoded value of a sample of R, G or B. */
static float color_value(const struct slc_rules *rules, const char *sample)
{
    uint16_t word;
    if (!rules->srgb)
        return sample_value(rules, sample);
    if (rules->sample == SLC_SAMPLE_U8)
        return slc_srgb_to_linear[*(const uint8_t *)sample];
    if (rules->sample == SLC_SAMPLE_U16) {
        memcpy(&word, sample, 2);
        return rules->decoded16[word];
    }
    return decode_float(sample_value(rules, sample));
}

/* Converts samples to RGBA floats. Gray becomes R, G and B. */
static void expand(const struct slc_rules *rules, const char *samples, float *rgba, uint32_t count)
{
    uint32_t size = slc_sample_size(rules->sample), channels = rules->channels;
    uint32_t colors = rules->alpha ? channels - 1 : channels;
    for (uint32_t i = 0; i < count; i++, samples += size * channels, rgba += 4) {
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] = c < colors ? color_value(rules, samples + c * size)
                                 : (colors == 1 ? rgba[0] : 0.0f);
        rgba[3] = rules->alpha ? sample_value(rules, samples + (channels - 1) * size) : 1.0f;
    }
}

static void expand_texels(const struct slc_rules *rules, const void *texels, float *rgba,
                          uint32_t count)
{
    slc_texels_to_rgba(rules->texels, texels, rgba, count);
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        if (rules->channels == 1)
            rgba[1] = rgba[2] = rgba[0];
        for (uint32_t c = 0; c < 3 && rules->srgb; c++)
            rgba[c] = decode_float(rgba[c]);
    }
}

/* Expands 8-bit sRGB, the usual picture, without a branch per sample. */
static void expand_srgb8(const uint8_t *samples, uint32_t channels, float *rgba, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, samples += channels, rgba += 4) {
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] = slc_srgb_to_linear[samples[c]];
        rgba[3] = channels == 4 ? (float)samples[3] * (1.0f / 255.0f) : 1.0f;
    }
}

/* Replaces NaN, infinities and values beyond the limit. Returns true if a channel was changed. */
static bool replace_texel(const struct slc_rules *rules, float rgba[4],
                          struct slc_replaced *replaced)
{
    bool has_nan = false, has_infinity = false, is_beyond = false;
    for (uint32_t c = 0; c < 4; c++) {
        if (isnan(rgba[c])) {
            rgba[c] = 0.0f;
            has_nan = true;
        } else if (isinf(rgba[c])) {
            rgba[c] = copysignf(rules->infinity, rgba[c]);
            has_infinity = true;
        } else if (fabsf(rgba[c]) > rules->limit) {
            rgba[c] = copysignf(rules->limit, rgba[c]);
            is_beyond = true;
        }
    }
    replaced->nan += has_nan;
    replaced->infinite += has_infinity;
    replaced->clamped += is_beyond;
    return has_nan || has_infinity || is_beyond;
}

static void replace_texels(const struct slc_rules *rules, float *rgba, uint32_t count,
                           struct slc_replaced *replaced)
{
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        bool is_fine = true;
        for (uint32_t c = 0; c < 4; c++)
            is_fine &= fabsf(rgba[c]) <= rules->limit;
        if (!is_fine)
            replaced->texels += replace_texel(rules, rgba, replaced);
    }
}

static void weigh_by_alpha(float *rgba, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        rgba[3] = rgba[3] > 0.0f ? fminf(rgba[3], 1.0f) : 0.0f;
        float weight = rgba[3] + LEAST_WEIGHT;
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] *= weight;
    }
}

static bool is_unorm(SluiceFormat format)
{
    return format == SLUICE_FORMAT_R8_UNORM || format == SLUICE_FORMAT_R8G8_UNORM ||
           format == SLUICE_FORMAT_R8G8B8A8_UNORM ||
           format == SLUICE_FORMAT_A2B10G10R10_UNORM_PACK32 || slc_format_is_unorm16(format);
}

/* Tells whether samples of normal maps are (n + 1) / 2: numbers without sign. */
static bool has_encoded_normals(const struct slc_rules *rules)
{
    return rules->sample == SLC_SAMPLE_U8 || rules->sample == SLC_SAMPLE_U16 ||
           (rules->sample == SLC_SAMPLE_TEXELS && is_unorm(rules->texels));
}

static void point_normals(const struct slc_rules *rules, float *rgba, uint32_t count)
{
    bool is_encoded = has_encoded_normals(rules);
    bool is_flat = rules->channels - rules->alpha == 2;
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        for (uint32_t c = 0; c < 3 && is_encoded; c++)
            rgba[c] = 2.0f * rgba[c] - 1.0f;
        if (is_flat)
            rgba[2] = sqrtf(fmaxf(0.0f, 1.0f - rgba[0] * rgba[0] - rgba[1] * rgba[1]));
    }
}

static bool may_be_infinite(const struct slc_rules *rules)
{
    return rules->sample == SLC_SAMPLE_F16 || rules->sample == SLC_SAMPLE_F32 ||
           (rules->sample == SLC_SAMPLE_TEXELS &&
            rules->texels == SLUICE_FORMAT_B10G11R11_UFLOAT_PACK32);
}

void slc_read_texels(const struct slc_rules *rules, const void *samples, float *rgba,
                     uint32_t count, struct slc_replaced *replaced)
{
    if (rules->sample == SLC_SAMPLE_U8 && rules->srgb && rules->channels >= 3)
        expand_srgb8(samples, rules->channels, rgba, count);
    else if (rules->sample == SLC_SAMPLE_TEXELS)
        expand_texels(rules, samples, rgba, count);
    else
        expand(rules, samples, rgba, count);
    if (may_be_infinite(rules))
        replace_texels(rules, rgba, count, replaced);
    if (rules->normals)
        point_normals(rules, rgba, count);
    if (rules->straight)
        weigh_by_alpha(rgba, count);
}

static void unweigh(const struct slc_rules *rules, float *rgba, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        float weight = rgba[3] + LEAST_WEIGHT;
        if (rules->rings)
            weight = fmaxf(weight, LEAST_RINGING);
        float factor = 1.0f / weight;
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] *= factor;
    }
}

static void normalize(const struct slc_rules *rules, float *rgba, uint32_t count)
{
    /* Float formats keep the picture's encoding of normals. */
    bool is_encoded = is_unorm(rules->format) ||
                      (has_encoded_normals(rules) && !slc_format_is_snorm(rules->format));
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        double x = (double)rgba[0], y = (double)rgba[1], z = (double)rgba[2];
        double length = sqrt(x * x + y * y + z * z); /* no overflow in double */
        double factor = length > 1e-6 ? 1.0 / length : 0.0;
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] = (float)((double)rgba[c] * factor);
        if (factor == 0.0)
            rgba[2] = 1.0f;
        for (uint32_t c = 0; c < 3 && is_encoded; c++)
            rgba[c] = 0.5f * rgba[c] + 0.5f;
    }
}

static void scale_alpha(const struct slc_rules *rules, float scale, float *rgba, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++, rgba += 4) {
        float alpha = fminf(rgba[3] * scale, 1.0f);
        float factor = rgba[3] > 0.0f && !rules->straight ? alpha / rgba[3] : 1.0f;
        for (uint32_t c = 0; c < 3; c++)
            rgba[c] *= factor;
        rgba[3] = alpha;
    }
}

/* Clamps to finite floats. Division by alpha and scaling can exceed FLT_MAX by the last bit. */
static void stay_finite(float *rgba, uint32_t count)
{
    for (uint32_t i = 0; i < 4 * count; i++)
        rgba[i] = fminf(fmaxf(rgba[i], -FLT_MAX), FLT_MAX);
}

static void write_chunk(const struct slc_rules *rules, const float *rgba, float alpha_scale,
                        void *texels, uint32_t count)
{
    float own[4 * CHUNK];
    if (rules->straight || rules->normals || alpha_scale != 1.0f) {
        memcpy(own, rgba, 4 * count * sizeof(float));
        rgba = own;
        if (rules->straight)
            unweigh(rules, own, count);
        if (rules->normals)
            normalize(rules, own, count);
        if (alpha_scale != 1.0f)
            scale_alpha(rules, alpha_scale, own, count);
        if (rules->sample == SLC_SAMPLE_F32)
            stay_finite(own, count);
    }
    slc_texels_from_rgba(rules->format, rgba, texels, count);
}

void slc_write_texels(const struct slc_rules *rules, const float *rgba, float alpha_scale,
                      void *texels, uint32_t count)
{
    size_t texel_size = sluiceGetFormatTexelSize(rules->format);
    for (uint32_t i = 0; i < count; i += CHUNK)
        write_chunk(rules, rgba + 4 * (size_t)i, alpha_scale, (char *)texels + i * texel_size,
                    slc_min_u32(CHUNK, count - i));
}

static bool keeps_words(const struct slc_rules *rules)
{
    switch (rules->format) {
    case SLUICE_FORMAT_R16_UNORM: return rules->channels == 1;
    case SLUICE_FORMAT_R16G16_UNORM:
        return rules->channels == 2 && !rules->alpha && !rules->normals;
    case SLUICE_FORMAT_R16G16B16A16_UNORM: return rules->channels >= 3;
    default: return false;
    }
}

bool slc_keeps_samples(const struct slc_rules *rules)
{
    if (rules->sample == SLC_SAMPLE_U16)
        return !rules->srgb && keeps_words(rules);
    if (rules->sample == SLC_SAMPLE_TEXELS)
        return !rules->srgb && rules->format == rules->texels && !may_be_infinite(rules);
    if (rules->sample != SLC_SAMPLE_U8)
        return false;
    switch (rules->format) {
    case SLUICE_FORMAT_R8_UNORM: return rules->channels == 1 && !rules->srgb;
    case SLUICE_FORMAT_R8G8_UNORM:
        return rules->channels == 2 && !rules->alpha && !rules->srgb && !rules->normals;
    case SLUICE_FORMAT_R8G8B8A8_UNORM: return rules->channels >= 3 && !rules->srgb;
    case SLUICE_FORMAT_R8G8B8A8_SRGB: return rules->channels >= 3 && rules->srgb;
    default: return false;
    }
}

void slc_copy_samples(const struct slc_rules *rules, const void *samples, void *texels,
                      uint32_t count)
{
    const uint8_t *in = samples;
    uint8_t *out = texels;
    size_t size = slc_sample_size(rules->sample);
    if (rules->sample == SLC_SAMPLE_TEXELS) {
        memcpy(out, in, (size_t)count * sluiceGetFormatTexelSize(rules->texels));
        return;
    }
    if (rules->channels != 3) {
        memcpy(out, in, (size_t)count * rules->channels * size);
        return;
    }
    for (uint32_t i = 0; i < count; i++, in += 3 * size, out += 4 * size) {
        memcpy(out, in, 3 * size);
        memset(out + 3 * size, 255, size);
    }
}
