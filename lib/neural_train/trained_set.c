/* Training results in the file's format: latents as 4-bit codes, both networks as blobs. */
#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "neural_train/neural_compressor.h"
#include "neural_train/trained_network.h"
#include "vulkan/context.h"

#include <math.h>
#include <string.h>

#define FEATURES_PER_TEXEL 4u /* features of a texel in a layer */

static uint32_t result_texels(const struct slc_train_plan *plan)
{
    return plan->latent_texels * (plan->feature_count / FEATURES_PER_TEXEL);
}

/* Returns a latent's code, also for NaN from diverged training. */
static uint16_t code_of(float latent)
{
    float code = rintf(latent * 15.0f);
    return (uint16_t)(code >= 0.0f ? fminf(code, 15.0f) : 0.0f);
}

static void pack_image(const struct slc_train_plan *plan, const struct slc_latent_image *image,
                       const float *latents, uint16_t *texels)
{
    const uint32_t count = image->width * image->height, features = plan->feature_count;
    for (uint32_t layer = 0; layer < features / FEATURES_PER_TEXEL; layer++)
        for (uint32_t i = 0; i < count; i++) {
            const float *at = latents + (size_t)(image->first_texel + i) * features +
                              (size_t)layer * FEATURES_PER_TEXEL;
            *texels++ = (uint16_t)(code_of(at[0]) | code_of(at[1]) << 4 | code_of(at[2]) << 8 |
                                   code_of(at[3]) << 12);
        }
}

static void append(char **to, const void *from, size_t size)
{
    memcpy(*to, from, size);
    *to += size;
}

static void pack_networks(SluiceNeuralCompressor *c)
{
    struct slc_int8_network int8;
    struct slc_fp8_network fp8;
    slc_network_to_int8(slc_train_read_int8(c), &int8);
    slc_network_to_fp8(slc_train_read_fp8(c), &fp8);
    char *at = c->int8_blob;
    append(&at, int8.weights, sizeof int8.weights);
    append(&at, int8.scales, sizeof int8.scales);
    append(&at, int8.biases, sizeof int8.biases);
    at = c->fp8_blob;
    append(&at, fp8.weights, sizeof fp8.weights);
    append(&at, fp8.biases, sizeof fp8.biases);
    append(&at, fp8.scales, sizeof fp8.scales);
    append(&at, fp8.last_biases, sizeof fp8.last_biases);
}

static void describe(const SluiceNeuralCompressor *c, SluiceNeuralTrainedSet *set)
{
    const struct slc_train_plan *plan = &c->plan;
    *set = (SluiceNeuralTrainedSet){.structSize = sizeof *set,
                                    .mipCount = plan->mip_count,
                                    .featureCount = plan->feature_count,
                                    .latentImageCount = plan->image_count,
                                    .pInt8Weights = c->int8_blob,
                                    .int8Size = sizeof c->int8_blob,
                                    .pFp8Weights = c->fp8_blob,
                                    .fp8Size = sizeof c->fp8_blob};
    for (uint32_t n = 0; n < plan->image_count; n++) {
        size_t first = (size_t)plan->images[n].first_texel;
        set->latentImages[n] = (SluiceNeuralTrainedImage){
            plan->images[n].width, plan->images[n].height,
            c->texels + first * (plan->feature_count / FEATURES_PER_TEXEL)};
    }
    for (uint32_t m = 0; m < plan->mip_count; m++)
        set->mips[m] = (SluiceNeuralTrainedMip){slc_train_first_image(plan, m),
                                                slc_train_position_lod(plan, m),
                                                slc_train_position_scale(plan, m)};
}

SluiceResult sluiceGetNeuralTrainedSet(SluiceNeuralCompressor *compressor,
                                       SluiceNeuralTrainedSet *pSet)
{
    SluiceNeuralCompressor *c = compressor;
    if (!c || !pSet)
        return SLUICE_ERROR_NULL_POINTER;
    const SluiceLogCallback *log = &c->context->vk.log;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceNeuralTrainedSet), pSet, log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!c->has_readback)
        return slc_log_refusal(log, "sluiceGetNeuralTrainedSet: no readback yet");
    if (!c->texels)
        c->texels = slc_alloc(&c->context->cb, result_texels(&c->plan), sizeof *c->texels);
    if (!c->texels)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    for (uint32_t n = 0; n < c->plan.image_count; n++) {
        size_t first = (size_t)c->plan.images[n].first_texel;
        pack_image(&c->plan, &c->plan.images[n], slc_train_read_latents(c),
                   c->texels + first * (c->plan.feature_count / FEATURES_PER_TEXEL));
    }
    pack_networks(c);
    SluiceNeuralTrainedSet set;
    describe(c, &set);
    slc_struct_write(SLC_STRUCT(SluiceNeuralTrainedSet), pSet, &set);
    return SLUICE_SUCCESS;
}

void slc_train_free_result(SluiceNeuralCompressor *compressor)
{
    slc_free(&compressor->context->cb, compressor->texels, result_texels(&compressor->plan),
             sizeof *compressor->texels);
}
