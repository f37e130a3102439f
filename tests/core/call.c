#include "core/call.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[CALL_KIND_COUNT] = {
    [CALL_SET_CONFIG] = "SetConfig",
    [CALL_ADD_TEXTURE] = "AddStreamedTexture",
    [CALL_REMOVE_TEXTURE] = "RemoveStreamedTexture",
    [CALL_FEEDBACK] = "UpdateWithSamplerFeedback",
    [CALL_MATCH_PRIMARY] = "MatchPrimaryTexture",
    [CALL_SET_PRIMARY] = "SetPrimaryTexture",
    [CALL_TILES_TO_MAP] = "GetTilesToMap",
    [CALL_MAPPED] = "UpdateTilesMapping",
    [CALL_FAILED] = "ReportFailedTiles",
    [CALL_CANCELED] = "ReportCanceledTiles",
    [CALL_RETRY] = "RetryFailedTiles",
    [CALL_GIVEN_UP] = "GetGivenUpTiles",
    [CALL_TILES_TO_CANCEL] = "GetTilesToCancel",
    [CALL_TILES_TO_UNMAP] = "GetTilesToUnmap",
    [CALL_COMPLETE] = "CompleteRetireValue",
    [CALL_TRIM] = "TrimStandbyTiles",
    [CALL_EVACUATE] = "EvacuateHeaps",
    [CALL_FORGET] = "ForgetStreamedTexture",
    [CALL_EVICT] = "EvictStreamedTexture",
    [CALL_DEFRAGMENT] = "DefragmentTiles",
    [CALL_EMPTY_HEAPS] = "GetEmptyHeaps",
    [CALL_RELEASE_HEAP] = "ReleaseHeap",
    [CALL_MINMIP_UPDATES] = "GetMinMipUpdates",
    [CALL_WRITE_MINMIP] = "WriteMinMipData",
    [CALL_WRITE_RECT] = "WriteMinMipRect",
    [CALL_TILE_STATE] = "GetTileState",
    [CALL_LAYOUT] = "GetStreamedTextureLayout",
    [CALL_TEXTURE_LAYOUT] = "GetTextureLayout",
    [CALL_STATISTICS] = "GetStatistics",
};

const char *call_kind_name(enum call_kind kind)
{
    return names[kind];
}

bool call_is_list(enum call_kind kind)
{
    return kind == CALL_TILES_TO_MAP || kind == CALL_GIVEN_UP || kind == CALL_TILES_TO_CANCEL ||
           kind == CALL_TILES_TO_UNMAP || kind == CALL_DEFRAGMENT || kind == CALL_EMPTY_HEAPS ||
           kind == CALL_MINMIP_UPDATES;
}

static SluiceResult make_list_call(SluiceStreamedTextureManager *m, const struct call *c,
                                   struct outcome *out)
{
    uint32_t *count = c->null == NULL_FIRST ? NULL : &out->count;
    SluiceTile *tiles = c->null == NULL_SECOND ? NULL : out->tiles;
    out->count = c->room;
    switch (c->kind) {
    case CALL_TILES_TO_MAP: return sluiceGetTilesToMap(m, c->texture, count, tiles);
    case CALL_GIVEN_UP: return sluiceGetGivenUpTiles(m, count, tiles);
    case CALL_TILES_TO_CANCEL: return sluiceGetTilesToCancel(m, c->texture, count, tiles);
    case CALL_TILES_TO_UNMAP: return sluiceGetTilesToUnmap(m, c->texture, c->retire, count, tiles);
    case CALL_DEFRAGMENT:
        return sluiceDefragmentTiles(m, c->retire, count,
                                     c->null == NULL_SECOND ? NULL : out->moves);
    case CALL_EMPTY_HEAPS:
        return sluiceGetEmptyHeaps(m, count, c->null == NULL_SECOND ? NULL : out->heaps);
    default: return sluiceGetMinMipUpdates(m, count, c->null == NULL_SECOND ? NULL : out->rects);
    }
}

/* Copies to memory of exactly that size, so that a sanitizer sees reads beyond it. */
static void *exact_copy(const void *data, size_t size)
{
    void *copy = malloc(size ? size : 1);
    if (!copy)
        abort();
    return memcpy(copy, data, size);
}

static SluiceResult make_answer(SluiceStreamedTextureManager *m, const struct call *c)
{
    SluiceResult result;
    uint32_t *copy = exact_copy(c->indices, c->count * sizeof *copy);
    const uint32_t *indices = c->null == NULL_FIRST ? NULL : copy;
    if (c->kind == CALL_MAPPED)
        result = sluiceUpdateTilesMapping(m, c->texture, c->count, indices);
    else if (c->kind == CALL_FAILED)
        result = sluiceReportFailedTiles(m, c->texture, c->count, indices, c->time);
    else
        result = sluiceReportCanceledTiles(m, c->texture, c->count, indices, c->retire);
    free(copy);
    return result;
}

