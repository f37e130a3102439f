/* The sentences of sluiceExplainVulkanTexture. */
#include "vulkan/texture_explain.h"

#include "base/checked.h"

#include <stdarg.h>
#include <stdio.h>

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static void
say(const struct slc_coarse_place *p, char *sentence, const char *format, ...)
{
    const char *name = p->texture->info.pName ? p->texture->info.pName : "image";
    int used = snprintf(sentence, SLUICE_EXPLANATION_SIZE, "%.100s: ", name);
    va_list arguments;
    va_start(arguments, format);
    if (used > 0)
        vsnprintf(sentence + used, SLUICE_EXPLANATION_SIZE - (size_t)used, format, arguments);
    va_end(arguments);
}

static SluiceStreamedTextureStatistics counts_of(const SluiceVulkanStreamer *s)
{
    SluiceStreamedTextureStatistics counts = {.structSize = sizeof counts};
    sluiceGetStatistics(s->manager, &counts);
    return counts;
}

static void say_budget(const SluiceVulkanStreamer *s, const struct slc_coarse_place *p, char *out)
{
    const SluiceStreamedTextureStatistics counts = counts_of(s);
    if (p->missing == SLUICE_MIP_UNTOUCHED)
        say(p, out,
            "level %u is requested there, but memory is too small for all requests: each is made "
            "%.3g levels coarser.",
            p->requested.asked, counts.globalMipBias / 16.0);
    else if (p->is_limit_of_tiles)
        say(p, out, "level %u cannot be bound: %u distinct tiles were, the device's limit.",
            p->missing,
            s->info.maxTouchedTiles ? s->info.maxTouchedTiles : s->caps.public.maxTouchedTiles);
    else if (p->texture->presence != SLC_PRESENT)
        say(p, out, "it has no image: it waits for memory.");
    else
        say(p, out, "level %u waits for memory: %u tiles are requested, %u heaps are in use.",
            p->missing, counts.requestedTileCount, counts.heapCount);
}

static void say_failed(const SluiceVulkanStreamer *s, const struct slc_coarse_place *p, char *out)
{
    unsigned long long count = s->textures[p->texture->first].trouble.failed_count;
    bool given_up = p->state == SLUICE_TILE_STATE_GIVEN_UP;
    say(p, out, "level %u failed to load; %llu loads failed since the last good one. %s",
        p->missing, count,
        given_up ? "It is tried again after givenUpRetryDelayTicks."
                 : "It is tried again after retryDelayTicks.");
}

static void say_not_seen(const SluiceVulkanStreamer *s, const struct slc_coarse_place *p, char *out)
{
    SluiceTextureStatistics seen = {.structSize = sizeof seen};
    sluiceGetTextureStatistics(s->manager, p->texture->id, &seen);
    if (seen.seen)
        say(p, out, "feedback requests nothing there now; it last requested the texture at %llu.",
            (unsigned long long)seen.seenTime);
    else
        say(p, out,
            "no feedback has requested it so far. It has its turn every %u frames, if shaders "
            "write feedback for it.",
            slc_div_up_u32(slc_max_u32(s->primary_count, 1), slc_max_u32(s->share, 1)));
}

static void say_queued(const SluiceVulkanStreamer *s, const struct slc_coarse_place *p, char *out)
{
    if (p->missing == SLUICE_MIP_UNTOUCHED)
        say(p, out, "level %u is requested from the next frame on.", p->marked);
    else if (s->hold_loads)
        say(p, out, "level %u waits: loads are held (holdLoads), %u tiles are requested.",
            p->missing, counts_of(s).requestedTileCount);
    else
        say(p, out, "level %u waits its turn: %u tiles are requested, a frame loads %u.",
            p->missing, counts_of(s).requestedTileCount, s->info.tilesPerFrame);
}

void slc_explain_in_words(const SluiceVulkanStreamer *s, const struct slc_coarse_place *place,
                          SluiceCoarseReason reason, char *sentence)
{
    const struct slc_coarse_place *p = place;
    switch (reason) {
    case SLUICE_COARSE_FINEST: say(p, sentence, "level 0 is shown, the finest there is."); break;
    case SLUICE_COARSE_ENOUGH:
        say(p, sentence, "level %u is shown, and no finer one is requested.", p->resident);
        break;
    case SLUICE_COARSE_NOT_SEEN: say_not_seen(s, p, sentence); break;
    case SLUICE_COARSE_HIDDEN:
        say(p, sentence, "the application has hidden it, so its feedback does not count.");
        break;
    case SLUICE_COARSE_LIMIT:
        say(p, sentence, "the application allows no finer level than %u (finestLevel).", p->limit);
        break;
    case SLUICE_COARSE_MIP_BIAS:
        say(p, sentence, "the application makes its requests %d levels coarser (mipBias).",
            p->primary->mip_bias);
        break;
    case SLUICE_COARSE_QUEUED: say_queued(s, p, sentence); break;
    case SLUICE_COARSE_BANDWIDTH:
        say(p, sentence,
            "level %u waits for one of %u loads in flight: more is requested than "
            "read.",
            p->missing, s->info.maxLoadsInFlight);
        break;
    case SLUICE_COARSE_READING:
        say(p, sentence, "level %u is being %s.", p->missing,
            p->texture->source ? "read" : "produced");
        break;
    case SLUICE_COARSE_UPLOADING:
        say(p, sentence, "level %u was read, and is shown once it is bound and copied.",
            p->missing);
        break;
    case SLUICE_COARSE_FADING:
        say(p, sentence, "level %u is resident, and fades in.", p->resident);
        break;
    case SLUICE_COARSE_BUDGET: say_budget(s, p, sentence); break;
    case SLUICE_COARSE_FAILED: say_failed(s, p, sentence); break;
    }
}
