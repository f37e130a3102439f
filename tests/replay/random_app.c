#include "random_app.h"

#include "core/observer.h"
#include "support/test.h"

#include <stdlib.h>
#include <string.h>

#define LIST_ROOM 64
#define MAP_ROOM 4096

/* Every random number is drawn in its own statement, because C does not define the order in which
 * arguments and initializers are evaluated. */
static uint32_t random_bits(struct random_app *app)
{
    app->seed = app->seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(app->seed >> 33);
}

uint32_t random_app_below(struct random_app *app, uint32_t limit)
{
    return random_bits(app) % limit;
}

static bool one_in(struct random_app *app, uint32_t n)
{
    return random_app_below(app, n) == 0;
}

static SluiceResult allocate_heap(void *user, uint64_t size, uint32_t *heap_id)
{
    struct random_app *app = user;
    assert_true(size > 0);
    uint32_t first = random_app_below(app, RANDOM_APP_HEAPS);
    for (uint32_t i = 0; i < RANDOM_APP_HEAPS && !one_in(app, 4); i++) {
        uint32_t id = (first + i) % RANDOM_APP_HEAPS;
        if (app->heap_lives[id])
            continue;
        app->heap_lives[id] = true;
        *heap_id = id * 1000;
        return SLUICE_SUCCESS;
    }
    app->refused_heap_count++;
    return SLUICE_ERROR_OUT_OF_DEVICE_MEMORY;
}

static void release_heap(void *user, uint32_t heap_id)
{
    struct random_app *app = user;
    assert_true(heap_id % 1000 == 0 && heap_id / 1000 < RANDOM_APP_HEAPS);
    assert_true(app->heap_lives[heap_id / 1000]);
    app->heap_lives[heap_id / 1000] = false;
}

void random_app_init(struct random_app *app, uint64_t seed, bool starved)
{
    *app = (struct random_app){.seed = seed, .starved = starved};
    failing_allocator_init(&app->memory, UINT64_MAX);
    uint32_t capacity = 5 + random_app_below(app, 40);
    bool always_map_packed = one_in(app, 2);
    const SluiceStreamedTextureManagerCreateInfo info = {
        .structSize = sizeof info,
        .heapAllocator = {app, allocate_heap, release_heap},
        .pAllocator = &app->memory.callbacks,
        .heapTileCapacity = capacity,
        .tileSize = 65536,
        .alwaysMapPackedTiles = always_map_packed,
    };
    CHECK_OK(sluiceCreateStreamedTextureManager(&info, &app->manager));
}

void random_app_finish(struct random_app *app)
{
    sluiceDestroyStreamedTextureManager(app->manager);
    assert_int_equal(app->memory.live_bytes, 0);
}

/* Returns an id: mostly a handed-out one; sometimes all, none, or one that never existed. */
static SluiceTextureId some_id(struct random_app *app)
{
    if (app->id_count == 0 || one_in(app, 40))
        return one_in(app, 2) ? SLUICE_NO_TEXTURE : (SluiceTextureId)random_bits(app) << 20;
    return app->ids[random_app_below(app, app->id_count)];
}

static SluiceTextureId id_or(struct random_app *app, SluiceTextureId other)
{
    return one_in(app, 2) ? other : some_id(app);
}

static uint64_t next_time(struct random_app *app)
{
    if (one_in(app, 50))
        return app->time - 1 - random_app_below(app, 5);
    return app->time += random_app_below(app, 4);
}

static uint64_t next_retire(struct random_app *app)
{
    if (one_in(app, 50))
        return app->retire > 3 ? app->retire - 3 : 0;
    return app->retire += random_app_below(app, 2);
}

