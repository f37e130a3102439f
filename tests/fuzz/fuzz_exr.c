/**
 * Any bytes as an OpenEXR file: an error or an image, all of whose levels can be asked for. Link it
 * with -fsanitize=fuzzer, or with standalone.c to replay inputs.
 */
#define _XOPEN_SOURCE 700

#include <sluice/exr.h>

#include <stdlib.h>
#include <unistd.h>

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

static void read_file(const char *path, SluiceFormat format)
{
    SluiceExrImageSourceCreateInfo create = {.structSize = sizeof create,
                                             .pPath = path,
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
    char path[] = "/tmp/fuzz-exr-XXXXXX";
    int descriptor = mkstemp(path);
    if (descriptor < 0)
        return 0;
    if (write(descriptor, data, size) == (ssize_t)size) {
        read_file(path, SLUICE_FORMAT_UNDEFINED);
        read_file(path, SLUICE_FORMAT_R8G8B8A8_SRGB);
    }
    close(descriptor);
    unlink(path);
    return 0;
}
