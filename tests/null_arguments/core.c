/* NULL and zero in every argument of the functions of sluice. */
#include "null_arguments/calls.h"

#include <sluice/camera_motion.h>
#include <sluice/feedback_rate.h>
#include <sluice/image.h>
#include <sluice/input.h>
#include <sluice/loader.h>
#include <sluice/manager.h>
#include <sluice/metrics.h>
#include <sluice/replay.h>
#include <sluice/udim.h>

#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* clang-format off */
/* CALLS
sluiceGetResultName(SLUICE_SUCCESS)

!sluiceAddCameraFrame(&f->out.motion, f->view, 1.0)
sluicePredictCamera(&f->motion, &f->look, &f->out.ahead)
sluicePredictFeedbackMiss(&f->rate, 0.5, &f->out.number)
sluiceChooseFeedbackProbability(&f->rate, 0.01, &f->out.probability)
sluicePredictFeedbackDelay(&f->rate, 0.5, &f->out.delay)

sluiceGetFormatInfo(SLUICE_FORMAT_R8_UNORM, &f->out.format)
sluiceGetFormatTexelSize(SLUICE_FORMAT_R8_UNORM)
sluiceGetFormatRegionSize(SLUICE_FORMAT_R8_UNORM, 4, 4)
sluiceGetFormatName(SLUICE_FORMAT_R8_UNORM)
sluiceGetStandardTileShape(SLUICE_FORMAT_R8_UNORM, &f->out.width, &f->out.height)
sluiceGetImageInfo(f->source, &f->out.info)
sluiceReadImageRegion(f->source, &f->region, f->out.texels, sizeof f->out.texels)
sluiceReadImageRegionLocated(f->source, &f->region, f->out.texels, sizeof f->out.texels, &f->out.fault)
!sluiceCompleteImageRead(&f->token, ?SLUICE_SUCCESS)
!sluiceDestroyImageSource(f->source)
sluiceCreateProceduralImageSource(&f->image, &f->info, ?NULL, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceCreateMemoryImageSource(f->texels, &f->info, ?NULL, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceCreateCompleteChainSource(&f->chain, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceCreateArrayImageSource(&f->source, 1, ?NULL, &f->out.source) => sluiceDestroyImageSource(f->out.source)

sluiceCreateFilePool(?&f->pool_info, &f->out.pool) => sluiceDestroyFilePool(f->out.pool)
!sluiceDestroyFilePool(f->pool)
sluiceGetFilePoolStatistics(f->pool, &f->out.pool_statistics)
sluiceFindUdimFiles(f->pattern, ?NULL, &f->out.room, ?NULL)
sluiceWriteUdimPath(f->pattern, 1001, ?NULL, sizeof f->out.path, f->out.path)

sluiceCreateReadPool(&f->read_pool_info, &f->out.read_pool) => sluiceDestroyReadPool(f->out.read_pool)
!sluiceDestroyReadPool(f->read_pool)
sluiceGetReadPoolStatistics(f->read_pool, &f->out.read_pool_statistics)

sluiceCreateTileLoader(&f->loader_info, &f->out.loader) => sluiceDestroyTileLoader(f->out.loader)
!sluiceDestroyTileLoader(f->loader)
sluiceSubmitTileRead(f->loader, &f->read, &f->out.ticket) => sluiceWaitTileLoaderIdle(f->loader)
sluiceSubmitTileReads(f->loader, 1, &f->read, &f->out.ticket) => sluiceWaitTileLoaderIdle(f->loader)
sluiceCancelTileRead(f->loader, 1)
sluiceCollectTileReads(f->loader, one(f), &f->out.read)
sluiceWaitTileLoaderIdle(f->loader)
sluiceGetTileLoaderStatistics(f->loader, ?f->source, &f->out.loader_statistics)
sluiceDropTileLoaderStatistics(f->loader, f->source)

sluiceCreateStreamedTextureManager(&f->manager_info, &f->out.manager) => sluiceDestroyStreamedTextureManager(f->out.manager)
!sluiceDestroyStreamedTextureManager(f->manager)
sluiceSetConfig(f->manager, &f->config)
sluiceGetStreamedTextureLayout(&f->desc, &f->out.layout)
sluiceAddStreamedTexture(f->manager, &f->desc, &f->out.id)
!sluiceRemoveStreamedTexture(f->manager, f->id, 1)
sluiceGetTextureLayout(f->manager, f->id, &f->out.layout)
sluiceUpdateWithSamplerFeedback(f->manager, f->id, &f->feedback, 1, 1)
sluiceMatchPrimaryTexture(f->manager, f->id, f->follower, 1, 1)
sluiceSetPrimaryTexture(f->manager, f->follower, f->id)
sluiceSetTexturePriority(f->manager, f->id, ?1)
sluiceGetTextureLevelStatistics(f->manager, f->id, ?0, &f->out.level_statistics)
sluiceSetUvTransform(f->manager, f->follower, ?&f->uv)
sluiceGetTilesToMap(f->manager, f->id, one(f), ?f->out.tiles)
!sluiceUpdateTilesMapping(f->manager, f->id, 1, f->indices)
!sluiceReportFailedTiles(f->manager, f->id, 1, f->indices, 1)
sluiceRetryFailedTiles(f->manager, f->id)
sluiceGetGivenUpTiles(f->manager, one(f), ?f->out.tiles)
sluiceGetTilesToCancel(f->manager, f->id, one(f), ?f->out.tiles)
!sluiceReportCanceledTiles(f->manager, f->id, 1, f->indices, 1)
sluiceGetTilesToUnmap(f->manager, f->id, 1, one(f), ?f->out.tiles)
sluiceCompleteRetireValue(f->manager, 1)
sluiceTrimStandbyTiles(f->manager, 1)
sluiceEvacuateHeaps(f->manager, 1)
sluiceForgetStreamedTexture(f->manager, f->id, 1)
sluiceEvictStreamedTexture(f->manager, f->id, ?1)
sluiceDefragmentTiles(f->manager, 1, one(f), ?f->out.moves)
sluiceGetEmptyHeaps(f->manager, one(f), ?f->out.heaps)
!sluiceReleaseHeap(f->manager, 1)
sluiceWriteMinMipData(f->manager, f->id, 2, 4, f->out.min_mip)
sluiceWriteMinMipRect(f->manager, &f->rect, 2, 4, f->out.min_mip)
sluiceWriteRequestedLevels(f->manager, f->id, 2, 4, f->out.min_mip)
sluiceGetMinMipUpdates(f->manager, one(f), ?f->out.rects)
sluiceGetTileState(f->manager, f->id, 1, ?&f->out.state, ?&f->out.tile)
!sluiceGetSlotTile(f->manager, 1, 1, &f->out.tile)
sluiceGetStatistics(f->manager, &f->out.statistics)
sluiceSetTileEventCapacity(f->manager, ?1)
sluiceMarkTileEvents(f->manager, ?1)
sluiceReadTileEvents(f->manager, &f->out.cursor, one(f), f->out.events, ?&f->out.lost)
sluiceGetTextureStatistics(f->manager, f->id, &f->out.texture_statistics)

sluiceComputePsnr8(f->texels, f->texels, 4, 4, 4, &f->out.number)
sluiceComputeSsim(&f->pair, ?NULL, ?NULL, &f->out.number)
sluiceComputeFlip(&f->pair, 60, ?NULL, ?NULL, &f->out.number)
~sluiceColorMagma(f->values, 2, f->out.texels)

sluiceBeginRecording(f->fresh, &f->writer, ?NULL, &f->out.recorder) => sluiceEndRecording(f->out.recorder)
sluiceBeginRecordingToFile(f->fresh, f->path, ?NULL, &f->out.recorder) => sluiceEndRecording(f->out.recorder)
sluiceBeginFileRecording(f->fresh, &f->recording, &f->out.recorder) => sluiceEndRecording(f->out.recorder)
sluiceEndRecording(?NULL)
!sluiceReplay(&f->replay, &f->out.replay)
sluiceCreateTracePlayer(&f->player_info, &f->out.player) => sluiceDestroyTracePlayer(f->out.player)
!sluiceDestroyTracePlayer(f->player)
sluiceGetNextTraceCall(f->player, &f->out.trace_call)
sluicePlayTraceCall(f->player)
sluiceGetTracePlayerManager(f->player, &f->out.manager)
sluiceGetTracePlayerState(f->player, &f->out.player_state)
sluiceGetTracePlayerTextures(f->player, one(f), ?&f->out.id)
sluiceWriteTraceCheckpoint(f->player, &f->writer)
sluiceReadTraceCheckpoint(f->player, f->checkpoint.data, f->checkpoint.size)
*/
/* clang-format on */