static SluiceResult add_texture(struct random_app *app)
{
    SluiceStreamedTextureDesc desc = {.tileHeight = 64};
    desc.width = 1 + random_app_below(app, one_in(app, 3) ? 2000 : 700);
    desc.height = 1 + random_app_below(app, 700);
    desc.tileWidth = 64u << random_app_below(app, 2);
    uint32_t levels = 1;
    while (desc.width >> levels || desc.height >> levels)
        levels++;
    desc.mipLevelCount = levels;
    desc.regularMipCount = random_app_below(app, levels + 1);
    desc.packedTileCount = desc.regularMipCount < levels ? 1 + random_app_below(app, 2) : 0;
    if (one_in(app, 3))
        desc.feedbackRegionWidth = desc.feedbackRegionHeight = 32;
    if (one_in(app, 12))
        desc.packedTileCount ^= 1;
    uint32_t slot = app->id_count < RANDOM_APP_TEXTURES
                        ? app->id_count
                        : random_app_below(app, RANDOM_APP_TEXTURES);
    SluiceTextureId id;
    if (one_in(app, 30))
        return one_in(app, 2) ? sluiceAddStreamedTexture(app->manager, &desc, NULL)
                              : sluiceAddStreamedTexture(app->manager, NULL, &id);
    SluiceResult result = sluiceAddStreamedTexture(app->manager, &desc, &id);
    if (result != SLUICE_SUCCESS)
        return result;
    if (slot < app->id_count) /* limits the number of living textures */
        sluiceRemoveStreamedTexture(app->manager, app->ids[slot], app->retire);
    else
        app->id_count++;
    app->ids[slot] = id;
    return result;
}

static void fill_map(struct random_app *app, uint8_t *map, uint32_t size)
{
    uint32_t dull = one_in(app, 3) ? 1 : 8;
    for (uint32_t i = 0; i < size;) {
        uint8_t value = one_in(app, 2) ? SLUICE_MIP_UNTOUCHED : (uint8_t)random_app_below(app, 12);
        for (uint32_t n = 1 + random_app_below(app, dull); n > 0 && i < size; n--)
            map[i++] = value;
    }
}

static SluiceResult give_feedback(struct random_app *app)
{
    uint8_t map[MAP_ROOM];
    SluiceTextureId id = some_id(app);
    SluiceStreamedTextureLayout layout = {.structSize = sizeof layout};
    SluiceFeedbackDesc feedback = {
        .structSize = sizeof feedback, .pMinMip = map, .width = 1, .height = 1};
    if (sluiceGetTextureLayout(app->manager, id, &layout) == SLUICE_SUCCESS) {
        feedback.width = layout.feedbackWidth;
        feedback.height = layout.feedbackHeight;
    }
    assert_true(feedback.width * feedback.height <= MAP_ROOM);
    fill_map(app, map, feedback.width * feedback.height);
    if (one_in(app, 20))
        feedback.width = UINT32_MAX; /* without such a map */
    if (one_in(app, 30))
        feedback.pMinMip = NULL;
    if (one_in(app, 4))
        feedback.mipBias = (int32_t)random_app_below(app, 6) - 3;
    if (one_in(app, 6))
        feedback.streamedMipLevels = random_app_below(app, 4);
    bool none = one_in(app, 50);
    uint64_t time = next_time(app), timeout = random_app_below(app, 12);
    return sluiceUpdateWithSamplerFeedback(app->manager, id, none ? NULL : &feedback, time,
                                           timeout);
}

static SluiceResult get_tiles_to_map(struct random_app *app)
{
    SluiceTile tiles[LIST_ROOM];
    uint32_t room = RANDOM_APP_LOADS - app->load_count;
    uint32_t count = room < LIST_ROOM ? room : random_app_below(app, LIST_ROOM + 1);
    SluiceTextureId id = id_or(app, SLUICE_ALL_TEXTURES);
    if (one_in(app, 10))
        return sluiceGetTilesToMap(app->manager, id, one_in(app, 4) ? NULL : &count, NULL);
    SluiceResult result = sluiceGetTilesToMap(app->manager, id, &count, tiles);
    for (uint32_t i = 0; result >= SLUICE_SUCCESS && i < count; i++) {
        app->loads[app->load_count].id = tiles[i].textureId;
        app->loads[app->load_count++].tile = tiles[i].tileIndex;
    }
    return result;
}

/* Takes loads of one texture out of the list. Sometimes adds a tile that is no load. */
static uint32_t take_loads(struct random_app *app, SluiceTextureId *id, uint32_t *tiles)
{
    uint32_t count = 0, most = 1 + random_app_below(app, LIST_ROOM - 1);
    *id =
        app->load_count > 0 ? app->loads[random_app_below(app, app->load_count)].id : some_id(app);
    for (uint32_t i = 0; i < app->load_count && count < most;) {
        if (app->loads[i].id != *id || one_in(app, 4)) {
            i++;
            continue;
        }
        tiles[count++] = app->loads[i].tile;
        app->loads[i] = app->loads[--app->load_count];
    }
    if (one_in(app, 30))
        tiles[count++] = random_app_below(app, 300);
    return count;
}

