/*
 * The tile whose read failed last stands for its source: when its read succeeds, the source has
 * recovered. If several tiles are damaged, messages may alternate between failure and recovery. A
 * minimum time between messages limits their number.
 */
#include "vulkan/read_troubles.h"

#include "base/log.h"

#include <stdio.h>

static const char *name_of(const struct slc_texture *texture)
{
    return texture->info.pName ? texture->info.pName : "image";
}

static const char *loads_of(const struct slc_texture *texture)
{
    return texture->source ? "reads" : "calls of its producer";
}

static double seconds(const SluiceVulkanStreamer *s, uint64_t time_stamps)
{
    return (double)time_stamps / (double)s->info.ticksPerSecond;
}

static void say_failed(SluiceVulkanStreamer *s, const struct slc_texture *texture, uint32_t tile,
                       SluiceResult result)
{
    SluiceTileLoaderStatistics reads = {.structSize = sizeof reads,
                                        .lastFailureOffset = SLUICE_UNKNOWN_OFFSET};
    char place[48] = "";
    if (texture->source)
        sluiceGetTileLoaderStatistics(s->loader, texture->source, &reads);
    if (texture->source && reads.lastFailure == result &&
        reads.lastFailureOffset != SLUICE_UNKNOWN_OFFSET)
        snprintf(place, sizeof place, " at offset 0x%llx",
                 (unsigned long long)reads.lastFailureOffset);
    bool packed = tile >= texture->layout.regularTileCount;
    slc_log(&s->vk.log, SLUICE_LOG_WARNING, "%s: %s failed%s: %s. %s; retrying in %.3g s.",
            name_of(texture), texture->source ? "read" : "producer", place,
            sluiceGetResultName(result),
            packed ? "Its packed levels are missing" : "Showing a coarser level",
            seconds(s, s->info.retryDelayTicks));
}

static void say_given_up(const SluiceVulkanStreamer *s, const struct slc_texture *texture,
                         uint64_t failed_count)
{
    if (s->info.givenUpRetryDelayTicks == UINT64_MAX)
        slc_log(&s->vk.log, SLUICE_LOG_WARNING, "%s: %llu %s failed. Not retrying.",
                name_of(texture), (unsigned long long)failed_count, loads_of(texture));
    else
        slc_log(&s->vk.log, SLUICE_LOG_WARNING, "%s: %llu %s failed. Retrying every %.3g s.",
                name_of(texture), (unsigned long long)failed_count, loads_of(texture),
                seconds(s, s->info.givenUpRetryDelayTicks));
}

/* True if enough time has passed since the last message about a source. */
static bool may_speak(const SluiceVulkanStreamer *s, const struct slc_read_trouble *trouble)
{
    return trouble->said != SLC_READS_WELL || !trouble->has_spoken ||
           s->time_stamp - trouble->time >= s->info.givenUpRetryDelayTicks;
}

static void note_spoken(const SluiceVulkanStreamer *s, struct slc_read_trouble *trouble)
{
    trouble->said = trouble->health;
    trouble->has_spoken = true;
    trouble->time = s->time_stamp;
}

void slc_read_trouble_failed(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile,
                             uint32_t count, SluiceResult result)
{
    const struct slc_texture *t = &s->textures[texture];
    if (result == SLUICE_NOT_READY && t->source) {
        s->counts.tilesNotReady += count;
        return;
    }
    s->counts.tilesFailed += count;
    struct slc_read_trouble *trouble = &s->textures[t->first].trouble;
    SluiceTileState state = SLUICE_TILE_STATE_FREE;
    trouble->failed_count++;
    trouble->texture = texture;
    trouble->tile = tile;
    sluiceGetTileState(s->manager, t->id, tile, &state, NULL);
    if (state == SLUICE_TILE_STATE_GIVEN_UP)
        trouble->health = SLC_READS_GIVEN_UP;
    else if (trouble->health == SLC_READS_WELL)
        trouble->health = SLC_READS_FAIL;
    if (trouble->said == trouble->health || !may_speak(s, trouble))
        return;
    if (trouble->said == SLC_READS_WELL)
        say_failed(s, t, tile, result);
    if (trouble->health == SLC_READS_GIVEN_UP)
        say_given_up(s, t, trouble->failed_count);
    note_spoken(s, trouble);
}

static void retry_other_layers(SluiceVulkanStreamer *s, const struct slc_texture *layer)
{
    for (uint32_t i = layer->first; i < layer->first + layer->layer_count; i++)
        if (&s->textures[i] != layer && s->textures[i].state == SLC_TEXTURE_LIVE)
            slc_streamer_check(s, sluiceRetryFailedTiles(s->manager, s->textures[i].id),
                               "sluiceRetryFailedTiles");
}

void slc_read_trouble_delivered(SluiceVulkanStreamer *s, uint32_t texture, uint32_t tile)
{
    const struct slc_texture *t = &s->textures[texture];
    struct slc_read_trouble *trouble = &s->textures[t->first].trouble;
    if (trouble->health == SLC_READS_WELL || trouble->texture != texture || trouble->tile != tile)
        return;
    trouble->health = SLC_READS_WELL;
    if (trouble->said != SLC_READS_WELL) {
        slc_log(&s->vk.log, SLUICE_LOG_INFO, "%s: can be %s again, after %llu failed %s.",
                name_of(t), t->source ? "read" : "produced",
                (unsigned long long)trouble->failed_count, loads_of(t));
        note_spoken(s, trouble);
        retry_other_layers(s, t);
    }
    trouble->failed_count = 0;
}

SluiceResult sluiceRetryVulkanSource(SluiceVulkanStreamer *streamer,
                                     const SluiceImageSource *source)
{
    if (!streamer)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanStreamer *s = streamer;
    for (uint32_t i = 0; i < s->texture_high; i++) {
        const struct slc_texture *texture = &s->textures[i];
        if (texture->state != SLC_TEXTURE_LIVE || (source && texture->source != source))
            continue;
        SluiceResult result = slc_streamer_check(s, sluiceRetryFailedTiles(s->manager, texture->id),
                                                 "sluiceRetryFailedTiles");
        if (result < 0)
            return result;
    }
    return SLUICE_SUCCESS;
}
