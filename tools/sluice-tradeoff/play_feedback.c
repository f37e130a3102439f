#include "play_feedback.h"

#include <sluice/feedback_rate.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool play_feedback_init(struct play_feedback *f, const struct feedback_trace *trace,
                        const struct play_options *options)
{
    const size_t room = (size_t)trace->texture_count + 1;
    *f = (struct play_feedback){.trace = trace, .options = options};
    f->maps = calloc(room, sizeof *f->maps);
    f->pending = calloc(room, sizeof *f->pending);
    f->order = calloc(room, sizeof *f->order);
    if (f->maps && f->pending && f->order)
        return true;
    fprintf(stderr, "out of memory\n");
    return false;
}

void play_feedback_finish(struct play_feedback *f)
{
    for (uint32_t i = 0; f->maps && i < f->trace->texture_count; i++)
        free(f->maps[i]);
    free(f->maps);
    free(f->pending);
    free(f->order);
    *f = (struct play_feedback){0};
}

/** Finalizer of splitmix64. */
static uint64_t mix(uint64_t x)
{
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

/** Returns a random number in [0, 1) for each seed, frame, texture and region. */
static double draw(const struct play_feedback *f, uint32_t frame, uint32_t texture, uint32_t region)
{
    uint64_t x = mix(mix((uint64_t)f->options->seed << 32 | frame) ^ texture);
    return (double)(mix(x ^ region) >> 11) / 9007199254740992.0;
}

static size_t map_size(const struct play_feedback *f, uint32_t texture)
{
    const SluiceStreamedTextureLayout *l = &f->trace->textures[texture].layout;
    return (size_t)l->feedbackWidth * l->feedbackHeight;
}

bool play_feedback_add(struct play_feedback *f, uint32_t texture, const uint8_t *map,
                       uint32_t frame)
{
    const size_t size = map_size(f, texture);
    uint8_t *kept = f->maps[texture];
    if (!kept) {
        kept = f->maps[texture] = malloc(size);
        if (!kept)
            fprintf(stderr, "out of memory\n");
        if (!kept)
            return false;
        f->order[f->count++] = texture;
    }
    if (!f->pending[texture] || f->options->in_turns)
        memset(kept, SLUICE_MIP_UNTOUCHED, size);
    f->pending[texture] = true;
    f->map_count++;
    const double drop = f->options->drop;
    for (uint32_t i = 0; i < size; i++)
        if (map[i] < kept[i] && (drop == 0 || draw(f, frame, texture, i) >= drop))
            kept[i] = map[i];
    return true;
}

void play_feedback_begin_reading(struct play_feedback *f)
{
    const uint32_t most = f->options->textures_per_frame;
    f->next = 0;
    f->end = most > 0 && most < f->count ? most : f->count;
}

bool play_feedback_next(struct play_feedback *f, uint32_t *texture, const uint8_t **map)
{
    while (f->next < f->end) {
        const uint32_t place = f->turn;
        f->turn = (f->turn + 1) % f->count;
        f->next++;
        *texture = f->order[place];
        *map = f->maps[*texture];
        if (f->pending[*texture]) {
            f->pending[*texture] = false;
            return true;
        }
    }
    return false;
}

double play_feedback_predict_miss(const struct play_feedback *f, double frame_rate)
{
    const struct play_options *o = f->options;
    double miss = NAN;
    if (f->count == 0 || f->map_count != (uint64_t)f->count * f->trace->frame_count)
        return NAN;
    const SluiceFeedbackRate rate = {
        .structSize = sizeof rate,
        .selection = SLUICE_FEEDBACK_SELECTION_RANDOM_PIXELS,
        .regionWidth = o->probability < 1 ? o->writers : 1,
        .regionHeight = 1,
        .textureCount = f->count,
        .texturesPerFrame = o->textures_per_frame ? o->textures_per_frame : f->count,
        .inTurns = o->in_turns,
        .frameRate = frame_rate,
        .timeoutSeconds = o->timeout,
    };
    const double probability = o->probability < 1 ? o->probability : 1 - o->drop;
    if (o->drop > 0)
        sluicePredictFeedbackMiss(&rate, probability, &miss);
    return miss;
}