static SluiceResult answer(struct random_app *app, enum slc_call_kind kind)
{
    uint32_t tiles[LIST_ROOM];
    SluiceTextureId id;
    uint32_t count = take_loads(app, &id, tiles);
    const uint32_t *given = one_in(app, 60) ? NULL : tiles;
    SluiceResult result;
    if (kind == SLC_CALL_UPDATE_MAPPING)
        result = sluiceUpdateTilesMapping(app->manager, id, count, given);
    else if (kind == SLC_CALL_REPORT_FAILED)
        result = sluiceReportFailedTiles(app->manager, id, count, given, next_time(app));
    else
        result = sluiceReportCanceledTiles(app->manager, id, count, given, next_retire(app));
    /* Refused loads still await an answer, unless the texture was removed. */
    for (uint32_t i = 0; result < SLUICE_SUCCESS && result != SLUICE_ERROR_STALE_TEXTURE &&
                         i < count && app->load_count < RANDOM_APP_LOADS;
         i++) {
        app->loads[app->load_count].id = id;
        app->loads[app->load_count++].tile = tiles[i];
    }
    return result;
}

static SluiceResult get_tiles_to_cancel(struct random_app *app)
{
    SluiceTile tiles[LIST_ROOM];
    uint32_t count = random_app_below(app, LIST_ROOM);
    SluiceTextureId id = id_or(app, SLUICE_ALL_TEXTURES);
    return sluiceGetTilesToCancel(app->manager, id, &count, one_in(app, 10) ? NULL : tiles);
}

static SluiceResult get_tiles_to_unmap(struct random_app *app)
{
    SluiceTile tiles[LIST_ROOM];
    uint32_t count = random_app_below(app, LIST_ROOM);
    SluiceTextureId id = id_or(app, SLUICE_ALL_TEXTURES);
    uint64_t retire = next_retire(app);
    return sluiceGetTilesToUnmap(app->manager, id, retire, &count, one_in(app, 10) ? NULL : tiles);
}

static SluiceResult get_other_list(struct random_app *app, enum slc_call_kind kind)
{
    SluiceTile tiles[LIST_ROOM];
    SluiceTileMove moves[LIST_ROOM];
    SluiceMinMipRect rects[LIST_ROOM];
    uint32_t count = random_app_below(app, LIST_ROOM);
    bool query = one_in(app, 10);
    switch (kind) {
    case SLC_CALL_GET_GIVEN_UP:
        return sluiceGetGivenUpTiles(app->manager, &count, query ? NULL : tiles);
    case SLC_CALL_GET_MINMIP_UPDATES:
        return sluiceGetMinMipUpdates(app->manager, &count, query ? NULL : rects);
    default: return sluiceDefragmentTiles(app->manager, next_retire(app), &count, moves);
    }
}

static SluiceResult set_config(struct random_app *app)
{
    SluiceStreamedTextureManagerConfig config = {.structSize = sizeof config};
    config.numExtraStandbyTiles = random_app_below(app, 30);
    config.maxHeapCount = random_app_below(app, RANDOM_APP_HEAPS);
    config.maxLoadAttempts = random_app_below(app, 3);
    config.retryDelayTicks = random_app_below(app, 4);
    config.missesToExpire = random_app_below(app, 3);
    config.prefetchLevels = random_app_below(app, 3);
    config.givenUpRetryDelayTicks = one_in(app, 3) ? UINT64_MAX : random_app_below(app, 10);
    return sluiceSetConfig(app->manager, one_in(app, 20) ? NULL : &config);
}

static SluiceResult complete_retire(struct random_app *app)
{
    if (app->completed + 2 < app->retire)
        app->completed += random_app_below(app, (uint32_t)(app->retire - app->completed));
    return sluiceCompleteRetireValue(app->manager,
                                     one_in(app, 30) && app->completed ? 0 : app->completed);
}

