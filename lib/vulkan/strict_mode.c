#include "vulkan/strict_mode.h"

#include "base/bytes.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "image/pooled_reads.h"

#include <sluice/vulkan_control.h>

#include <stdarg.h>
#include <stdio.h>

#define DEFAULT_FRAMES 600
#define DEFAULT_BEGINS 1000

#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
static void
report(const SluiceVulkanStreamer *s, SluiceMisuseKind kind, uint64_t value, const char *format,
       ...)
{
    char text[320];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    const SluiceMisuse misuse = {kind, value, text};
    s->strict.mode.pfnReport(s->strict.mode.pUserData, &misuse);
}

static bool is_on(const SluiceVulkanStreamer *s)
{
    return s->strict.mode.pfnReport;
}

void slc_strict_not_ended(SluiceVulkanStreamer *s)
{
    if (is_on(s))
        report(s, SLUICE_MISUSE_FRAME_NOT_ENDED, s->frame,
               "frame %llu was begun and not ended: call sluiceEndStreamingFrame after its draws, "
               "or sluiceAbandonStreamingFrame, before the next sluiceBeginStreamingFrame",
               (unsigned long long)s->frame);
}

void slc_strict_not_begun(SluiceVulkanStreamer *s)
{
    if (is_on(s))
        report(s, SLUICE_MISUSE_FRAME_NOT_BEGUN, s->frame,
               "sluiceEndStreamingFrame ends no frame: frame %llu was the last one, and was ended "
               "or abandoned. Call sluiceBeginStreamingFrame first, and end the frame only if it "
               "returned SLUICE_SUCCESS",
               (unsigned long long)s->frame);
}

void slc_strict_not_ready(SluiceVulkanStreamer *s, uint64_t frame)
{
    struct slc_strict *strict = &s->strict;
    if (!is_on(s))
        return;
    strict->refused_count = strict->refused_frame == frame ? strict->refused_count + 1 : 1;
    strict->refused_frame = frame;
    if (strict->refused_count == strict->mode.refusedBegins)
        report(s, SLUICE_MISUSE_FRAME_NOT_SIGNALED, frame,
               "frame %llu is not complete after %u calls of sluiceBeginStreamingFrame, and the "
               "semaphore has the value %llu: submit its commands with signalValue %llu, or call "
               "sluiceAbandonStreamingFrame. Wait on the semaphore instead of calling again",
               (unsigned long long)frame, strict->refused_count,
               (unsigned long long)s->completed_frame, (unsigned long long)frame);
}

/* True if some map that was read back last has marks. */
static bool has_feedback(const SluiceVulkanStreamer *s)
{
    for (uint32_t i = 0; i < s->primary_count; i++) {
        const struct slc_feedback_map *map = &s->textures[s->primaries[i]].feedback;
        if (!slc_bytes_are(map->levels, map->region_count, SLUICE_MIP_UNTOUCHED))
            return true;
    }
    return s->primary_count == 0;
}

/* Examines all maps once in a number of frames. Marks of frames in between count. */
static void check_feedback(SluiceVulkanStreamer *s)
{
    struct slc_strict *strict = &s->strict;
    uint32_t step = strict->mode.framesWithoutFeedback / 8 + 1;
    if (s->frame % step == 0 && has_feedback(s))
        strict->marked_frame = s->frame;
    if (s->frame - strict->marked_frame < strict->mode.framesWithoutFeedback)
        return;
    uint64_t frames = s->frame - strict->marked_frame;
    strict->marked_frame = s->frame;
    report(s, SLUICE_MISUSE_NO_FEEDBACK, frames,
           "no shader has marked any of %u textures in the last %llu frames: bind the frame's "
           "descriptor set, call sluiceWriteFeedback where textures are sampled, and end frames "
           "after the draws",
           s->primary_count, (unsigned long long)frames);
}

static bool may_repeat(const SluiceVulkanStreamer *s, uint64_t *told)
{
    if (*told && s->frame - *told < s->strict.mode.repeatFrames)
        return false;
    *told = s->frame;
    return true;
}

