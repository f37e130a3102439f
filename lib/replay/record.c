#include "replay/record.h"

#include "replay/runs.h"

#include <string.h>

uint32_t slc_call_fields(uint32_t kind)
{
    static const uint16_t fields[] = {
        [SLC_CALL_SET_CONFIG] = SLC_FIELD_CONFIG,
        [SLC_CALL_ADD_TEXTURE] = SLC_FIELD_DESC,
        [SLC_CALL_REMOVE_TEXTURE] = SLC_FIELD_TEXTURE | SLC_FIELD_RETIRE,
        [SLC_CALL_UPDATE_FEEDBACK] =
            SLC_FIELD_TEXTURE | SLC_FIELD_TIME | SLC_FIELD_TIMEOUT | SLC_FIELD_FEEDBACK,
        [SLC_CALL_MATCH_PRIMARY] =
            SLC_FIELD_TEXTURE | SLC_FIELD_PRIMARY | SLC_FIELD_TIME | SLC_FIELD_TIMEOUT,
        [SLC_CALL_SET_PRIMARY] = SLC_FIELD_TEXTURE | SLC_FIELD_PRIMARY,
        [SLC_CALL_GET_TILES_TO_MAP] = SLC_FIELD_TEXTURE | SLC_FIELD_LIST,
        [SLC_CALL_UPDATE_MAPPING] = SLC_FIELD_TEXTURE | SLC_FIELD_INDICES,
        [SLC_CALL_REPORT_FAILED] = SLC_FIELD_TEXTURE | SLC_FIELD_TIME | SLC_FIELD_INDICES,
        [SLC_CALL_RETRY_FAILED] = SLC_FIELD_TEXTURE,
        [SLC_CALL_GET_GIVEN_UP] = SLC_FIELD_LIST,
        [SLC_CALL_GET_TILES_TO_CANCEL] = SLC_FIELD_TEXTURE | SLC_FIELD_LIST,
        [SLC_CALL_REPORT_CANCELED] = SLC_FIELD_TEXTURE | SLC_FIELD_RETIRE | SLC_FIELD_INDICES,
        [SLC_CALL_GET_TILES_TO_UNMAP] = SLC_FIELD_TEXTURE | SLC_FIELD_RETIRE | SLC_FIELD_LIST,
        [SLC_CALL_COMPLETE_RETIRE] = SLC_FIELD_RETIRE,
        [SLC_CALL_TRIM_STANDBY] = SLC_FIELD_KEEP,
        [SLC_CALL_EVACUATE_HEAPS] = SLC_FIELD_KEEP,
        [SLC_CALL_FORGET_TEXTURE] = SLC_FIELD_TEXTURE | SLC_FIELD_RETIRE,
        [SLC_CALL_EVICT_TEXTURE] = SLC_FIELD_TEXTURE | SLC_FIELD_KEEP,
        [SLC_CALL_SET_UV] = SLC_FIELD_TEXTURE | SLC_FIELD_UV,
        [SLC_CALL_SET_PRIORITY] = SLC_FIELD_TEXTURE | SLC_FIELD_PRIORITY,
        [SLC_CALL_DEFRAGMENT] = SLC_FIELD_RETIRE | SLC_FIELD_LIST,
        [SLC_CALL_RELEASE_HEAP] = SLC_FIELD_HEAP,
        [SLC_CALL_GET_MINMIP_UPDATES] = SLC_FIELD_LIST,
        [SLC_CALL_HEAP_ANSWER] = SLC_FIELD_HEAP,
    };
    return kind < sizeof fields / sizeof *fields ? fields[kind] : 0;
}

/* Swaps SLUICE_ALL_TEXTURES and SLUICE_NO_TEXTURE in calls that take both, for writing and reading.
 * Recordings store all textures as 0, the former value of SLUICE_ALL_TEXTURES. */
static SluiceTextureId swap_all(uint32_t kind, SluiceTextureId id)
{
    switch (kind) {
    case SLC_CALL_GET_TILES_TO_MAP:
    case SLC_CALL_GET_TILES_TO_CANCEL:
    case SLC_CALL_GET_TILES_TO_UNMAP:
    case SLC_CALL_RETRY_FAILED:
        return id == SLUICE_ALL_TEXTURES ? SLUICE_NO_TEXTURE
               : id == SLUICE_NO_TEXTURE ? SLUICE_ALL_TEXTURES
                                         : id;
    default: return id;
    }
}

