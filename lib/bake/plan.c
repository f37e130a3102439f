#include "bake/plan.h"

#include "bake/blocks.h"
#include "base/checked.h"
#include "base/limits.h"
#include "base/log.h"
#include "image/format_size.h"

#include <float.h>
#include <math.h>

#define HALF_LIMIT 65504.0f
#define FLOAT_INFINITY 0x1p120f /* a few of them sum to a finite float in a filter */

SluiceResult slc_check_settings(const SluiceBakeSettings *s, const SluiceLogCallback *log)
{
    const struct slc_limit limits[] = {
        {"format", (uint32_t)s->format, 0, SLUICE_FORMAT_COUNT - 1},
        {"quality", (uint32_t)s->quality, 0, SLUICE_BAKE_QUALITY_BEST},
        {"transfer", (uint32_t)s->transfer, 0, SLUICE_BAKE_TRANSFER_LINEAR},
        {"alpha", (uint32_t)s->alpha, 0, SLUICE_BAKE_ALPHA_PREMULTIPLIED},
        {"filter", (uint32_t)s->filter, 0, SLUICE_BAKE_FILTER_KAISER},
        {"wrapX", (uint32_t)s->wrapX, 0, SLUICE_BAKE_WRAP_MIRROR},
        {"wrapY", (uint32_t)s->wrapY, 0, SLUICE_BAKE_WRAP_MIRROR},
        {"compressionLevel", s->compressionLevel, 0, SLUICE_STORE_MAX_COMPRESSION_LEVEL},
    };
    SluiceResult result = slc_check_limits(log, limits, sizeof limits / sizeof limits[0]);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!(s->cutout >= 0.0f && s->cutout <= 1.0f))
        return slc_log_refusal(log, "cutout is %g; it must be from 0 to 1", (double)s->cutout);
    if (s->normalMap && s->transfer == SLUICE_BAKE_TRANSFER_SRGB)
        return slc_log_refusal(log, "transfer is SRGB; with normalMap it must be AUTO or LINEAR");
    return SLUICE_SUCCESS;
}

static SluiceFormat byte_format(const struct slc_picture *picture, bool normals)
{
    if (normals || picture->channels > 2 || picture->alpha)
        return SLUICE_FORMAT_R8G8B8A8_UNORM;
    return picture->channels == 1 ? SLUICE_FORMAT_R8_UNORM : SLUICE_FORMAT_R8G8_UNORM;
}

static SluiceFormat word_format(const struct slc_picture *picture, bool normals)
{
    if (normals || picture->channels > 2 || picture->alpha)
        return SLUICE_FORMAT_R16G16B16A16_UNORM;
    return picture->channels == 1 ? SLUICE_FORMAT_R16_UNORM : SLUICE_FORMAT_R16G16_UNORM;
}

static SluiceFormat natural_format(const struct slc_picture *picture, bool normals, bool srgb)
{
    bool is_single = picture->channels == 1;
    bool is_pair = picture->channels == 2 && !picture->alpha && !normals;
    bool is_half = picture->sample == SLC_SAMPLE_F16 || picture->halves_suffice;
    if (picture->sample == SLC_SAMPLE_U8)
        return is_single && srgb ? SLUICE_FORMAT_R8G8B8A8_UNORM : byte_format(picture, normals);
    if (picture->sample == SLC_SAMPLE_U16)
        return word_format(picture, normals);
    if (picture->sample == SLC_SAMPLE_TEXELS)
        return picture->texels;
    if (is_half)
        return is_single ? SLUICE_FORMAT_R16_SFLOAT
               : is_pair ? SLUICE_FORMAT_R16G16_SFLOAT
                         : SLUICE_FORMAT_R16G16B16A16_SFLOAT;
    return is_single ? SLUICE_FORMAT_R32_SFLOAT
           : is_pair ? SLUICE_FORMAT_R32G32_SFLOAT
                     : SLUICE_FORMAT_R32G32B32A32_SFLOAT;
}

/* Returns the format of texels in memory: `format`, or the encoder's input for blocks. */
static SluiceFormat texel_format(SluiceFormat format, bool srgb)
{
    SluiceFormatInfo info = {.structSize = sizeof info};
    if (sluiceGetFormatInfo(format, &info) != SLUICE_SUCCESS || !slc_format_is_compressed(&info))
        return format;
    return slc_format_twin(slc_block_texel_format(format),
                           srgb && slc_format_has_srgb_twin(format));
}

static bool is_float32(SluiceFormat format)
{
    return format == SLUICE_FORMAT_R32_SFLOAT || format == SLUICE_FORMAT_R32G32_SFLOAT ||
           format == SLUICE_FORMAT_R32G32B32A32_SFLOAT;
}

/* Tells whether samples are signed. Signed numbers are data; their fourth channel is not coverage.
 */
static bool is_signed(const struct slc_picture *picture)
{
    return picture->sample == SLC_SAMPLE_TEXELS && slc_format_is_snorm(picture->texels);
}