static SluiceResult make_feedback(SluiceStreamedTextureManager *m, const struct call *c)
{
    uint64_t size = (uint64_t)c->map_width * c->map_height;
    uint8_t *copy = exact_copy(c->map, size < CALL_MAX_MAP ? (size_t)size : CALL_MAX_MAP);
    SluiceFeedbackDesc desc = {.structSize = sizeof desc,
                               .pMinMip = c->null_map ? NULL : copy,
                               .width = c->map_width,
                               .height = c->map_height,
                               .mipBias = c->bias,
                               .streamedMipLevels = c->streamed_levels};
    SluiceResult result = sluiceUpdateWithSamplerFeedback(
        m, c->texture, c->null == NULL_FIRST ? NULL : &desc, c->time, c->timeout);
    free(copy);
    return result;
}

static SluiceResult make_add(SluiceStreamedTextureManager *m, const struct call *c,
                             struct outcome *out)
{
    return sluiceAddStreamedTexture(m, c->null == NULL_FIRST ? NULL : &c->desc,
                                    c->null == NULL_SECOND ? NULL : &out->texture);
}

static SluiceResult make_config(SluiceStreamedTextureManager *m, const struct call *c)
{
    SluiceStreamedTextureManagerConfig config = c->config;
    config.structSize = sizeof config;
    return sluiceSetConfig(m, c->null == NULL_FIRST ? NULL : &config);
}

static SluiceResult make(SluiceStreamedTextureManager *m, const struct call *c, struct outcome *out)
{
    out->layout.structSize = sizeof out->layout;
    out->statistics.structSize = sizeof out->statistics;
    const bool first = c->null == NULL_FIRST, second = c->null == NULL_SECOND;
    switch (c->kind) {
    case CALL_SET_CONFIG: return make_config(m, c);
    case CALL_ADD_TEXTURE: return make_add(m, c, out);
    case CALL_REMOVE_TEXTURE: return sluiceRemoveStreamedTexture(m, c->texture, c->retire);
    case CALL_FEEDBACK: return make_feedback(m, c);
    case CALL_MATCH_PRIMARY:
        return sluiceMatchPrimaryTexture(m, c->primary, c->texture, c->time, c->timeout);
    case CALL_SET_PRIMARY: return sluiceSetPrimaryTexture(m, c->texture, c->primary);
    case CALL_MAPPED:
    case CALL_FAILED:
    case CALL_CANCELED: return make_answer(m, c);
    case CALL_RETRY: return sluiceRetryFailedTiles(m, c->texture);
    case CALL_TILES_TO_MAP:
    case CALL_GIVEN_UP:
    case CALL_TILES_TO_CANCEL:
    case CALL_TILES_TO_UNMAP:
    case CALL_DEFRAGMENT:
    case CALL_EMPTY_HEAPS:
    case CALL_MINMIP_UPDATES: return make_list_call(m, c, out);
    case CALL_COMPLETE: return sluiceCompleteRetireValue(m, c->retire);
    case CALL_TRIM: return sluiceTrimStandbyTiles(m, c->keep);
    case CALL_EVACUATE: return sluiceEvacuateHeaps(m, c->keep);
    case CALL_FORGET: return sluiceForgetStreamedTexture(m, c->texture, c->retire);
    case CALL_EVICT: return sluiceEvictStreamedTexture(m, c->texture, c->keep);
    case CALL_RELEASE_HEAP: return sluiceReleaseHeap(m, c->heap);
    case CALL_WRITE_MINMIP:
        return sluiceWriteMinMipData(m, c->texture, c->pitch, c->size, first ? NULL : out->bytes);
    case CALL_WRITE_RECT:
        return sluiceWriteMinMipRect(m, first ? NULL : &c->rect, c->pitch, c->size,
                                     second ? NULL : out->bytes);
    case CALL_TILE_STATE:
        return sluiceGetTileState(m, c->texture, c->tile, first ? NULL : &out->state,
                                  second ? NULL : &out->tiles[0]);
    case CALL_LAYOUT:
        return sluiceGetStreamedTextureLayout(first ? NULL : &c->desc,
                                              second ? NULL : &out->layout);
    case CALL_TEXTURE_LAYOUT:
        return sluiceGetTextureLayout(m, c->texture, first ? NULL : &out->layout);
    case CALL_STATISTICS: return sluiceGetStatistics(m, first ? NULL : &out->statistics);
    case CALL_KIND_COUNT: break;
    }
    return SLUICE_ERROR_INVALID_ARGUMENT;
}