struct bytes {
    uint8_t data[1024];
    size_t size;
};

struct fixture {
    SluiceTracePlayerCreateInfo player_info;
    SluiceTracePlayer *player;
    struct bytes trace, checkpoint;
    SluiceCameraMotion motion;
    SluiceLookAheadInfo look;
    float view[16];
    SluiceFeedbackRate rate;
    SluiceProceduralImage image;
    SluiceCompleteChainSourceCreateInfo chain;
    SluiceImageInfo info;
    SluiceImageSource *source;
    SluiceImageRegion region;
    SluiceImageReadToken token;
    uint8_t texels[4 * 256 * 256];
    SluiceFilePoolCreateInfo pool_info;
    SluiceFilePool *pool;
    SluiceReadPoolCreateInfo read_pool_info;
    SluiceReadPool *read_pool;
    SluiceTileLoaderCreateInfo loader_info;
    SluiceTileLoader *loader;
    void *read_texels;
    uint8_t read_room[64];
    SluiceTileRead read;
    SluiceStreamedTextureManagerCreateInfo manager_info;
    SluiceStreamedTextureManagerConfig config;
    SluiceStreamedTextureManager *manager, *fresh;
    SluiceStreamedTextureDesc desc;
    SluiceTextureId id, follower;
    SluiceUvTransform uv;
    SluiceFeedbackDesc feedback;
    uint8_t map[4];
    uint32_t indices[1];
    SluiceMinMipRect rect;
    SluicePicturePair pair;
    float values[2];
    SluiceRecordWriter writer;
    SluiceFileRecordingInfo recording;
    SluiceReplayInfo replay;
    char path[64], pattern[64], cell[64];
    struct {
        char path[64];
        double number;
        float probability;
        SluiceFeedbackDelay delay;
        SluiceFormatInfo format;
        uint32_t width, height, room;
        SluiceImageInfo info;
        uint8_t texels[64];
        SluiceImageFault fault;
        SluiceImageSource *source;
        SluiceFilePool *pool;
        SluiceFilePoolStatistics pool_statistics;
        SluiceReadPool *read_pool;
        SluiceReadPoolStatistics read_pool_statistics;
        SluiceTileLoader *loader;
        uint64_t ticket;
        SluiceTileReadResult read;
        SluiceTileLoaderStatistics loader_statistics;
        SluiceStreamedTextureManager *manager;
        SluiceStreamedTextureLayout layout;
        SluiceTextureId id;
        SluiceTile tiles[1], tile;
        SluiceTileMove moves[1];
        uint32_t heaps[1];
        uint8_t min_mip[4];
        SluiceMinMipRect rects[1];
        SluiceTileState state;
        SluiceStreamedTextureStatistics statistics;
        SluiceTextureStatistics texture_statistics;
        SluiceTextureLevelStatistics level_statistics;
        uint64_t cursor, lost;
        SluiceCameraMotion motion;
        SluiceLookAhead ahead;
        SluiceTileEvent events[1];
        SluiceRecorder *recorder;
        SluiceReplayResult replay;
        SluiceTracePlayer *player;
        SluiceTraceCall trace_call;
        SluiceTracePlayerState player_state;
    } out;
};

