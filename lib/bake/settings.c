#include "bake/settings.h"

#include "base/struct_size.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <string.h>

uint64_t slc_hash_settings(const SluiceBakeSettings *settings)
{
    uint32_t cutout;
    memcpy(&cutout, &settings->cutout, sizeof cutout);
    const uint32_t values[] = {
        SLC_BAKE_REVISION,
        (uint32_t)settings->format,
        (uint32_t)settings->transfer,
        (uint32_t)settings->alpha,
        (uint32_t)settings->filter,
        (uint32_t)settings->wrapX,
        (uint32_t)settings->wrapY,
        settings->normalMap,
        cutout,
        settings->compressionLevel ? settings->compressionLevel : SLUICE_BAKE_DEFAULT_COMPRESSION,
        settings->uncompressed,
        settings->keepPrimaries,
        (uint32_t)settings->quality,
    };
    uint8_t bytes[sizeof values]; /* little-endian on every machine */
    for (size_t i = 0; i < sizeof values; i++)
        bytes[i] = (uint8_t)(values[i / 4] >> (8 * (i % 4)));
    return XXH64(bytes, sizeof bytes, 0);
}

SluiceResult sluiceHashBakeSettings(const SluiceBakeSettings *pSettings, uint64_t *pHash)
{
    if (!pSettings || !pHash)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceBakeSettings settings = {.structSize = sizeof settings};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceBakeSettings), &settings, pSettings, NULL);
    if (result == SLUICE_SUCCESS)
        *pHash = slc_hash_settings(&settings);
    return result;
}