static SluiceResult release_a_heap(struct random_app *app)
{
    uint32_t heaps[RANDOM_APP_HEAPS];
    uint32_t count = RANDOM_APP_HEAPS;
    if (sluiceGetEmptyHeaps(app->manager, &count, heaps) >= SLUICE_SUCCESS && count > 0)
        return sluiceReleaseHeap(app->manager, heaps[random_app_below(app, count)]);
    return sluiceReleaseHeap(app->manager, 1000 * random_app_below(app, 2 * RANDOM_APP_HEAPS));
}

static SluiceResult match_primary(struct random_app *app)
{
    SluiceTextureId primary = some_id(app), follower = some_id(app);
    uint64_t time = next_time(app), timeout = random_app_below(app, 12);
    return sluiceMatchPrimaryTexture(app->manager, primary, follower, time, timeout);
}

static SluiceResult set_primary(struct random_app *app)
{
    SluiceTextureId follower = some_id(app), primary = id_or(app, SLUICE_NO_TEXTURE);
    return sluiceSetPrimaryTexture(app->manager, follower, primary);
}

static SluiceResult remove_texture(struct random_app *app)
{
    SluiceTextureId id = some_id(app);
    return sluiceRemoveStreamedTexture(app->manager, id, next_retire(app));
}

static SluiceResult make_call(struct random_app *app, enum slc_call_kind kind)
{
    switch (kind) {
    case SLC_CALL_SET_CONFIG: return set_config(app);
    case SLC_CALL_ADD_TEXTURE: return add_texture(app);
    case SLC_CALL_REMOVE_TEXTURE: return remove_texture(app);
    case SLC_CALL_UPDATE_FEEDBACK: return give_feedback(app);
    case SLC_CALL_MATCH_PRIMARY: return match_primary(app);
    case SLC_CALL_SET_PRIMARY: return set_primary(app);
    case SLC_CALL_GET_TILES_TO_MAP: return get_tiles_to_map(app);
    case SLC_CALL_UPDATE_MAPPING:
    case SLC_CALL_REPORT_FAILED:
    case SLC_CALL_REPORT_CANCELED: return answer(app, kind);
    case SLC_CALL_RETRY_FAILED:
        return sluiceRetryFailedTiles(app->manager, id_or(app, SLUICE_ALL_TEXTURES));
    case SLC_CALL_GET_TILES_TO_CANCEL: return get_tiles_to_cancel(app);
    case SLC_CALL_GET_TILES_TO_UNMAP: return get_tiles_to_unmap(app);
    case SLC_CALL_COMPLETE_RETIRE: return complete_retire(app);
    case SLC_CALL_TRIM_STANDBY:
        return sluiceTrimStandbyTiles(app->manager, random_app_below(app, 10));
    case SLC_CALL_RELEASE_HEAP: return release_a_heap(app);
    default: return get_other_list(app, kind);
    }
}

/* Returns a kind of call, about as often as applications make it. */
static enum slc_call_kind some_kind(struct random_app *app)
{
    static const uint8_t kinds[] = {
        SLC_CALL_UPDATE_FEEDBACK,     SLC_CALL_UPDATE_FEEDBACK,    SLC_CALL_UPDATE_FEEDBACK,
        SLC_CALL_GET_TILES_TO_MAP,    SLC_CALL_GET_TILES_TO_MAP,   SLC_CALL_GET_TILES_TO_MAP,
        SLC_CALL_UPDATE_MAPPING,      SLC_CALL_UPDATE_MAPPING,     SLC_CALL_UPDATE_MAPPING,
        SLC_CALL_GET_TILES_TO_CANCEL, SLC_CALL_REPORT_CANCELED,    SLC_CALL_GET_TILES_TO_UNMAP,
        SLC_CALL_COMPLETE_RETIRE,     SLC_CALL_GET_MINMIP_UPDATES, SLC_CALL_MATCH_PRIMARY,
    };
    uint32_t i = random_app_below(app, sizeof kinds + SLC_CALL_GET_MINMIP_UPDATES / 3);
    if (i < sizeof kinds)
        return (enum slc_call_kind)kinds[i];
    return (enum slc_call_kind)(1 + random_app_below(app, SLC_CALL_GET_MINMIP_UPDATES));
}