static void find_rules(const struct slc_picture *picture, struct slc_plan *plan)
{
    const SluiceBakeSettings *settings = &plan->settings;
    struct slc_rules *rules = &plan->rules;
    SluiceFormatInfo info = {.structSize = sizeof info};
    (void)sluiceGetFormatInfo(plan->format, &info);
    bool is_straight = settings->alpha == SLUICE_BAKE_ALPHA_AUTO
                           ? !picture->premultiplied && !is_signed(picture)
                           : settings->alpha == SLUICE_BAKE_ALPHA_STRAIGHT;
    rules->sample = picture->sample;
    rules->texels = picture->texels;
    rules->channels = picture->channels;
    rules->alpha = picture->alpha;
    rules->straight = picture->alpha && info.channelCount == 4 && is_straight;
    rules->normals = settings->normalMap;
    rules->rings = settings->filter != SLUICE_BAKE_FILTER_BOX;
    rules->format = texel_format(plan->format, rules->srgb);
    rules->limit = is_float32(rules->format) ? FLT_MAX : HALF_LIMIT;
    rules->infinity = is_float32(rules->format) ? FLOAT_INFINITY : HALF_LIMIT;
}

static void find_meaning(const struct slc_picture *picture, struct slc_plan *plan)
{
    const struct slc_rules *rules = &plan->rules;
    bool is_data =
        picture->channels == 1 || (picture->channels == 2 && !picture->alpha) || is_signed(picture);
    if (rules->normals)
        plan->meaning = SLUICE_STORE_MEANING_NORMAL;
    else if (is_data && !rules->srgb)
        plan->meaning = SLUICE_STORE_MEANING_DATA;
    else if (!picture->alpha)
        plan->meaning = SLUICE_STORE_MEANING_COLOR;
    else
        plan->meaning = rules->straight ? SLUICE_STORE_MEANING_COLOR_ALPHA
                                        : SLUICE_STORE_MEANING_COLOR_PREMULTIPLIED;
    if (plan->meaning == SLUICE_STORE_MEANING_NORMAL ||
        plan->meaning == SLUICE_STORE_MEANING_DATA || picture->foreign_primaries)
        plan->color_space = SLUICE_STORE_COLOR_SPACE_UNDEFINED;
    else if (rules->srgb && slc_format_has_srgb_twin(plan->format))
        plan->color_space = SLUICE_STORE_COLOR_SPACE_SRGB;
    else
        plan->color_space = SLUICE_STORE_COLOR_SPACE_LINEAR_SRGB;
}

/* Returns the least alpha that reaches the cut-out's threshold after rounding. */
static float find_threshold(const struct slc_plan *plan)
{
    float cutout = plan->settings.cutout;
    bool is_bytes = sluiceGetFormatTexelSize(plan->rules.format) == 4 &&
                    slc_format_has_srgb_twin(plan->rules.format);
    if (!plan->rules.alpha || cutout == 0.0f || !is_bytes)
        return plan->rules.alpha ? cutout : 0.0f;
    return (ceilf(cutout * 255.0f) - 0.5f) / 255.0f;
}

SluiceResult slc_plan_make(const struct slc_picture *picture, const SluiceBakeSettings *settings,
                           const float *decoded16, struct slc_plan *plan)
{
    *plan = (struct slc_plan){.settings = *settings};
    plan->rules.decoded16 = decoded16;
    bool srgb = settings->transfer == SLUICE_BAKE_TRANSFER_AUTO
                    ? picture->srgb && !settings->normalMap
                    : settings->transfer == SLUICE_BAKE_TRANSFER_SRGB;
    SluiceFormat format = settings->format;
    if (format == SLUICE_FORMAT_UNDEFINED)
        format = natural_format(picture, settings->normalMap, srgb);
    plan->rules.srgb = srgb;
    plan->format = slc_format_twin(format, srgb);
    if (sluiceGetFormatTexelSize(plan->format) == 0 && !slc_can_encode_blocks(plan->format)) {
        slc_log(&picture->log, SLUICE_LOG_ERROR, "%s: this build cannot encode %s%s", picture->name,
                sluiceGetFormatName(plan->format), slc_block_encoder_hint(plan->format));
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (slc_format_is_integer(plan->format)) {
        slc_log(&picture->log, SLUICE_LOG_ERROR,
                "%s: format is %s; integer formats are made from integer pictures alone",
                picture->name, sluiceGetFormatName(plan->format));
        return SLUICE_ERROR_UNSUPPORTED;
    }
    find_rules(picture, plan);
    find_meaning(picture, plan);
    plan->level_count = slc_mip_count(slc_max_u32(picture->width, picture->height));
    plan->reaches_around =
        settings->filter != SLUICE_BAKE_FILTER_BOX && settings->wrapY == SLUICE_BAKE_WRAP_REPEAT;
    plan->threshold = find_threshold(plan);
    return SLUICE_SUCCESS;
}