CALLS_FUNCTIONS

static uint32_t *one(struct fixture *f)
{
    f->out.room = 1;
    return &f->out.room;
}

static void texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                  uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)x, (void)y, (void)width, (void)height;
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0.5f;
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    (void)user, (void)size;
    *heap_id = 0;
    return SLUICE_SUCCESS;
}

static void release_heap(void *user, uint32_t heap_id)
{
    (void)user, (void)heap_id;
}

static SluiceResult write_nothing(void *user, const void *data, size_t size)
{
    (void)user, (void)data, (void)size;
    return SLUICE_SUCCESS;
}

static SluiceResult keep_bytes(void *user, const void *data, size_t size)
{
    struct bytes *bytes = user;
    assert_true(size <= sizeof bytes->data - bytes->size);
    memcpy(bytes->data + bytes->size, data, size);
    bytes->size += size;
    return SLUICE_SUCCESS;
}

static void init_player(struct fixture *f)
{
    const SluiceRecordWriter trace = {&f->trace, keep_bytes};
    const SluiceRecordWriter checkpoint = {&f->checkpoint, keep_bytes};
    SluiceRecorder *recorder;
    CHECK_OK(sluiceBeginRecording(f->manager, &trace, NULL, &recorder));
    CHECK_OK(sluiceEndRecording(recorder));
    f->player_info = (SluiceTracePlayerCreateInfo){
        .structSize = sizeof f->player_info, .pData = f->trace.data, .size = f->trace.size};
    CHECK_OK(sluiceCreateTracePlayer(&f->player_info, &f->player));
    CHECK_OK(sluiceWriteTraceCheckpoint(f->player, &checkpoint));
}

