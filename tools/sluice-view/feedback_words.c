#include "feedback_words.h"

#include <sluice/feedback_rate.h>

#include <stdio.h>

static bool writes(const struct view_settings *s)
{
    return s->feedback == VIEW_FEEDBACK_ON && !s->pause && !s->freeze_wants;
}

static SluiceFeedbackSelection selection_of(const struct view_settings *s)
{
    switch (s->feedback_by) {
    case VIEW_BY_LATTICE: return SLUICE_FEEDBACK_SELECTION_LATTICE;
    case VIEW_BY_EVERY_PIXEL:
    case VIEW_BY_TURNS: return SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS;
    default: return SLUICE_FEEDBACK_SELECTION_SHARED_QUADS;
    }
}

static uint32_t maps_per_frame(const struct view_settings *s, uint32_t texture_count)
{
    return s->textures_per_frame ? s->textures_per_frame : texture_count;
}

struct feedback_outlook feedback_outlook_of(const struct view_settings *s, uint32_t texture_count)
{
    const uint32_t count = texture_count ? texture_count : 1;
    const SluiceFeedbackRate rate = {.structSize = sizeof rate,
                                     .selection = selection_of(s),
                                     .regionWidth = FEEDBACK_REGION,
                                     .regionHeight = FEEDBACK_REGION,
                                     .textureCount = count,
                                     .texturesPerFrame = maps_per_frame(s, count),
                                     .inTurns = s->feedback_by == VIEW_BY_TURNS,
                                     .frameRate = s->frame_cap ? s->frame_cap : 60,
                                     .timeoutSeconds = s->timeout};
    const double probability = s->feedback_by == VIEW_BY_QUADS ? s->probability : 1.0;
    SluiceFeedbackDelay delay = {.structSize = sizeof delay};
    struct feedback_outlook outlook = {.missed = 1};
    outlook.known =
        writes(s) && sluicePredictFeedbackDelay(&rate, probability, &delay) == SLUICE_SUCCESS &&
        sluicePredictFeedbackMiss(&rate, probability, &outlook.missed) == SLUICE_SUCCESS;
    outlook.frames = delay.percentile99;
    return outlook;
}

uint32_t feedback_texture_count(const struct stage *stage)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < stage_texture_count(stage); i++)
        count += stage_texture(stage, i)->primary == STAGE_NO_TEXTURE;
    return count;
}

const char *feedback_writers(const struct view_settings *s, uint32_t texture_count, char *text,
                             size_t size)
{
    const uint32_t maps = maps_per_frame(s, texture_count);
    if (!writes(s))
        snprintf(text, size, "no pixel: %s",
                 s->feedback == VIEW_FEEDBACK_OFF ? "feedback is off"
                 : s->pause                       ? "streaming is paused"
                                                  : "wants are frozen");
    else if (s->feedback_by == VIEW_BY_LATTICE)
        snprintf(text, size, "one pixel in 8 x 8, each in 64 frames");
    else if (s->feedback_by == VIEW_BY_EVERY_PIXEL)
        snprintf(text, size, "every pixel that has a texture");
    else if (s->feedback_by == VIEW_BY_TURNS)
        snprintf(text, size, "pixels of %u of %u textures, in turns",
                 maps < texture_count ? maps : texture_count, texture_count);
    else
        snprintf(text, size, "quads at random, %.3g %% of all", 100 * s->probability);
    return text;
}
