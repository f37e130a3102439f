#include "bake/settings.h"

#include <sluice/bake.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <string.h>

uint64_t sluiceHashBakeSettings(const SluiceBakeSettings *pSettings)
{
    uint32_t cutout;
    if (!pSettings)
        return 0;
    memcpy(&cutout, &pSettings->cutout, sizeof cutout);
    const uint32_t values[] = {
        SLC_BAKE_REVISION,
        (uint32_t)pSettings->format,
        (uint32_t)pSettings->transfer,
        (uint32_t)pSettings->alpha,
        (uint32_t)pSettings->filter,
        (uint32_t)pSettings->wrapX,
        (uint32_t)pSettings->wrapY,
        pSettings->normalMap,
        cutout,
        pSettings->compressionLevel ? pSettings->compressionLevel : SLUICE_BAKE_DEFAULT_COMPRESSION,
        pSettings->uncompressed,
        pSettings->keepPrimaries,
    };
    uint8_t bytes[sizeof values]; /* the same on every machine */
    for (size_t i = 0; i < sizeof values; i++)
        bytes[i] = (uint8_t)(values[i / 4] >> (8 * (i % 4)));
    return XXH64(bytes, sizeof bytes, 0);
}
