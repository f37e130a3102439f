#include "open/neural_file.h"

#include "base/log.h"

#ifdef SLC_HAVE_NEURAL

#include <sluice/neural_source.h>

#include <stdio.h>
#include <string.h>

enum { LIST_SIZE = 512 };

/* Lists texture names, "albedo, height", as many as fit. */
static void list_names(const SluiceNeuralSet *set, uint32_t count, char list[LIST_SIZE])
{
    size_t length = 0;
    list[0] = '\0';
    for (uint32_t i = 0; i < count; i++) {
        SluiceNeuralTexture texture = {.structSize = sizeof texture};
        if (sluiceGetNeuralTexture(set, i, &texture) != SLUICE_SUCCESS)
            continue;
        int more =
            snprintf(list + length, LIST_SIZE - length, "%s%s", length ? ", " : "", texture.pName);
        if (more < 0 || (size_t)more >= LIST_SIZE - length) {
            list[length] = '\0';
            return;
        }
        length += (size_t)more;
    }
}

/* Returns the index of a texture; the number of textures if no texture has the name. */
static uint32_t find_texture(const SluiceNeuralSet *set, uint32_t count, const char *name)
{
    uint32_t i = 0;
    for (; i < count && name; i++) {
        SluiceNeuralTexture texture = {.structSize = sizeof texture};
        if (sluiceGetNeuralTexture(set, i, &texture) == SLUICE_SUCCESS &&
            strcmp(texture.pName, name) == 0)
            break;
    }
    return i;
}

static SluiceResult choose(const SluiceNeuralSet *set, const char *path, const char *name,
                           const SluiceLogCallback *log, uint32_t *index)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    char names[LIST_SIZE];
    SluiceResult result = sluiceGetNeuralSetInfo(set, &info);
    if (result != SLUICE_SUCCESS)
        return result;
    if (info.textureCount == 0) {
        slc_log(log, SLUICE_LOG_ERROR, "%s: is a neural set without textures", path);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    *index = find_texture(set, info.textureCount, name);
    list_names(set, info.textureCount, names);
    if (*index == info.textureCount)
        return slc_log_refusal(log, "%s: has no texture '%s'; it has %s", path, name, names);
    if (!name && info.textureCount > 1)
        slc_log(log, SLUICE_LOG_INFO,
                "%s: has the textures %s; the first one is opened, and others by name "
                "(sluiceOpenNamedImageSource)",
                path, names);
    return SLUICE_SUCCESS;
}

SluiceResult slc_neural_file_open(const char *path, const SluiceInput *input, const char *texture,
                                  SluiceFilePool *pool, const SluiceAllocationCallbacks *cb,
                                  const SluiceLogCallback *log, SluiceImageSource **source)
{
    const SluiceNeuralSetCreateInfo open = {.structSize = sizeof open,
                                            .pPath = path,
                                            .pInput = input,
                                            .pAllocator = cb,
                                            .log = *log,
                                            .filePool = pool};
    SluiceNeuralImageSourceCreateInfo info = {
        .structSize = sizeof info, .pAllocator = cb, .log = *log};
    SluiceResult result = sluiceOpenNeuralSet(&open, &info.ownedSet);
    if (result != SLUICE_SUCCESS)
        return result;
    result = choose(info.ownedSet, path, texture, log, &info.textureIndex);
    if (result == SLUICE_SUCCESS)
        return sluiceCreateNeuralImageSource(&info, source);
    sluiceDestroyNeuralSet(info.ownedSet);
    return result;
}

#else

SluiceResult slc_neural_file_open(const char *path, const SluiceInput *input, const char *texture,
                                  SluiceFilePool *pool, const SluiceAllocationCallbacks *cb,
                                  const SluiceLogCallback *log, SluiceImageSource **source)
{
    (void)input, (void)texture, (void)pool, (void)cb, (void)source;
    slc_log(log, SLUICE_LOG_ERROR,
            "%s: is a neural set; this build of Sluice was made without sluice-neural", path);
    return SLUICE_ERROR_UNSUPPORTED;
}

#endif /* SLC_HAVE_NEURAL */
