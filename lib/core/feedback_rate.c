#include "base/struct_size.h"
#include "core/feedback_lattice.h"

#include <sluice/feedback_rate.h>

#include <math.h>

#define DEFAULT_TEXTURES_PER_FRAME 10
#define PROBABILITY_STEPS 8388608.0 /* 2^23: random numbers that a shader can draw */
#define CORNER_TURNS 4              /* frames in which each pixel marks each corner once */

/* Products like 0.29 * 100 come out just below a whole number. */
#define WHOLE_SLACK 1e-12

static double whole_below(double x)
{
    return floor(x * (1 + WHOLE_SLACK));
}

static double whole_above(double x)
{
    return ceil(x / (1 + WHOLE_SLACK));
}

static uint32_t textures_per_frame(const SluiceFeedbackRate *rate)
{
    uint32_t count = rate->texturesPerFrame ? rate->texturesPerFrame : DEFAULT_TEXTURES_PER_FRAME;
    return count < rate->textureCount ? count : rate->textureCount;
}

/** Frames from one turn of a texture to its next. */
static double frames_per_turn(const SluiceFeedbackRate *rate)
{
    return (double)rate->textureCount / textures_per_frame(rate);
}

/** Frames from one turn of a texture to its next, if all turns are equally long; else 0. */
static uint32_t equal_turns(const SluiceFeedbackRate *rate)
{
    uint32_t count = textures_per_frame(rate);
    return rate->textureCount % count ? 0 : rate->textureCount / count;
}

static SluiceResult check_rate(const SluiceFeedbackRate *rate, double probability)
{
    bool known = (uint32_t)rate->selection <= SLUICE_FEEDBACK_SELECTION_LATTICE;
    bool counts = rate->regionWidth && rate->regionHeight && rate->textureCount;
    bool times = rate->frameRate > 0 && isfinite(rate->frameRate) && rate->timeoutSeconds >= 0;
    bool share = probability >= 0 && probability <= 1;
    return known && counts && times && share ? SLUICE_SUCCESS : SLUICE_ERROR_INVALID_ARGUMENT;
}

/**
 * Number of frames whose marks are in the maps of one timeout. The newest map always counts. If
 * marks accumulate, the maps bring all frames of the timeout. In turns, each map brings one frame.
 */
static double collected_frames(const SluiceFeedbackRate *rate)
{
    double frames = rate->frameRate * rate->timeoutSeconds, turn = frames_per_turn(rate);
    if (rate->inTurns)
        return fmax(whole_below(frames / turn), 1);
    return fmax(whole_below(frames), whole_below(turn));
}

/* Draws ------------------------------------------------------------------------------------- */

/** Writers that can mark a region in its worst position. */
struct writers {
    double count;   ///< writers that draw in a frame
    uint32_t turns; ///< frames of four consecutive ones in which they draw: 1, 2 or 4
};

static double half_up(uint32_t count)
{
    return (double)(count / 2 + count % 2);
}

/**
 * Along an axis a region is touched by the upper corners of some pixels, by both corners of the
 * next ones and by the lower corners of the last ones. The corners of a quad's two pixels change
 * places every frame. Of 3 pixels or more, at least (count - 1) / 2 quads mark in every frame,
 * whatever the position. Of 1 or 2 pixels, one quad may mark, in every other frame only.
 */
static struct writers shared_writers(const SluiceFeedbackRate *rate)
{
    uint32_t columns = (rate->regionWidth - 1) / 2, rows = (rate->regionHeight - 1) / 2;
    return (struct writers){.count = (double)(columns ? columns : 1) * (rows ? rows : 1),
                            .turns = (columns ? 2u : 1u) * (rows ? 2u : 1u)};
}

static struct writers find_writers(const SluiceFeedbackRate *rate)
{
    if (rate->selection == SLUICE_FEEDBACK_SELECTION_SHARED_QUADS)
        return shared_writers(rate);
    if (rate->selection == SLUICE_FEEDBACK_SELECTION_RANDOM_QUADS)
        return (struct writers){half_up(rate->regionWidth) * half_up(rate->regionHeight),
                                CORNER_TURNS};
    return (struct writers){(double)rate->regionWidth * rate->regionHeight, CORNER_TURNS};
}

/** True if a texture's turns meet all four corners. Otherwise some corners are never marked. */
static bool meets_all_corners(const SluiceFeedbackRate *rate, struct writers writers)
{
    return writers.turns == CORNER_TURNS || !rate->inTurns || equal_turns(rate) % 2 == 1;
}

/** Independent draws in a timeout, each of which would mark the region. */
static double count_draws(const SluiceFeedbackRate *rate)
{
    struct writers writers = find_writers(rate);
    double frames = collected_frames(rate);
    if (!meets_all_corners(rate, writers))
        return 0;
    if (writers.turns < CORNER_TURNS) /* only whole rounds are sure to contain each turn */
        frames = floor(frames / CORNER_TURNS) * writers.turns;
    return frames * writers.count;
}

/** (1 - p)^draws, also for tiny p and for infinitely many draws. */
static double draws_miss(double draws, double probability)
{
    if (draws == 0 || probability == 0)
        return 1;
    return exp(draws * log1p(-probability));
}

