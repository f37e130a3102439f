/**
 * Any bytes as an OpenEXR file: an error or an image, all of whose levels can be asked for. Link it
 * with -fsanitize=fuzzer, or with standalone.c to replay inputs.
 */
#include <sluice/exr.h>

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* In strips, so that a large image needs little memory; errors are as good as texels. */
static void read_level(SluiceImageSource *source, const SluiceImageInfo *info, uint32_t level)
{
    enum { STRIP = 64 };
    uint32_t width = info->width >> level ? info->width >> level : 1;
    uint32_t height = info->height >> level ? info->height >> level : 1;
    size_t pitch = (size_t)width * sluiceGetFormatTexelSize(info->format);
    void *texels = malloc(pitch * STRIP);
    for (uint32_t y = 0; texels && y < height; y += STRIP) {
        uint32_t rows = height - y < STRIP ? height - y : STRIP;
        SluiceImageRegion region = {level, 0, y, width, rows};
        if (sluiceReadImageRegion(source, &region, texels, pitch) != SLUICE_SUCCESS)
            break;
    }
    free(texels);
}

static void read_file(const SluiceInput *input, SluiceFormat format)
{
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pInput = input,
                                             .format = format,
                                             .maxImageSize = 1 << 26,
                                             .maxMemorySize = 1 << 28};
    SluiceImageSource *source;
    SluiceImageInfo info = {.structSize = sizeof info};
    SluiceExrInfo exr = {.structSize = sizeof exr};
    if (sluiceCreateExrImageSource(&create, &source) != SLUICE_SUCCESS)
        return;
    if (sluiceGetImageInfo(source, &info) != SLUICE_SUCCESS ||
        sluiceGetExrInfo(source, &exr) != SLUICE_SUCCESS ||
        exr.chainSize + exr.readSize > create.maxMemorySize)
        abort();
    for (uint32_t level = 0; level < info.mipLevelCount; level++)
        read_level(source, &info, level);
    sluiceDestroyImageSource(source);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    SluiceInput input = {.structSize = sizeof input, .pBytes = data, .size = size};
    read_file(&input, SLUICE_FORMAT_UNDEFINED);
    read_file(&input, SLUICE_FORMAT_R8G8B8A8_SRGB);
    read_file(&input, SLUICE_FORMAT_R16G16_UNORM);
    return 0;
}
