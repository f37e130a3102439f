#include "base/checked.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "neural/decoder.h"
#include "neural/slices.h"

#include <string.h>

static SluiceResult refuse(const SluiceNeuralDecodeInfo *info, const char *what, uint64_t value)
{
    return slc_log_refusal(&info->log, "%s of a decode is %llu, which does not fit", what,
                           (unsigned long long)value);
}

static SluiceResult refuse_span(const SluiceNeuralDecodeInfo *info, const char *what,
                                uint32_t first, uint32_t count, uint32_t limit)
{
    return slc_log_refusal(&info->log, "%s of a decode is %u from texel %u on; mip %u has %u", what,
                           count, first, info->mip, limit);
}

/* Checks the constants. sluiceReadNeuralLatents made them, but a file may have changed them. */
static SluiceResult check_constants(const SluiceNeuralDecodeInfo *info,
                                    const SluiceNeuralConstants *k)
{
    const uint32_t features[] = {k->highFeatures, k->lowFeatures};
    const uint32_t bits[] = {k->highBits, k->lowBits};
    bool is_one = k->schema == 1;
    if (!is_one && k->schema != 3)
        return refuse(info, "schema", k->schema);
    if (k->mipCount > SLUICE_NEURAL_MAX_MIPS || info->mip >= k->mipCount)
        return refuse(info, "mip", info->mip);
    if (k->inputCount != (is_one ? 32 + 4 * k->networkFeatures : 48) || k->networkFeatures > 16 ||
        k->networkFeatures % 4 || k->networkFeatures == 0)
        return refuse(info, "inputCount", k->inputCount);
    for (int i = 0; i < 2; i++) {
        bool is_power = bits[i] && bits[i] <= 8 && !(bits[i] & (bits[i] - 1));
        if (features[i] > 16 || features[i] % 4 || features[i] == 0 || !is_power ||
            (!is_one && (bits[i] != 4 || features[i] != features[0])))
            return refuse(info, "latent shape", features[i]);
    }
    if (is_one && k->highFeatures > k->networkFeatures)
        return refuse(info, "highFeatures", k->highFeatures);
    return SLUICE_SUCCESS;
}

static bool has_axis(uint32_t first, uint32_t last, uint32_t mip_size, uint32_t grid,
                     uint32_t origin, uint32_t size, bool is_clamped)
{
    int32_t end = (int32_t)grid - 1;
    int32_t from = slc_neural_corner(slc_neural_place(first, grid, mip_size));
    int32_t to = slc_neural_corner(slc_neural_place(last, grid, mip_size)) + 1;
    if (!is_clamped) {
        uint32_t start = (uint32_t)(from + (int32_t)(2 * grid) - (int32_t)origin) % grid;
        return size == grid || start + (uint32_t)(to - from) < size;
    }
    from = from < 0 ? 0 : from;
    to = to > end ? end : to;
    return from >= (int32_t)origin && to < (int32_t)(origin + size);
}

/* Checks that a slice is valid and covers the rectangle. */
static SluiceResult check_slice(const SluiceNeuralDecodeInfo *info,
                                const struct slc_neural_mip_view *view, uint32_t g)
{
    const SluiceNeuralConstants *k = view->constants;
    const SluiceNeuralSlice *s = &view->slices[g];
    uint32_t width = s->sliceSize & 0xFFFF, height = s->sliceSize >> 16;
    uint32_t grid_width = s->gridSize & 0xFFFF, grid_height = s->gridSize >> 16;
    uint32_t left = s->origin & 0xFFFF, top = s->origin >> 16;
    uint32_t bits = g ? k->lowFeatures * k->lowBits : k->highFeatures * k->highBits;
    uint64_t bytes = slc_neural_slice_bytes(width, height, bits);
    bool is_one = k->schema == 1;
    if (s->sliceSize == 0)
        return SLUICE_NOT_READY;
    if (grid_width == 0 || grid_height == 0 || grid_width > SLUICE_NEURAL_MAX_SIZE ||
        grid_height > SLUICE_NEURAL_MAX_SIZE)
        return refuse(info, "gridSize", s->gridSize);
    if (left >= grid_width || top >= grid_height || width > grid_width || height > grid_height)
        return refuse(info, "origin of a slice", s->origin);
    if (width == 0 || height == 0 || bytes > SLC_NEURAL_MAX_LATENTS || bytes > info->latentSize ||
        s->dataOffset > info->latentSize - bytes)
        return refuse(info, "latentSize", info->latentSize);
    if (!has_axis(info->x, info->x + info->width - 1, view->width, grid_width, left, width,
                  is_one) ||
        !has_axis(info->y, info->y + info->height - 1, view->height, grid_height, top, height,
                  is_one))
        return SLUICE_NOT_READY;
    return SLUICE_SUCCESS;
}

