#include "replay/dump.h"

#include "replay/decisions.h"
#include "replay/record.h"

#include <inttypes.h>
#include <stdio.h>

/* Column after which runs of texels continue on a new line. */
#define WRAP 96

static const char *const call_names[] = {
    [SLC_CALL_SET_CONFIG] = "set-config",
    [SLC_CALL_ADD_TEXTURE] = "add-texture",
    [SLC_CALL_REMOVE_TEXTURE] = "remove-texture",
    [SLC_CALL_UPDATE_FEEDBACK] = "update-feedback",
    [SLC_CALL_MATCH_PRIMARY] = "match-primary",
    [SLC_CALL_SET_PRIMARY] = "set-primary",
    [SLC_CALL_GET_TILES_TO_MAP] = "get-tiles-to-map",
    [SLC_CALL_UPDATE_MAPPING] = "update-mapping",
    [SLC_CALL_REPORT_FAILED] = "report-failed",
    [SLC_CALL_RETRY_FAILED] = "retry-failed",
    [SLC_CALL_GET_GIVEN_UP] = "get-given-up",
    [SLC_CALL_GET_TILES_TO_CANCEL] = "get-tiles-to-cancel",
    [SLC_CALL_REPORT_CANCELED] = "report-canceled",
    [SLC_CALL_GET_TILES_TO_UNMAP] = "get-tiles-to-unmap",
    [SLC_CALL_COMPLETE_RETIRE] = "complete-retire",
    [SLC_CALL_TRIM_STANDBY] = "trim-standby",
    [SLC_CALL_EVACUATE_HEAPS] = "evacuate-heaps",
    [SLC_CALL_FORGET_TEXTURE] = "forget-texture",
    [SLC_CALL_EVICT_TEXTURE] = "evict-texture",
    [SLC_CALL_SET_UV] = "set-uv-transform",
    [SLC_CALL_SET_PRIORITY] = "set-priority",
    [SLC_CALL_DEFRAGMENT] = "defragment",
    [SLC_CALL_RELEASE_HEAP] = "release-heap",
    [SLC_CALL_GET_MINMIP_UPDATES] = "get-minmip-updates",
    [SLC_CALL_HEAP_ANSWER] = "allocate-heap",
};

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
add(struct slc_dump *dump, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    size_t room = sizeof dump->text - dump->size;
    int size = vsnprintf(dump->text + dump->size, room, format, args);
    va_end(args);
    if (size > 0)
        dump->size += (size_t)size < room ? (size_t)size : room - 1;
}

static void end_line(struct slc_dump *dump)
{
    dump->line(dump->user, dump->text);
    dump->size = 0;
}

void slc_dump_line(struct slc_dump *dump, const char *format, ...)
{
    if (!dump->line)
        return;
    va_list args;
    va_start(args, format);
    vsnprintf(dump->text, sizeof dump->text, format, args);
    va_end(args);
    end_line(dump);
}

static void add_id(struct slc_dump *dump, const char *name, SluiceTextureId id)
{
    if (id == SLUICE_NO_TEXTURE)
        add(dump, " %s=none", name);
    else if (id == SLUICE_ALL_TEXTURES)
        add(dump, " %s=all", name);
    else
        add(dump, " %s=%" PRIu32 ".%" PRIu32, name, (uint32_t)id, (uint32_t)(id >> 32));
}

/* Printer of texels as "value" or "valuexcount", wrapped. A run may span several pieces. */
struct texel_runs {
    struct slc_dump *dump;
    const char *name;
    uint8_t value;
    uint64_t count;
};

static void end_run(struct texel_runs *runs)
{
    struct slc_dump *dump = runs->dump;
    if (runs->count == 0)
        return;
    if (dump->size > WRAP)
        end_line(dump);
    if (dump->size == 0)
        add(dump, "%" PRIu64 " %s", dump->event, runs->name);
    add(dump, runs->count > 1 ? " %ux%" PRIu64 : " %u", runs->value, runs->count);
    runs->count = 0;
}

static void add_texels(void *user, const uint8_t *texels, size_t count)
{
    struct texel_runs *runs = user;
    for (size_t i = 0; i < count; i++) {
        if (texels[i] != runs->value)
            end_run(runs);
        runs->value = texels[i];
        runs->count++;
    }
}

static void end_texels(struct texel_runs *runs)
{
    end_run(runs);
    if (runs->dump->size > 0)
        end_line(runs->dump);
}