void random_app_run(struct random_app *app, uint32_t steps)
{
    for (uint32_t i = 0; i < steps; i++) {
        enum slc_call_kind kind = app->id_count < 2 ? SLC_CALL_ADD_TEXTURE : some_kind(app);
        if (app->starved && one_in(app, 25)) /* for one call */
            app->memory.refuse_from = app->memory.calls + random_app_below(app, 2);
        SluiceResult result = make_call(app, kind);
        app->memory.refuse_from = UINT64_MAX;
        app->kinds_made |= UINT64_C(1) << kind;
        if (result >= SLUICE_SUCCESS)
            app->kinds_good |= UINT64_C(1) << kind;
        app->out_of_memory_count += result == SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
}

void check_same_statistics(const SluiceStreamedTextureManager *manager,
                           const SluiceStreamedTextureStatistics *b)
{
    SluiceStreamedTextureStatistics a = {.structSize = sizeof a};
    CHECK_OK(sluiceGetStatistics(manager, &a));
    assert_int_equal(a.textureCount, b->textureCount);
    assert_int_equal(a.tileCount, b->tileCount);
    assert_int_equal(a.requestedTileCount, b->requestedTileCount);
    assert_int_equal(a.allocatedTileCount, b->allocatedTileCount);
    assert_int_equal(a.mappedTileCount, b->mappedTileCount);
    assert_int_equal(a.standbyTileCount, b->standbyTileCount);
    assert_int_equal(a.canceledTileCount, b->canceledTileCount);
    assert_int_equal(a.failedTileCount, b->failedTileCount);
    assert_int_equal(a.givenUpTileCount, b->givenUpTileCount);
    assert_int_equal(a.retiringSlotCount, b->retiringSlotCount);
    assert_int_equal(a.heapCount, b->heapCount);
    assert_int_equal(a.freeSlotCount, b->freeSlotCount);
    assert_int_equal(a.handedOutTotal, b->handedOutTotal);
    assert_int_equal(a.mappedTotal, b->mappedTotal);
    assert_int_equal(a.unmappedTotal, b->unmappedTotal);
    assert_int_equal(a.canceledTotal, b->canceledTotal);
    assert_int_equal(a.failedTotal, b->failedTotal);
    assert_int_equal(a.restoredTotal, b->restoredTotal);
    assert_int_equal(a.movedTotal, b->movedTotal);
}

static SluiceResult append(void *user, const void *data, size_t size)
{
    struct trace_buffer *buffer = user;
    if (buffer->size + size > buffer->full_at)
        return SLUICE_ERROR_IO;
    if (buffer->size + size > buffer->capacity) {
        buffer->capacity = 2 * (buffer->size + size);
        buffer->data = realloc(buffer->data, buffer->capacity);
        assert_non_null(buffer->data);
    }
    memcpy(buffer->data + buffer->size, data, size);
    buffer->size += size;
    return SLUICE_SUCCESS;
}

SluiceRecordWriter trace_buffer_writer(struct trace_buffer *buffer)
{
    *buffer = (struct trace_buffer){.full_at = SIZE_MAX};
    return (SluiceRecordWriter){buffer, append};
}

void trace_buffer_free(struct trace_buffer *buffer)
{
    free(buffer->data);
    *buffer = (struct trace_buffer){0};
}

void record_late_run(struct trace_buffer *buffer, uint64_t seed, uint32_t before, uint32_t steps)
{
    struct random_app app;
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(buffer);
    random_app_init(&app, seed, false);
    random_app_run(&app, before);
    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    random_app_run(&app, steps);
    CHECK_OK(sluiceEndRecording(recorder));
    random_app_finish(&app);
}

void record_random_run(struct trace_buffer *buffer, uint64_t seed, uint32_t steps, bool starved)
{
    struct random_app app;
    SluiceRecorder *recorder;
    const SluiceRecordWriter writer = trace_buffer_writer(buffer);
    random_app_init(&app, seed, starved);
    CHECK_OK(sluiceBeginRecording(app.manager, &writer, NULL, &recorder));
    random_app_run(&app, steps);
    CHECK_OK(sluiceEndRecording(recorder));
    random_app_finish(&app);
}