static SluiceResult make_view(const SluiceNeuralDecodeInfo *info, const SluiceNeuralConstants *k,
                              struct slc_neural_mip_view *view)
{
    *view = (struct slc_neural_mip_view){
        .constants = k,
        .mip = info->mip,
        .width = slc_mip_size(k->width, info->mip),
        .height = slc_mip_size(k->height, info->mip),
    };
    uint32_t first = k->mips[info->mip].firstSlice;
    if (k->width == 0 || k->width > SLUICE_NEURAL_MAX_SIZE)
        return refuse(info, "width of mip 0", k->width);
    if (k->height == 0 || k->height > SLUICE_NEURAL_MAX_SIZE)
        return refuse(info, "height of mip 0", k->height);
    if (info->width == 0 || info->x >= view->width || info->width > view->width - info->x)
        return refuse_span(info, "width", info->x, info->width, view->width);
    if (info->height == 0 || info->y >= view->height || info->height > view->height - info->y)
        return refuse_span(info, "height", info->y, info->height, view->height);
    if (first > SLC_NEURAL_MAX_GRIDS - 2)
        return refuse(info, "firstSlice", first);
    if (!(k->mips[info->mip].positionScale > 0 && k->mips[info->mip].positionScale <= 65536))
        return refuse(info, "positionScale of mip", info->mip);
    for (uint32_t g = 0; g < 2; g++) {
        view->slices[g] = k->slices[first + g];
        view->codes[g] = (const uint8_t *)info->pLatents + view->slices[g].dataOffset;
        SluiceResult result = check_slice(info, view, g);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return SLUICE_SUCCESS;
}

static SluiceResult check_output(const SluiceNeuralDecodeInfo *info, uint64_t blob_size)
{
    uint64_t row = (uint64_t)info->width * info->channelCount;
    if (info->weightKind != SLUICE_NEURAL_WEIGHTS_INT8 &&
        info->weightKind != SLUICE_NEURAL_WEIGHTS_FP8)
        return refuse(info, "weightKind", (uint64_t)info->weightKind);
    if (info->weightSize < blob_size)
        return refuse(info, "weightSize", info->weightSize);
    if (info->channelCount == 0 || info->channelCount > SLUICE_NEURAL_MAX_CHANNELS ||
        info->firstChannel > SLUICE_NEURAL_MAX_CHANNELS - info->channelCount)
        return refuse(info, "channelCount", info->channelCount);
    if (info->rowPitch && info->rowPitch < row)
        return refuse(info, "rowPitch", info->rowPitch);
    return SLUICE_SUCCESS;
}

void slc_neural_decode_plainly(const struct slc_neural_job *job)
{
    const struct slc_neural_blob at = slc_neural_blob_of(job->shape, job->kind);
    for (uint32_t i = 0; i < job->width * job->height; i++) {
        const uint32_t x = i % job->width, y = i / job->width;
        float floats[SLC_NEURAL_MAX_INPUTS], outputs[SLUICE_NEURAL_MAX_CHANNELS];
        int8_t codes[SLC_NEURAL_MAX_INPUTS];
        if (job->kind == SLUICE_NEURAL_WEIGHTS_INT8) {
            slc_neural_int8_inputs(job->view, job->x + x, job->y + y, codes);
            slc_neural_run_int8(job->shape, &at, job->weights, codes, outputs);
        } else {
            slc_neural_fp8_inputs(job->view, job->x + x, job->y + y, floats);
            slc_neural_run_fp8(job->shape, &at, job->weights, floats, outputs);
        }
        memcpy(job->texels + y * job->pitch + (size_t)x * job->channel_count,
               outputs + job->first_channel, job->channel_count * sizeof *outputs);
    }
}

slc_neural_way *slc_neural_fastest_way(void)
{
#ifdef SLC_HAVE_AVX2
    if (__builtin_cpu_supports("avx2"))
        return slc_neural_decode_strips_avx2;
#endif
    return slc_neural_decode_strips;
}

SluiceResult slc_neural_decode(const SluiceNeuralDecodeInfo *pInfo, slc_neural_way *way)
{
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralDecodeInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralDecodeInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info.pConstants || !info.pLatents || !info.pWeights || !info.pTexels)
        return SLUICE_ERROR_NULL_POINTER;
    struct slc_neural_mip_view view;
    SluiceNeuralConstants constants = *info.pConstants;
    result = check_constants(&info, &constants);
    if (result == SLUICE_SUCCESS)
        result = make_view(&info, &constants, &view);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_neural_shape shape = slc_neural_shape_of(
        constants.schema == 3 ? SLUICE_NEURAL_NETWORK_SCHEMA3
                              : (SluiceNeuralNetwork)(constants.networkFeatures / 4 - 1));
    struct slc_neural_blob at = slc_neural_blob_of(&shape, info.weightKind);
    result = check_output(&info, at.size);
    if (result == SLUICE_SUCCESS &&
        !slc_neural_blob_is_sound(&shape, info.weightKind, info.pWeights))
        return slc_log_refusal(&info.log, "weights of a decode are no numbers, or beyond 2^63");
    if (result != SLUICE_SUCCESS)
        return result;
    const uint64_t row = (uint64_t)info.width * info.channelCount;
    way(&(struct slc_neural_job){.view = &view,
                                 .shape = &shape,
                                 .kind = info.weightKind,
                                 .weights = info.pWeights,
                                 .x = info.x,
                                 .y = info.y,
                                 .width = info.width,
                                 .height = info.height,
                                 .first_channel = info.firstChannel,
                                 .channel_count = info.channelCount,
                                 .texels = info.pTexels,
                                 .pitch = info.rowPitch ? info.rowPitch : row});
    return SLUICE_SUCCESS;
}

SluiceResult sluiceDecodeNeuralTexels(const SluiceNeuralDecodeInfo *pInfo)
{
    return slc_neural_decode(pInfo, slc_neural_fastest_way());
}