static void init_manager(struct fixture *f)
{
    f->manager_info = (SluiceStreamedTextureManagerCreateInfo){
        .structSize = sizeof(SluiceStreamedTextureManagerCreateInfo),
        .heapAllocator = {NULL, allocate_heap, release_heap},
        .heapTileCapacity = 16,
        .tileSize = 65536,
        .alwaysMapPackedTiles = true};
    CHECK_OK(sluiceCreateStreamedTextureManager(&f->manager_info, &f->manager));
    CHECK_OK(sluiceCreateStreamedTextureManager(&f->manager_info, &f->fresh));
    f->desc = (SluiceStreamedTextureDesc){.width = 256,
                                          .height = 256,
                                          .mipLevelCount = 9,
                                          .regularMipCount = 2,
                                          .packedTileCount = 1,
                                          .tileWidth = 128,
                                          .tileHeight = 128};
    CHECK_OK(sluiceAddStreamedTexture(f->manager, &f->desc, &f->id));
    CHECK_OK(sluiceAddStreamedTexture(f->manager, &f->desc, &f->follower));
    f->feedback = (SluiceFeedbackDesc){
        .structSize = sizeof(SluiceFeedbackDesc), .pMinMip = f->map, .width = 2, .height = 2};
    f->uv = (SluiceUvTransform){.scaleU = 8, .scaleV = 8};
    f->rect = (SluiceMinMipRect){.textureId = f->id, .width = 2, .height = 2};
}

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    f->rate = (SluiceFeedbackRate){.structSize = sizeof(SluiceFeedbackRate),
                                   .regionWidth = 4,
                                   .regionHeight = 4,
                                   .textureCount = 10,
                                   .frameRate = 60,
                                   .timeoutSeconds = 1};
    f->look =
        (SluiceLookAheadInfo){.structSize = sizeof f->look, .pictureWidth = 4, .pictureHeight = 4};
    f->image = (SluiceProceduralImage){NULL, texel};
    f->info = (SluiceImageInfo){.structSize = sizeof(SluiceImageInfo),
                                .width = 256,
                                .height = 256,
                                .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                .pName = "gray"};
    CHECK_OK(sluiceCreateProceduralImageSource(&f->image, &f->info, NULL, &f->source));
    f->chain =
        (SluiceCompleteChainSourceCreateInfo){.structSize = sizeof f->chain, .source = f->source};
    f->region = (SluiceImageRegion){.width = 4, .height = 4};
    f->loader_info = (SluiceTileLoaderCreateInfo){.structSize = sizeof(SluiceTileLoaderCreateInfo),
                                                  .threadCount = 1};
    f->pool_info.structSize = sizeof f->pool_info;
    CHECK_OK(sluiceCreateFilePool(&f->pool_info, &f->pool));
    f->read_pool_info =
        (SluiceReadPoolCreateInfo){.structSize = sizeof f->read_pool_info, .threadCount = 1};
    CHECK_OK(sluiceCreateReadPool(&f->read_pool_info, &f->read_pool));
    CHECK_OK(sluiceCreateTileLoader(&f->loader_info, &f->loader));
    f->read_texels = f->read_room;
    f->read = (SluiceTileRead){
        .source = f->source, .regionCount = 1, .pRegions = &f->region, .ppTexels = &f->read_texels};
    f->pair = (SluicePicturePair){.structSize = sizeof(SluicePicturePair),
                                  .pA = f->texels,
                                  .pB = f->texels,
                                  .width = 16,
                                  .height = 16};
    f->writer = (SluiceRecordWriter){NULL, write_nothing};
    f->config.structSize = sizeof f->config;
    f->recording =
        (SluiceFileRecordingInfo){.structSize = sizeof(SluiceFileRecordingInfo), .pPath = f->path};
    f->replay =
        (SluiceReplayInfo){.structSize = sizeof(SluiceReplayInfo), .pData = f->texels, .size = 16};
    snprintf(f->path, sizeof f->path, "/tmp/sluice-null-%ld.rec", (long)getpid());
    snprintf(f->pattern, sizeof f->pattern, "/tmp/sluice-null-%ld.<UDIM>", (long)getpid());
    snprintf(f->cell, sizeof f->cell, "/tmp/sluice-null-%ld.1001", (long)getpid());
    FILE *cell = fopen(f->cell, "w");
    assert_non_null(cell);
    fclose(cell);
    init_manager(f);
    init_player(f);
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyTracePlayer(f->player);
    sluiceDestroyTileLoader(f->loader);
    sluiceDestroyFilePool(f->pool);
    sluiceDestroyReadPool(f->read_pool);
    sluiceDestroyStreamedTextureManager(f->manager);
    sluiceDestroyStreamedTextureManager(f->fresh);
    sluiceDestroyImageSource(f->source);
    remove(f->path);
    remove(f->cell);
}

#include "core_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