static void put_id(struct slc_bytes *out, SluiceTextureId id)
{
    slc_put_varint(out, (uint32_t)id);
    slc_put_varint(out, id >> 32);
}

/** Replaces SLC_INPUT_PRESENT for a configuration with newer fields. */
#define CONFIG_WITH_MORE (SLC_INPUT_PRESENT + 1)
#define CONFIG_WITH_RETRIES (SLC_INPUT_PRESENT + 2)
#define CONFIG_WITH_SWITCHES (SLC_INPUT_PRESENT + 3)
/** Replaces SLC_INPUT_PRESENT for a texture whose packed tiles take no slots. */
#define DESC_WITH_TILES_OUTSIDE (SLC_INPUT_PRESENT + 1)

enum { SWITCH_NO_EVICTION = 1, SWITCH_NO_MIP_BIAS = 2, SWITCH_SEPARATE_PACKED = 4 };

/* Returns the retry setting for recordings without the field. If retryDelayTicks is 0, 0 means the
 * same as UINT64_MAX. */
static uint64_t untold_retries(const SluiceStreamedTextureManagerConfig *config)
{
    return config->retryDelayTicks ? UINT64_MAX : 0;
}

static void put_config(struct slc_bytes *out, const SluiceStreamedTextureManagerConfig *config)
{
    bool more = config && (config->missesToExpire || config->prefetchLevels);
    bool switches = config && (config->targetHeapCount || config->noEviction || config->noMipBias ||
                               config->separatePackedTiles);
    bool retries = config && (switches || config->givenUpRetryDelayTicks != untold_retries(config));
    slc_put_u8(out, !config    ? SLC_INPUT_NULL
                    : switches ? CONFIG_WITH_SWITCHES
                    : retries  ? CONFIG_WITH_RETRIES
                    : more     ? CONFIG_WITH_MORE
                               : SLC_INPUT_PRESENT);
    if (!config)
        return;
    slc_put_varint(out, config->numExtraStandbyTiles);
    slc_put_varint(out, config->maxHeapCount);
    slc_put_varint(out, config->maxLoadAttempts);
    slc_put_varint(out, config->retryDelayTicks);
    if (!more && !retries)
        return;
    slc_put_varint(out, config->missesToExpire);
    slc_put_varint(out, config->prefetchLevels);
    if (retries)
        slc_put_varint(out, config->givenUpRetryDelayTicks);
    if (!switches)
        return;
    slc_put_varint(out, config->targetHeapCount);
    slc_put_u8(out, (config->noEviction ? SWITCH_NO_EVICTION : 0) |
                        (config->noMipBias ? SWITCH_NO_MIP_BIAS : 0) |
                        (config->separatePackedTiles ? SWITCH_SEPARATE_PACKED : 0));
}

static void put_desc(struct slc_bytes *out, const struct slc_call *call)
{
    const SluiceStreamedTextureDesc *desc = call->desc;
    slc_put_u8(out, !desc                      ? SLC_INPUT_NULL
                    : desc->packedTilesOutside ? DESC_WITH_TILES_OUTSIDE
                                               : SLC_INPUT_PRESENT);
    if (!desc)
        return;
    slc_put_varint(out, desc->width);
    slc_put_varint(out, desc->height);
    slc_put_varint(out, desc->mipLevelCount);
    slc_put_varint(out, desc->regularMipCount);
    slc_put_varint(out, desc->packedTileCount);
    slc_put_varint(out, desc->tileWidth);
    slc_put_varint(out, desc->tileHeight);
    slc_put_varint(out, desc->feedbackRegionWidth);
    slc_put_varint(out, desc->feedbackRegionHeight);
    if (call->result >= SLUICE_SUCCESS)
        put_id(out, call->texture_id);
}

