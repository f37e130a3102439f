#include "bake/inputs.h"

#include "base/log.h"
#include "base/same_file.h"
#include "platform/file.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <string.h>

const char *slc_bake_input_path(const struct slc_bake_inputs *inputs, uint32_t index)
{
    const SluiceBakeInfo *info = inputs->info;
    return info->layerPathCount ? info->ppLayerPaths[index] : info->pInputPath;
}

bool slc_bake_inputs_are_files(const struct slc_bake_inputs *inputs)
{
    const SluiceBakeInfo *info = inputs->info;
    return slc_bake_input_path(inputs, 0) && !info->pInput && info->firstLevel == 0;
}

const char *slc_base_name(const char *path)
{
    const char *slash = path ? strrchr(path, '/') : NULL;
    return slash ? slash + 1 : path;
}

/* Hashes the low byte first, so that all machines get the same hash. */
static uint64_t hash_number(uint64_t hash, uint64_t number)
{
    uint8_t bytes[8];
    for (int i = 0; i < 8; i++)
        bytes[i] = (uint8_t)(number >> (8 * i));
    return XXH64(bytes, sizeof bytes, hash);
}

static SluiceResult look_at_file(struct slc_bake_inputs *inputs, const char *path,
                                 const SluiceLogCallback *log)
{
    struct slc_file_status status;
    const char *output = inputs->info->pOutputPath;
    if (!slc_path_get_status(path, &status)) {
        slc_log(log, SLUICE_LOG_ERROR, "%s: %s", path, strerror(errno));
        return errno == ENOENT || errno == ENOTDIR ? SLUICE_ERROR_FILE_NOT_FOUND : SLUICE_ERROR_IO;
    }
    if (output && slc_output_replaces_input(output, path))
        return slc_log_refusal(log, "%s: the store would take its place", path);
    int64_t time = status.modified.seconds * INT64_C(1000000000) + status.modified.nanoseconds;
    inputs->size += status.size;
    inputs->time = inputs->count == 1 || time > inputs->time ? time : inputs->time;
    const char *name = slc_base_name(path);
    inputs->hash = XXH64(name, strlen(name), inputs->hash);
    inputs->hash = hash_number(hash_number(inputs->hash, status.size), (uint64_t)time);
    return SLUICE_SUCCESS;
}

static SluiceResult check_layers(const SluiceBakeInfo *info, const SluiceLogCallback *log)
{
    if (info->layerPathCount == 0)
        return info->pInputPath || info->pInput || info->source ? SLUICE_SUCCESS
                                                                : SLUICE_ERROR_NULL_POINTER;
    if (!info->ppLayerPaths)
        return SLUICE_ERROR_NULL_POINTER;
    for (uint32_t i = 0; i < info->layerPathCount; i++)
        if (!info->ppLayerPaths[i])
            return SLUICE_ERROR_NULL_POINTER;
    if (info->pInputPath || info->pInput || info->source)
        return slc_log_refusal(log,
                               "layerPathCount is %u; pInputPath, pInput and source must be NULL "
                               "then",
                               info->layerPathCount);
    return SLUICE_SUCCESS;
}

SluiceResult slc_bake_inputs_init(struct slc_bake_inputs *inputs, const SluiceBakeInfo *info,
                                  const SluiceLogCallback *log)
{
    *inputs = (struct slc_bake_inputs){.info = info,
                                       .count = info->layerPathCount ? info->layerPathCount : 1};
    SluiceResult result = check_layers(info, log);
    for (uint32_t i = 0; i < inputs->count && result == SLUICE_SUCCESS; i++)
        if (slc_bake_input_path(inputs, i) && !info->pInput)
            result = look_at_file(inputs, slc_bake_input_path(inputs, i), log);
    if (info->layerPathCount == 0)
        inputs->hash = 0; /* size and time are in the store */
    if (info->cube)
        inputs->hash = hash_number(inputs->hash, info->cube);
    return result;
}