/* Returns the counters of pages: of a paged streamer, or of the paged textures of a sparse one. */
static const struct slc_residency_counters *page_counters(const SluiceVulkanStreamer *s)
{
    return s->paged ? &s->paged->counters : &s->residency->counters;
}

static void check_memory(SluiceVulkanStreamer *s)
{
    struct slc_strict *strict = &s->strict;
    SluiceStreamedTextureStatistics now = {.structSize = sizeof now};
    uint32_t chunks = page_counters(s)->page_chunks;
    uint64_t shortages = page_counters(s)->page_chunk_shortages;
    sluiceGetStatistics(s->manager, &now);
    if (strict->budget_reached && now.requestedTileCount && may_repeat(s, &strict->heaps_told))
        report(s, SLUICE_MISUSE_HEAPS_EXHAUSTED, now.heapCount,
               "%u tiles wait for memory: all %u heaps of %u tiles are in use, and there is no "
               "further one. Raise maxHeapCount or the memory budget, or request less",
               now.requestedTileCount, now.heapCount, s->info.heapTileCapacity);
    if (shortages > strict->shortages && may_repeat(s, &strict->chunks_told))
        report(s, SLUICE_MISUSE_CHUNKS_EXHAUSTED, chunks,
               "tiles found no page: all %u images of pages are in use. Raise maxPageChunkCount of "
               "the context, or use fewer formats",
               chunks);
    strict->shortages = shortages;
    strict->budget_reached = false;
}

void slc_strict_begun(SluiceVulkanStreamer *s)
{
    s->strict.refused_count = 0;
    if (!is_on(s))
        return;
    check_feedback(s);
    check_memory(s);
}

static void set_default(uint32_t *value, uint32_t otherwise)
{
    *value = *value ? *value : otherwise;
}

SluiceResult sluiceSetVulkanStrictMode(SluiceVulkanStreamer *streamer,
                                       const SluiceVulkanStrictMode *pMode)
{
    SluiceVulkanStreamer *s = streamer;
    if (!s)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceVulkanStrictMode mode = {.structSize = sizeof mode};
    if (pMode) {
        SluiceResult result =
            slc_struct_read(SLC_STRUCT(SluiceVulkanStrictMode), &mode, pMode, &s->vk.log);
        if (result != SLUICE_SUCCESS)
            return result;
        if (!mode.pfnReport)
            return slc_log_refusal(&s->vk.log, "SluiceVulkanStrictMode lacks pfnReport");
    }
    set_default(&mode.framesWithoutFeedback, DEFAULT_FRAMES);
    set_default(&mode.refusedBegins, DEFAULT_BEGINS);
    set_default(&mode.repeatFrames, DEFAULT_FRAMES);
    s->strict = (struct slc_strict){.mode = mode,
                                    .marked_frame = s->frame,
                                    .shortages = page_counters(s)->page_chunk_shortages};
    return SLUICE_SUCCESS;
}

SluiceResult sluiceReleaseVulkanSource(SluiceVulkanStreamer *streamer, SluiceImageSource *source)
{
    SluiceVulkanStreamer *s = streamer;
    bool in_use = false;
    SluiceResult result = sluiceIsVulkanSourceInUse(s, source, &in_use);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!in_use) {
        slc_loader_drop_texels(s->loader, source);
        sluiceDestroyImageSource(source);
        return SLUICE_SUCCESS;
    }
    SluiceImageInfo info = {.structSize = sizeof info};
    bool named = sluiceGetImageInfo(source, &info) == SLUICE_SUCCESS && info.pName;
    if (is_on(s))
        report(s, SLUICE_MISUSE_SOURCE_IN_USE, (uint64_t)(uintptr_t)source,
               "%s: the source is destroyed while a texture has it or a read of it is under way. "
               "Remove or replace it first, and call again some frames later",
               named ? info.pName : "image");
    return SLUICE_NOT_READY;
}
