#include "base/log.h"
#include "base/struct_size.h"
#include "neural_vulkan/cooperative.h"

#include <sluice/neural_paths.h>

#include <string.h>

/* Layout for neural_vector.glsl: four offsets of matrices, then unchanged scales and biases. */
enum { HEAD = 64, ALIGNMENT = 64, LAST = SLUICE_NEURAL_LAYERS - 1 };

struct conversion {
    const SluiceNeuralConvertInfo *info;
    slc_convert_matrix convert;
    uint32_t sizes[SLUICE_NEURAL_LAYERS + 1]; ///< neurons
    uint64_t matrix_size, number_size;        ///< bytes in the source
};

static bool find_sizes(const SluiceNeuralConvertInfo *info, struct conversion *c)
{
    const uint32_t in = info->pConstants->inputCount;
    const bool third = info->pConstants->schema == 3;
    const uint32_t sizes[] = {in, 64, third ? 48 : 64, third ? 32 : 64, 16};
    if (third ? in != 48 : info->pConstants->schema != 1 || in < 48 || in > 96 || in % 16)
        return false;
    memcpy(c->sizes, sizes, sizeof sizes);
    for (int i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        bool is_half = info->weightKind == SLUICE_NEURAL_WEIGHTS_FP8 && i < LAST;
        c->matrix_size += (uint64_t)sizes[i] * sizes[i + 1];
        c->number_size += sizes[i + 1] * (is_half ? UINT64_C(2) : UINT64_C(8));
    }
    return true;
}

/* Converts a layer, or asks for its size where `to` is NULL. */
static VkResult convert_layer(const struct conversion *c, int layer, const uint8_t *from,
                              uint8_t *to, size_t *size)
{
    uint32_t columns = c->sizes[layer], rows = c->sizes[layer + 1];
    int32_t type = c->info->weightKind == SLUICE_NEURAL_WEIGHTS_FP8 && layer < LAST
                       ? SLC_COMPONENT_E4M3
                       : SLC_COMPONENT_SINT8;
    struct slc_convert_info info = {.sType = (VkStructureType)SLC_CONVERT_INFO,
                                    .srcSize = (size_t)columns * rows,
                                    .srcData.hostAddress = to ? from : NULL,
                                    .pDstSize = size,
                                    .dstData.hostAddress = to,
                                    .srcComponentType = type,
                                    .dstComponentType = type,
                                    .numRows = rows,
                                    .numColumns = columns,
                                    .srcLayout = SLC_LAYOUT_ROW_MAJOR,
                                    .srcStride = columns,
                                    .dstLayout = SLC_LAYOUT_INFERENCING};
    return c->convert(c->info->device, &info);
}

/* Writes all data, or only the size if `bytes` is NULL. Errors: SIZE_MISMATCH; VULKAN. */
static SluiceResult convert(const struct conversion *c, uint64_t *room, uint8_t *bytes)
{
    const uint8_t *from = c->info->pWeights;
    uint32_t offsets[SLUICE_NEURAL_LAYERS];
    size_t sizes[SLUICE_NEURAL_LAYERS] = {0};
    uint64_t at = HEAD + c->number_size, read = 0;
    for (int i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        VkResult failed = convert_layer(c, i, NULL, NULL, &sizes[i]);
        if (failed < 0 || sizes[i] > 1u << 24)
            return SLUICE_ERROR_VULKAN;
        at = (at + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
        offsets[i] = (uint32_t)at;
        at += sizes[i];
    }
    at = (at + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    uint64_t size = *room;
    *room = at;
    if (!bytes)
        return SLUICE_SUCCESS;
    if (size < at)
        return SLUICE_ERROR_SIZE_MISMATCH;
    memset(bytes, 0, (size_t)at);
    memcpy(bytes, offsets, sizeof offsets);
    memcpy(bytes + HEAD, from + c->matrix_size, (size_t)c->number_size);
    for (int i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        if (convert_layer(c, i, from + read, bytes + offsets[i], &sizes[i]) != VK_SUCCESS)
            return SLUICE_ERROR_VULKAN;
        read += (uint64_t)c->sizes[i] * c->sizes[i + 1];
    }
    return SLUICE_SUCCESS;
}

SluiceResult sluiceConvertNeuralWeights(const SluiceNeuralConvertInfo *pInfo, uint64_t *pSize,
                                        void *pBytes)
{
    if (!pInfo || !pSize)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceNeuralConvertInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceNeuralConvertInfo), &info, pInfo, &pInfo->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!info.device || !info.pfnGetDeviceProcAddr || !info.pConstants || !info.pWeights)
        return SLUICE_ERROR_NULL_POINTER;
    struct conversion c = {.info = &info};
    if (info.weightKind != SLUICE_NEURAL_WEIGHTS_INT8 &&
        info.weightKind != SLUICE_NEURAL_WEIGHTS_FP8)
        return slc_log_refusal(&info.log, "weightKind is %d; 0 and 1 are possible",
                               (int)info.weightKind);
    if (!find_sizes(&info, &c))
        return slc_log_refusal(&info.log, "no network has schema %u and inputCount %u",
                               info.pConstants->schema, info.pConstants->inputCount);
    if (info.weightSize != c.matrix_size + c.number_size)
        return slc_log_refusal(&info.log, "weightSize is %llu; the network has %llu bytes",
                               (unsigned long long)info.weightSize,
                               (unsigned long long)(c.matrix_size + c.number_size));
    c.convert = (slc_convert_matrix)info.pfnGetDeviceProcAddr(info.device,
                                                              "vkConvertCooperativeVectorMatrixNV");
    return c.convert ? convert(&c, pSize, pBytes) : SLUICE_ERROR_UNSUPPORTED;
}
