/*
 * Any bytes as a DDS and as a KTX2 file: an error or an image, all of whose texels can be read.
 * With clang:
 *
 *     CC=clang meson setup BUILD -Db_sanitize=address,undefined -Db_lundef=false \
 *         -Dc_args=-fsanitize=fuzzer-no-link
 *     ninja -C BUILD tests/container/fuzz_container_libfuzzer
 *     BUILD/tests/container/fuzz_container_libfuzzer -max_len=1000 tests/fuzz/corpus/container
 *
 * In the ordinary test run standalone.c plays the corpus.
 */
#include <sluice/dds.h>
#include <sluice/ktx2.h>

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define MAX_LEVEL_SIZE ((uint64_t)1 << 20)

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

/* Memory of the exact size, so that a byte too many is seen. */
static void read_level(SluiceImageSource *source, const SluiceImageInfo *info, uint32_t layer,
                       uint32_t level)
{
    SluiceImageRegion region = {
        level, 0, 0, level_size(info->width, level), level_size(info->height, level), layer};
    uint64_t row = sluiceGetFormatRegionSize(info->format, region.width, 1);
    uint64_t size = sluiceGetFormatRegionSize(info->format, region.width, region.height);
    if (size > MAX_LEVEL_SIZE)
        return;
    void *texels = malloc(size);
    if (texels &&
        sluiceReadImageRegion(source, &region, texels, row) == SLUICE_ERROR_INVALID_ARGUMENT)
        abort();
    free(texels);
}

static void read_levels(SluiceImageSource *source)
{
    SluiceImageInfo info = {.structSize = sizeof info};
    if (sluiceGetImageInfo(source, &info) == SLUICE_SUCCESS)
        for (uint32_t layer = 0; layer < info.arrayLayerCount && layer < 16; layer++)
            for (uint32_t level = 0; level < info.mipLevelCount; level++)
                read_level(source, &info, layer, level);
}

/* Reads a source as it is, and again with all levels if it lacks some that can be built. */
static void read_source(SluiceImageSource *source)
{
    SluiceCompleteChainSourceCreateInfo create = {
        .structSize = sizeof create, .source = source, .maxMemorySize = 4 * MAX_LEVEL_SIZE};
    SluiceImageSource *complete;
    read_levels(source);
    if (sluiceCreateCompleteChainSource(&create, &complete) == SLUICE_SUCCESS) {
        read_levels(complete);
        sluiceDestroyImageSource(complete);
    }
    sluiceDestroyImageSource(source);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    SluiceInput input = {.structSize = sizeof input, .pBytes = data, .size = size};
    SluiceDdsImageSourceCreateInfo dds = {.structSize = sizeof dds, .pInput = &input};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {
        .structSize = sizeof ktx2, .pInput = &input, .maxCacheSize = MAX_LEVEL_SIZE};
    SluiceImageSource *source;
    if (sluiceCreateDdsImageSource(&dds, &source) == SLUICE_SUCCESS)
        read_source(source);
    if (sluiceCreateKtx2ImageSource(&ktx2, &source) == SLUICE_SUCCESS)
        read_source(source);
    return 0;
}