void call_make(SluiceStreamedTextureManager *manager, const struct call *call, struct outcome *out)
{
    out->count = 0;
    out->texture = SLUICE_NO_TEXTURE;
    out->answer_count = 0;
    out->result = make(call->null == NULL_MANAGER ? NULL : manager, call, out);
}

static void print_desc(FILE *file, const SluiceStreamedTextureDesc *d)
{
    fprintf(file,
            " %" PRIu32 "x%" PRIu32 " levels %" PRIu32 " regular %" PRIu32 " packed %" PRIu32
            " tile %" PRIu32 "x%" PRIu32 " region %" PRIu32 "x%" PRIu32 "%s",
            d->width, d->height, d->mipLevelCount, d->regularMipCount, d->packedTileCount,
            d->tileWidth, d->tileHeight, d->feedbackRegionWidth, d->feedbackRegionHeight,
            d->packedTilesOutside ? " outside" : "");
}

static void print_map(FILE *file, const struct call *c)
{
    fprintf(file, " %" PRIu32 "x%" PRIu32 " bias %" PRId32 " streamed %" PRIu32 "%s", c->map_width,
            c->map_height, c->bias, c->streamed_levels, c->null_map ? " map NULL" : "");
    if (c->null_map || c->map_width == 0 || (uint64_t)c->map_width * c->map_height > CALL_MAX_MAP)
        return;
    for (uint32_t y = 0; y < c->map_height; y++) {
        fprintf(file, "\n       ");
        for (uint32_t x = 0; x < c->map_width; x++)
            fprintf(file, " %3u", c->map[y * c->map_width + x]);
    }
}

void call_print(FILE *file, const struct call *c)
{
    static const char *const nulls[] = {"", " manager NULL", " first pointer NULL",
                                        " second pointer NULL"};
    fprintf(file, "%s texture %" PRIx64 "%s", names[c->kind], c->texture, nulls[c->null]);
    if (c->kind == CALL_MATCH_PRIMARY || c->kind == CALL_SET_PRIMARY)
        fprintf(file, " primary %" PRIx64, c->primary);
    if (c->kind == CALL_ADD_TEXTURE || c->kind == CALL_LAYOUT)
        print_desc(file, &c->desc);
    if (c->kind == CALL_SET_CONFIG)
        fprintf(file, " standby %" PRIu32 " heaps %" PRIu32 " attempts %" PRIu32 " delay %" PRIu64,
                c->config.numExtraStandbyTiles, c->config.maxHeapCount, c->config.maxLoadAttempts,
                c->config.retryDelayTicks);
    if (c->kind == CALL_SET_CONFIG)
        fprintf(file, " misses %" PRIu32 " prefetch %" PRIu32 " given up %" PRIu64,
                c->config.missesToExpire, c->config.prefetchLevels,
                c->config.givenUpRetryDelayTicks);
    if (c->kind == CALL_SET_CONFIG)
        fprintf(file, " target %" PRIu32 " switches %d%d%d", c->config.targetHeapCount,
                c->config.noEviction, c->config.noMipBias, c->config.separatePackedTiles);
    fprintf(file, " time %" PRIu64 " timeout %" PRIu64 " retire %" PRIu64 " room %" PRIu32, c->time,
            c->timeout, c->retire, c->room);
    fprintf(file, " keep %" PRIu32 " heap %" PRIu32 " tile %" PRIu32, c->keep, c->heap, c->tile);
    if (c->kind == CALL_WRITE_MINMIP || c->kind == CALL_WRITE_RECT)
        fprintf(file,
                " rect %" PRIx64 " %" PRIu32 ",%" PRIu32 " %" PRIu32 "x%" PRIu32
                " pitch %zu size %zu",
                c->rect.textureId, c->rect.x, c->rect.y, c->rect.width, c->rect.height, c->pitch,
                c->size);
    if (c->refuse_after != UINT64_MAX)
        fprintf(file, " refuse after %" PRIu64, c->refuse_after);
    if (c->kind == CALL_MAPPED || c->kind == CALL_FAILED || c->kind == CALL_CANCELED) {
        fprintf(file, " tiles");
        for (uint32_t i = 0; i < c->count; i++)
            fprintf(file, " %" PRIu32, c->indices[i]);
    }
    if (c->kind == CALL_FEEDBACK)
        print_map(file, c);
    fprintf(file, "\n");
}