static void add_desc(struct slc_dump *dump, const SluiceStreamedTextureDesc *d)
{
    if (!d) {
        add(dump, " desc=null");
        return;
    }
    add(dump, " size=%" PRIu32 "x%" PRIu32, d->width, d->height);
    add(dump, " levels=%" PRIu32 " regular=%" PRIu32 " packed-tiles=%" PRIu32, d->mipLevelCount,
        d->regularMipCount, d->packedTileCount);
    add(dump, " tile=%" PRIu32 "x%" PRIu32, d->tileWidth, d->tileHeight);
    add(dump, " region=%" PRIu32 "x%" PRIu32, d->feedbackRegionWidth, d->feedbackRegionHeight);
    if (d->packedTilesOutside)
        add(dump, " packed-tiles-outside");
}

static void add_config(struct slc_dump *dump, const SluiceStreamedTextureManagerConfig *c)
{
    if (!c) {
        add(dump, " config=null");
        return;
    }
    add(dump, " standby=%" PRIu32 " heaps=%" PRIu32 " attempts=%" PRIu32, c->numExtraStandbyTiles,
        c->maxHeapCount, c->maxLoadAttempts);
    add(dump, " retry-delay=%" PRIu64, c->retryDelayTicks);
    if (c->missesToExpire || c->prefetchLevels)
        add(dump, " misses=%" PRIu32 " prefetch=%" PRIu32, c->missesToExpire, c->prefetchLevels);
    if (c->givenUpRetryDelayTicks != 0 && c->givenUpRetryDelayTicks != UINT64_MAX)
        add(dump, " given-up-retry-delay=%" PRIu64, c->givenUpRetryDelayTicks);
    if (c->targetHeapCount)
        add(dump, " target-heaps=%" PRIu32, c->targetHeapCount);
    add(dump, "%s%s%s", c->noEviction ? " no-eviction" : "", c->noMipBias ? " no-mip-bias" : "",
        c->separatePackedTiles ? " separate-packed-tiles" : "");
}

static void add_feedback(struct slc_dump *dump, const SluiceFeedbackDesc *f)
{
    if (!f) {
        add(dump, " feedback=null");
        return;
    }
    add(dump, " size=%" PRIu32 "x%" PRIu32 " bias=%" PRId32 " levels=%" PRIu32, f->width, f->height,
        f->mipBias, f->streamedMipLevels);
    if (!f->pMinMip)
        add(dump, " map=null");
}

static void dump_map(struct slc_dump *dump, const SluiceFeedbackDesc *f)
{
    struct texel_runs runs = {dump, "map", 0, 0};
    add_texels(&runs, f->pMinMip, (size_t)f->width * f->height);
    end_texels(&runs);
}

static void add_indices(struct slc_dump *dump, const struct slc_call *call)
{
    add(dump, " count=%" PRIu32, call->count);
    bool there = call->tile_indices && !dump->indices_absent;
    if (!there)
        add(dump, call->tile_indices ? " tiles=absent" : " tiles=null");
    for (uint32_t i = 0; there && i < call->count; i++) {
        if (dump->size > WRAP) {
            end_line(dump);
            add(dump, "%" PRIu64 " tiles", dump->event);
        }
        add(dump, " %" PRIu32, call->tile_indices[i]);
    }
}

static void add_list(struct slc_dump *dump, const struct slc_call *call)
{
    if (call->query)
        add(dump, " query");
    else
        add(dump, " room=%" PRIu32, call->room);
}

static void add_uv(struct slc_dump *dump, const SluiceUvTransform *uv)
{
    if (!uv) {
        add(dump, " transform=none");
        return;
    }
    add(dump, " scale=%.9g,%.9g offset=%.9g,%.9g wrap=%d,%d", (double)uv->scaleU,
        (double)uv->scaleV, (double)uv->offsetU, (double)uv->offsetV, (int)uv->wrapU,
        (int)uv->wrapV);
}