static void put_feedback(struct slc_bytes *out, const struct slc_call *call)
{
    const SluiceFeedbackDesc *feedback = call->feedback;
    slc_put_u8(out, feedback ? SLC_INPUT_PRESENT : SLC_INPUT_NULL);
    if (!feedback)
        return;
    slc_put_varint(out, feedback->width);
    slc_put_varint(out, feedback->height);
    slc_put_signed(out, feedback->mipBias);
    slc_put_varint(out, feedback->streamedMipLevels);
    /* A refused call may have any size without a map of this size. */
    bool kept = feedback->pMinMip && call->result >= SLUICE_SUCCESS;
    slc_put_u8(out, kept                ? SLC_INPUT_PRESENT
                    : feedback->pMinMip ? SLC_INPUT_ABSENT
                                        : SLC_INPUT_NULL);
    if (kept)
        slc_put_map(out, feedback->pMinMip, (size_t)feedback->width * feedback->height);
}

/* Tells whether the manager read the list. The count of a list for an unknown texture is invalid.
 */
static bool indices_were_read(SluiceResult result)
{
    return result != SLUICE_ERROR_UNKNOWN_TEXTURE && result != SLUICE_ERROR_STALE_TEXTURE &&
           result != SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static void put_indices(struct slc_bytes *out, const struct slc_call *call)
{
    bool kept = call->tile_indices && indices_were_read(call->result);
    slc_put_varint(out, call->count);
    slc_put_u8(out, kept                 ? SLC_INPUT_PRESENT
                    : call->tile_indices ? SLC_INPUT_ABSENT
                                         : SLC_INPUT_NULL);
    uint32_t last = 0;
    for (uint32_t i = 0; kept && i < call->count; i++) {
        slc_put_signed(out, (int64_t)call->tile_indices[i] - last);
        last = call->tile_indices[i];
    }
}

static void put_float(struct slc_bytes *out, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    slc_put_u32(out, bits);
}

static void put_uv(struct slc_bytes *out, const SluiceUvTransform *uv)
{
    slc_put_u8(out, uv ? SLC_INPUT_PRESENT : SLC_INPUT_NULL);
    if (!uv)
        return;
    put_float(out, uv->scaleU);
    put_float(out, uv->scaleV);
    put_float(out, uv->offsetU);
    put_float(out, uv->offsetV);
    slc_put_varint(out, (uint32_t)uv->wrapU);
    slc_put_varint(out, (uint32_t)uv->wrapV);
}

static void put_list(struct slc_bytes *out, const struct slc_call *call, uint64_t hash)
{
    slc_put_u8(out, call->query);
    slc_put_varint(out, call->room);
    slc_put_varint(out, call->count);
    slc_put_u64(out, hash);
}

void slc_put_record(struct slc_bytes *out, const struct slc_call *call, uint64_t hash)
{
    uint32_t fields = slc_call_fields(call->kind);
    slc_put_u8(out, (uint8_t)call->kind);
    slc_put_signed(out, call->result);
    if (fields & SLC_FIELD_TEXTURE)
        put_id(out, swap_all(call->kind, call->texture_id));
    if (fields & SLC_FIELD_PRIMARY)
        put_id(out, call->primary_id);
    if (fields & SLC_FIELD_TIME)
        slc_put_varint(out, call->time_stamp);
    if (fields & SLC_FIELD_TIMEOUT)
        slc_put_varint(out, call->timeout);
    if (fields & SLC_FIELD_RETIRE)
        slc_put_varint(out, call->retire_value);
    if (fields & SLC_FIELD_KEEP)
        slc_put_varint(out, call->keep_count);
    if (fields & SLC_FIELD_HEAP)
        slc_put_varint(out, call->heap_id);
    if (fields & SLC_FIELD_CONFIG)
        put_config(out, call->config);
    if (fields & SLC_FIELD_DESC)
        put_desc(out, call);
    if (fields & SLC_FIELD_FEEDBACK)
        put_feedback(out, call);
    if (fields & SLC_FIELD_INDICES)
        put_indices(out, call);
    if (fields & SLC_FIELD_LIST)
        put_list(out, call, hash);
    if (fields & SLC_FIELD_UV)
        put_uv(out, call->uv);
    if (fields & SLC_FIELD_PRIORITY)
        slc_put_signed(out, call->priority);
}

static SluiceTextureId get_id(struct slc_cursor *in)
{
    SluiceTextureId index = slc_get_varint32(in);
    SluiceTextureId generation = slc_get_varint32(in);
    return generation << 32 | index;
}

static enum slc_input get_input(struct slc_cursor *in)
{
    size_t start = in->pos;
    uint8_t value = slc_get_u8(in);
    if (value > SLC_INPUT_PRESENT)
        slc_cursor_fail(in, start, "a mark of presence is above 2");
    return in->why ? SLC_INPUT_NULL : (enum slc_input)value;
}

static void get_switches(struct slc_cursor *in, SluiceStreamedTextureManagerConfig *config)
{
    config->targetHeapCount = slc_get_varint32(in);
    size_t start = in->pos;
    uint8_t switches = slc_get_u8(in);
    if (switches > (SWITCH_NO_EVICTION | SWITCH_NO_MIP_BIAS | SWITCH_SEPARATE_PACKED))
        slc_cursor_fail(in, start, "a configuration has unknown switches");
    config->noEviction = switches & SWITCH_NO_EVICTION;
    config->noMipBias = switches & SWITCH_NO_MIP_BIAS;
    config->separatePackedTiles = switches & SWITCH_SEPARATE_PACKED;
}

static void get_config(struct slc_cursor *in, struct slc_record *record)
{
    size_t start = in->pos;
    uint8_t mark = slc_get_u8(in);
    if (mark > CONFIG_WITH_SWITCHES)
        slc_cursor_fail(in, start, "a configuration's mark of presence is above 5");
    if (in->why || mark == SLC_INPUT_NULL)
        return;
    record->config.structSize = sizeof record->config;
    record->config.numExtraStandbyTiles = slc_get_varint32(in);
    record->config.maxHeapCount = slc_get_varint32(in);
    record->config.maxLoadAttempts = slc_get_varint32(in);
    record->config.retryDelayTicks = slc_get_varint(in);
    if (mark >= CONFIG_WITH_MORE) {
        record->config.missesToExpire = slc_get_varint32(in);
        record->config.prefetchLevels = slc_get_varint32(in);
    }
    record->config.givenUpRetryDelayTicks = untold_retries(&record->config);
    if (mark >= CONFIG_WITH_RETRIES)
        record->config.givenUpRetryDelayTicks = slc_get_varint(in);
    if (mark == CONFIG_WITH_SWITCHES)
        get_switches(in, &record->config);
    record->call.config = &record->config;
}

static void get_desc(struct slc_cursor *in, struct slc_record *record)
{
    size_t start = in->pos;
    uint8_t mark = slc_get_u8(in);
    if (mark > DESC_WITH_TILES_OUTSIDE)
        slc_cursor_fail(in, start, "a texture's mark of presence is above 3");
    if (in->why || mark == SLC_INPUT_NULL)
        return;
    SluiceStreamedTextureDesc *desc = &record->desc;
    desc->packedTilesOutside = mark == DESC_WITH_TILES_OUTSIDE;
    desc->width = slc_get_varint32(in);
    desc->height = slc_get_varint32(in);
    desc->mipLevelCount = slc_get_varint32(in);
    desc->regularMipCount = slc_get_varint32(in);
    desc->packedTileCount = slc_get_varint32(in);
    desc->tileWidth = slc_get_varint32(in);
    desc->tileHeight = slc_get_varint32(in);
    desc->feedbackRegionWidth = slc_get_varint32(in);
    desc->feedbackRegionHeight = slc_get_varint32(in);
    record->call.desc = desc;
    if (record->call.result >= SLUICE_SUCCESS)
        record->call.texture_id = get_id(in);
}

static void get_feedback(struct slc_cursor *in, struct slc_record *record)
{
    if (get_input(in) == SLC_INPUT_NULL)
        return;
    SluiceFeedbackDesc *feedback = &record->feedback;
    feedback->structSize = sizeof *feedback;
    feedback->width = slc_get_varint32(in);
    feedback->height = slc_get_varint32(in);
    feedback->mipBias = slc_get_signed32(in);
    feedback->streamedMipLevels = slc_get_varint32(in);
    record->call.feedback = feedback;
    record->contents = get_input(in);
    if (record->contents != SLC_INPUT_PRESENT)
        return;
    uint64_t size = slc_get_varint(in);
    size_t start = in->pos;
    if (!slc_get_bytes(in, size))
        return;
    record->encoded = (struct slc_cursor){in->data, start, in->pos, NULL};
    /* Check runs here; later, only the size can differ from the texture's. */
    struct slc_cursor runs = record->encoded;
    slc_get_runs(&runs, NULL, (size_t)feedback->width * feedback->height);
    if (runs.why)
        slc_cursor_fail(in, runs.pos, runs.why);
}

static void get_indices(struct slc_cursor *in, struct slc_record *record)
{
    record->call.count = slc_get_varint32(in);
    record->contents = get_input(in);
    if (record->contents != SLC_INPUT_PRESENT)
        return;
    record->encoded = *in;
    int64_t index = 0;
    for (uint32_t i = 0; !in->why && i < record->call.count; i++) {
        size_t start = in->pos;
        int64_t step = slc_get_signed(in);
        /* Check the step first, because the sum might overflow. */
        if (step < -(int64_t)UINT32_MAX || step > UINT32_MAX || index + step < 0 ||
            index + step > UINT32_MAX)
            slc_cursor_fail(in, start, "a tile index does not fit 32 bits");
        else
            index += step;
    }
}

static float get_float(struct slc_cursor *in)
{
    uint32_t bits = slc_get_u32(in);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void get_uv(struct slc_cursor *in, struct slc_record *record)
{
    if (get_input(in) == SLC_INPUT_NULL)
        return;
    record->uv.scaleU = get_float(in);
    record->uv.scaleV = get_float(in);
    record->uv.offsetU = get_float(in);
    record->uv.offsetV = get_float(in);
    record->uv.wrapU = (SluiceUvWrap)slc_get_varint32(in);
    record->uv.wrapV = (SluiceUvWrap)slc_get_varint32(in);
    record->call.uv = &record->uv;
}

static void get_list(struct slc_cursor *in, struct slc_record *record)
{
    size_t start = in->pos;
    uint8_t query = slc_get_u8(in);
    if (query > 1)
        slc_cursor_fail(in, start, "a flag is neither 0 nor 1");
    record->call.query = query == 1;
    record->call.room = slc_get_varint32(in);
    record->call.count = slc_get_varint32(in);
    record->hash = slc_get_u64(in);
}

void slc_get_record(struct slc_cursor *in, struct slc_record *record)
{
    memset(record, 0, sizeof *record);
    struct slc_call *call = &record->call;
    size_t start = in->pos;
    uint8_t kind = slc_get_u8(in);
    uint32_t fields = slc_call_fields(kind);
    if (!fields)
        slc_cursor_fail(in, start, "no call has this number");
    call->kind = (enum slc_call_kind)kind;
    call->result = (SluiceResult)slc_get_signed32(in);
    if (fields & SLC_FIELD_TEXTURE)
        call->texture_id = swap_all(kind, get_id(in));
    if (fields & SLC_FIELD_PRIMARY)
        call->primary_id = get_id(in);
    if (fields & SLC_FIELD_TIME)
        call->time_stamp = slc_get_varint(in);
    if (fields & SLC_FIELD_TIMEOUT)
        call->timeout = slc_get_varint(in);
    if (fields & SLC_FIELD_RETIRE)
        call->retire_value = slc_get_varint(in);
    if (fields & SLC_FIELD_KEEP)
        call->keep_count = slc_get_varint32(in);
    if (fields & SLC_FIELD_HEAP)
        call->heap_id = slc_get_varint32(in);
    if (fields & SLC_FIELD_CONFIG)
        get_config(in, record);
    if (fields & SLC_FIELD_DESC)
        get_desc(in, record);
    if (fields & SLC_FIELD_FEEDBACK)
        get_feedback(in, record);
    if (fields & SLC_FIELD_INDICES)
        get_indices(in, record);
    if (fields & SLC_FIELD_LIST)
        get_list(in, record);
    if (fields & SLC_FIELD_UV)
        get_uv(in, record);
    if (fields & SLC_FIELD_PRIORITY)
        call->priority = slc_get_signed32(in);
}

void slc_get_tile_indices(struct slc_record *record, uint32_t *indices)
{
    struct slc_cursor in = record->encoded;
    uint32_t last = 0;
    for (uint32_t i = 0; i < record->call.count; i++) {
        last = (uint32_t)(last + (uint64_t)slc_get_signed(&in));
        indices[i] = last;
    }
}