static double predict_miss(const SluiceFeedbackRate *rate, double probability)
{
    if (rate->selection == SLUICE_FEEDBACK_SELECTION_LATTICE)
        return slc_lattice_miss(rate->regionWidth, rate->regionHeight, collected_frames(rate),
                                rate->inTurns ? equal_turns(rate) : 1);
    return draws_miss(count_draws(rate), probability);
}

static SluiceResult read_rate(const SluiceFeedbackRate *given, double probability,
                              SluiceFeedbackRate *rate)
{
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceFeedbackRate), rate, given, NULL);
    return result == SLUICE_SUCCESS ? check_rate(rate, probability) : result;
}

SluiceResult sluicePredictFeedbackMiss(const SluiceFeedbackRate *pRate, double probability,
                                       double *pMiss)
{
    if (!pRate || !pMiss)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceFeedbackRate rate = {.structSize = sizeof rate};
    SluiceResult result = read_rate(pRate, probability, &rate);
    if (result == SLUICE_SUCCESS)
        *pMiss = predict_miss(&rate, probability);
    return result;
}

/* Choosing ---------------------------------------------------------------------------------- */

/** `allowed` 0: only probability 1 never misses, although rounding may say that less suffices. */
static bool is_enough(double draws, double probability, double allowed)
{
    return allowed > 0 ? draws_miss(draws, probability) <= allowed : probability == 1;
}

static double choose_probability(double draws, double allowed)
{
    if (isinf(draws))
        return 1 / PROBABILITY_STEPS;
    double steps = fmax(ceil(-expm1(log(allowed) / draws) * PROBABILITY_STEPS), 1);
    /* correct the rounding of `steps` */
    if (steps > 1 && is_enough(draws, (steps - 1) / PROBABILITY_STEPS, allowed))
        steps--;
    while (steps < PROBABILITY_STEPS && !is_enough(draws, steps / PROBABILITY_STEPS, allowed))
        steps++;
    return steps / PROBABILITY_STEPS;
}

SluiceResult sluiceChooseFeedbackProbability(const SluiceFeedbackRate *pRate, double allowedMiss,
                                             float *pProbability)
{
    if (!pRate || !pProbability)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceFeedbackRate rate = {.structSize = sizeof rate};
    SluiceResult result = read_rate(pRate, 0, &rate);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!(allowedMiss >= 0 && allowedMiss < 1))
        return SLUICE_ERROR_INVALID_ARGUMENT;
    if (predict_miss(&rate, 1) > allowedMiss)
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    if (rate.selection == SLUICE_FEEDBACK_SELECTION_LATTICE)
        *pProbability = 1.0f / SLC_LATTICE_PHASES;
    else
        *pProbability = (float)choose_probability(count_draws(&rate), allowedMiss);
    return SLUICE_SUCCESS;
}

/* Delays ------------------------------------------------------------------------------------ */

/** Number of frames to collect until only a share of `late` of all regions is unmarked. */
static double frames_to_mark(const SluiceFeedbackRate *rate, double probability, double late)
{
    struct writers writers = find_writers(rate);
    if (probability == 0 || !meets_all_corners(rate, writers))
        return INFINITY;
    double frames = whole_above(log(late) / (writers.count * log1p(-probability)));
    frames = fmax(frames, 1);
    return writers.turns == CORNER_TURNS ? frames : ceil(frames / writers.turns) * CORNER_TURNS;
}

/** Most frames until `frames` frames are collected and the texture's turn comes. */
static double frames_to_notice(const SluiceFeedbackRate *rate, double frames)
{
    double turn = frames_per_turn(rate);
    return rate->inTurns ? whole_above(frames * turn) : frames + ceil(turn) - 1;
}

static SluiceFeedbackDelay predict_delay(const SluiceFeedbackRate *rate, double probability)
{
    double median, late;
    if (rate->selection == SLUICE_FEEDBACK_SELECTION_LATTICE) {
        slc_lattice_frames(rate->regionWidth, rate->regionHeight,
                           rate->inTurns ? equal_turns(rate) : 1, &median, &late);
    } else {
        median = frames_to_mark(rate, probability, 0.5);
        late = frames_to_mark(rate, probability, 0.01);
    }
    return (SluiceFeedbackDelay){.structSize = sizeof(SluiceFeedbackDelay),
                                 .median = frames_to_notice(rate, median),
                                 .percentile99 = frames_to_notice(rate, late)};
}

SluiceResult sluicePredictFeedbackDelay(const SluiceFeedbackRate *pRate, double probability,
                                        SluiceFeedbackDelay *pDelay)
{
    if (!pRate || !pDelay)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceFeedbackRate rate = {.structSize = sizeof rate};
    SluiceResult result = read_rate(pRate, probability, &rate);
    if (result == SLUICE_SUCCESS)
        result = slc_struct_check(SLC_STRUCT(SluiceFeedbackDelay), pDelay, NULL);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceFeedbackDelay delay = predict_delay(&rate, probability);
    slc_struct_write(SLC_STRUCT(SluiceFeedbackDelay), pDelay, &delay);
    return SLUICE_SUCCESS;
}