void slc_dump_inputs(struct slc_dump *dump, const struct slc_call *call)
{
    if (!dump->line)
        return;
    uint32_t fields = slc_call_fields(call->kind);
    add(dump, "%" PRIu64 " %s", dump->event, call_names[call->kind]);
    if (fields & SLC_FIELD_TEXTURE)
        add_id(dump, "texture", call->texture_id);
    if (fields & SLC_FIELD_PRIMARY)
        add_id(dump, "primary", call->primary_id);
    if (fields & SLC_FIELD_TIME)
        add(dump, " time=%" PRIu64, call->time_stamp);
    if (fields & SLC_FIELD_TIMEOUT)
        add(dump, " timeout=%" PRIu64, call->timeout);
    if (fields & SLC_FIELD_RETIRE)
        add(dump, " retire=%" PRIu64, call->retire_value);
    if (fields & SLC_FIELD_KEEP)
        add(dump, " keep=%" PRIu32, call->keep_count);
    if (fields & SLC_FIELD_HEAP)
        add(dump, " heap=%" PRIu32, call->heap_id);
    if (fields & SLC_FIELD_CONFIG)
        add_config(dump, call->config);
    if (fields & SLC_FIELD_DESC)
        add_desc(dump, call->desc);
    if (fields & SLC_FIELD_FEEDBACK)
        add_feedback(dump, call->feedback);
    if (fields & SLC_FIELD_INDICES)
        add_indices(dump, call);
    if (fields & SLC_FIELD_LIST)
        add_list(dump, call);
    if (fields & SLC_FIELD_UV)
        add_uv(dump, call->uv);
    if (fields & SLC_FIELD_PRIORITY)
        add(dump, " priority=%" PRId32, call->priority);
    end_line(dump);
}

static void add_tile(struct slc_dump *dump, const SluiceTile *tile, bool has_slot)
{
    add_id(dump, "texture", tile->textureId);
    add(dump, " index=%" PRIu32 " level=%" PRIu32 " x=%" PRIu32 " y=%" PRIu32, tile->tileIndex,
        tile->mipLevel, tile->x, tile->y);
    if (has_slot)
        add(dump, " heap=%" PRIu32 " slot=%" PRIu32, tile->heapId, tile->slot);
}

static void dump_rect(struct slc_dump *dump, const SluiceStreamedTextureManager *manager,
                      const SluiceMinMipRect *rect)
{
    add_id(dump, "texture", rect->textureId);
    add(dump, " x=%" PRIu32 " y=%" PRIu32 " size=%" PRIu32 "x%" PRIu32, rect->x, rect->y,
        rect->width, rect->height);
    end_line(dump);
    struct texel_runs runs = {dump, "minmip", 0, 0};
    slc_visit_minmip(manager, rect, add_texels, &runs);
    end_texels(&runs);
}

static void dump_entry(struct slc_dump *dump, const SluiceStreamedTextureManager *manager,
                       const struct slc_call *call, uint32_t i)
{
    bool rects = call->kind == SLC_CALL_GET_MINMIP_UPDATES;
    bool moves = call->kind == SLC_CALL_DEFRAGMENT;
    add(dump, "%" PRIu64 " %s", dump->event, rects ? "rect" : moves ? "move" : "tile");
    if (rects) {
        dump_rect(dump, manager, &call->rects[i]);
        return;
    }
    if (moves) {
        add_tile(dump, &call->moves[i].from, true);
        add(dump, " to-heap=%" PRIu32 " to-slot=%" PRIu32, call->moves[i].heapId,
            call->moves[i].slot);
    } else {
        add_tile(dump, &call->tiles[i], call->kind != SLC_CALL_GET_GIVEN_UP);
    }
    end_line(dump);
}

void slc_dump_decisions(struct slc_dump *dump, const SluiceStreamedTextureManager *manager,
                        const struct slc_call *call)
{
    if (!dump->line)
        return;
    if (call->kind == SLC_CALL_UPDATE_FEEDBACK && call->result >= SLUICE_SUCCESS)
        dump_map(dump, call->feedback);
    bool heap = call->kind == SLC_CALL_HEAP_ANSWER;
    add(dump, "%" PRIu64 " %s %s", dump->event, heap ? "allocate-heap" : "=",
        sluiceGetResultName(call->result));
    if (heap && call->result >= SLUICE_SUCCESS)
        add(dump, " heap=%" PRIu32, call->heap_id);
    if (call->kind == SLC_CALL_ADD_TEXTURE && call->result >= SLUICE_SUCCESS)
        add_id(dump, "texture", call->texture_id);
    if (slc_call_lists(call->kind) && call->result >= SLUICE_SUCCESS)
        add(dump, " count=%" PRIu32, call->count);
    end_line(dump);
    for (uint32_t i = 0; slc_call_has_entries(call) && i < call->count; i++)
        dump_entry(dump, manager, call, i);
}
