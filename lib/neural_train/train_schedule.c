#include "neural_train/train_schedule.h"

#include <math.h>

#define PI 3.14159265358979323846

/* Decay of moments. Learning rates are cosines. Second moments decay fast: with 0.999 for the
 * network, results are 0.8 to 1.6 dB worse (decision 89 has figures for all constants here). */
#define DECAY1 0.9
#define DECAY2 0.99
#define RISE 0.02 /* share of steps with a rising rate; a first rate of 0.02 would be too large */
#define QUANTIZE_FROM 0.5 /* share of steps before rounding of latents, codes and weights */
#define FP8_RATE 0.2      /* first rate of the FP8 network, as a share of the network's rate */

uint32_t slc_train_total_steps(const struct slc_train_plan *plan)
{
    return plan->step_count + plan->fp8_steps;
}

uint32_t slc_train_flags(const struct slc_train_plan *plan, uint32_t step)
{
    uint32_t flags = TRAIN_QUANTIZE_INPUTS;
    if ((double)step >= QUANTIZE_FROM * plan->step_count)
        flags |= TRAIN_ROUND_LATENTS | TRAIN_QUANTIZE_NETWORK;
    flags |= step < plan->step_count ? TRAIN_LATENTS : TRAIN_FP8;
    return flags;
}

/* Returns the rate's share: from half to all in the first part of the steps, then down to 0. */
static double cosine(double done)
{
    return 0.5 * fmin(done / RISE, 1.0) + 0.5 * cos(PI * fmin(done, 1.0));
}

static double network_rate(const struct slc_train_plan *plan, uint32_t step)
{
    if (step < plan->step_count)
        return plan->network_rate * cosine((double)step / plan->step_count);
    /* The FP8 network continues from the int8 network. */
    double done = (double)(step - plan->step_count) / plan->fp8_steps;
    return plan->network_rate * FP8_RATE * cosine(done);
}

/* Returns the correction for moments that start at 0. */
static double correction(uint32_t step)
{
    double t = (double)step + 1.0;
    return sqrt(1.0 - pow(DECAY2, t)) / (1.0 - pow(DECAY1, t));
}

void slc_train_write_push(const struct slc_train_plan *plan, uint32_t step,
                          struct slc_train_push *push)
{
    *push = (struct slc_train_push){
        .step = step,
        .seed = plan->seed,
        .flags = step == UINT32_MAX ? 0 : slc_train_flags(plan, step) | TRAIN_UPDATE,
        .nextFlags = slc_train_flags(plan, step + 1u),
        .mipCount = plan->mip_count,
        .tileCount = plan->tile_count,
        .latentCount = slc_train_latent_count(plan),
        .channelCount = plan->channel_count,
        .latentUnit = slc_train_latent_unit(plan),
        .decay1 = (float)DECAY1,
        .decay2 = (float)DECAY2};
    if (step == UINT32_MAX)
        return;
    double latent_rate = plan->latent_rate * cosine((double)step / plan->step_count);
    push->networkRate = (float)(network_rate(plan, step) * correction(step));
    push->latentRate = (float)(latent_rate * correction(step));
}
