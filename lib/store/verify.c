#include "base/alloc.h"
#include "base/struct_size.h"
#include "store/reader.h"

struct verifier {
    const SluiceStoreVerifyInfo *info;
    struct slc_store_reader reader;
    SluiceStoreReport report;
    SluiceResult result; ///< result for the first defect
};

static void note_defect(struct verifier *verifier, const struct slc_store_find *find,
                        SluiceResult result)
{
    SluiceStoreDefect defect = {.structSize = sizeof defect,
                                .arrayLayer = find->place.layer,
                                .mipLevel = find->place.level,
                                .tileX = find->place.x,
                                .tileY = find->place.y,
                                .offset = find->offset,
                                .result = result};
    verifier->report.defectCount++;
    if (verifier->result == SLUICE_SUCCESS)
        verifier->result = result;
    if (verifier->info->pfnDefect)
        verifier->info->pfnDefect(verifier->info->pUserData, &defect);
}

/* Verifies a chunk, and notes defects of the file. Errors: OUT_OF_HOST_MEMORY. */
static SluiceResult verify_chunk(struct verifier *verifier, uint64_t number,
                                 struct slc_store_read_bench *bench)
{
    const struct slc_store_grid *grid = &verifier->reader.header.grid;
    struct slc_store_place place = slc_store_chunk_place(grid, number);
    struct slc_store_find find;
    SluiceResult result =
        slc_store_read_chunk(&verifier->reader, &place, bench, bench->texels, &find);
    if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return result;
    verifier->report.tileCount++;
    if (result != SLUICE_SUCCESS) {
        note_defect(verifier, &find, result);
        return SLUICE_SUCCESS;
    }
    uint32_t texel_size = slc_store_chunk_size(grid, &place);
    verifier->report.storedSize += find.entry.size;
    verifier->report.texelSize += texel_size;
    verifier->report.rawTileCount += find.entry.size == texel_size;
    return SLUICE_SUCCESS;
}

static SluiceResult verify_chunks(struct verifier *verifier, struct slc_store_read_bench *bench)
{
    enum { STEP = 64 };
    const SluiceStoreVerifyInfo *info = verifier->info;
    uint64_t count = verifier->reader.header.grid.chunk_count;
    for (uint64_t number = 0; number < count; number++) {
        if (info->pfnProgress && number % STEP == 0 &&
            !info->pfnProgress(info->pUserData, number, count))
            return SLUICE_ERROR_CANCELED;
        SluiceResult result = verify_chunk(verifier, number, bench);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return verifier->result;
}

SluiceResult sluiceVerifyStore(const SluiceStoreVerifyInfo *pInfo, SluiceStoreReport *pReport)
{
    if (!pInfo)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceStoreVerifyInfo info = {.structSize = sizeof info};
    SluiceResult result =
        slc_struct_read(SLC_STRUCT(SluiceStoreVerifyInfo), &info, pInfo, &pInfo->log);
    if (result == SLUICE_SUCCESS &&
        ((!info.pPath && !info.pInput) || !slc_allocator_is_valid(info.pAllocator)))
        result = SLUICE_ERROR_NULL_POINTER;
    if (result == SLUICE_SUCCESS && pReport)
        result = slc_struct_check(SLC_STRUCT(SluiceStoreReport), pReport, &info.log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceStoreImageSourceCreateInfo open = {.structSize = sizeof open,
                                             .pPath = info.pPath,
                                             .pAllocator = info.pAllocator,
                                             .pInput = info.pInput,
                                             .log = info.log};
    struct verifier verifier = {.info = &info};
    struct slc_store_read_bench *bench = NULL;
    result = slc_store_reader_open(&verifier.reader, &open);
    if (result == SLUICE_SUCCESS) {
        bench = slc_store_read_pool_take(verifier.reader.pool);
        result = bench ? verify_chunks(&verifier, bench) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    if (bench)
        slc_store_read_pool_give(verifier.reader.pool, bench);
    slc_store_reader_close(&verifier.reader);
    if (pReport)
        slc_struct_write(SLC_STRUCT(SluiceStoreReport), pReport, &verifier.report);
    return result;
}
