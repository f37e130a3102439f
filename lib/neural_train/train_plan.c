#include "neural_train/train_plan.h"

#include "base/checked.h"
#include "base/log.h"

#include <math.h>
#include <string.h>

#define MAX_SIZE 16384u
#define MAX_BATCH (1u << 20)
#define MAX_STEPS 10000000u
#define MAX_LATENTS (UINT64_C(1) << 30) /* 4 bytes each: no device has a larger range */
#define MASK_MARGIN 0.02f               /* five steps of 8 bits beyond 0 and 1 */

static const uint32_t default_steps = 20000, default_batch = 65536;
static const float default_network_rate = 0.02f, default_latent_rate = 0.1f;

struct range {
    const char *name;
    uint32_t value, least, most;
};

static SluiceResult check_ranges(const SluiceNeuralCompressorCreateInfo *info,
                                 const SluiceLogCallback *log)
{
    uint32_t size = slc_max_u32(info->width, info->height);
    const struct range ranges[] = {
        {"width", info->width, 1, MAX_SIZE},
        {"height", info->height, 1, MAX_SIZE},
        {"mipCount", info->mipCount, 0, size ? slc_mip_count(size) : 0},
        {"channelCount", info->channelCount, 1, SLUICE_NEURAL_COMPRESS_MAX_CHANNELS},
        {"gridSizeScale", info->gridSizeScale, 0, 6},
        {"featureCount", info->featureCount, 0, 16},
        {"stepCount", info->stepCount, 0, MAX_STEPS},
        {"batchSize", info->batchSize, 0, MAX_BATCH},
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++)
        if (ranges[i].value < ranges[i].least || ranges[i].value > ranges[i].most)
            return slc_log_refusal(log, "%s is %u, must be %u to %u", ranges[i].name,
                                   ranges[i].value, ranges[i].least, ranges[i].most);
    if (info->featureCount % 4)
        return slc_log_refusal(log, "featureCount is %u, must be a multiple of 4",
                               info->featureCount);
    if (info->batchSize % TRAIN_TILE)
        return slc_log_refusal(log, "batchSize is %u, must be a multiple of %d", info->batchSize,
                               TRAIN_TILE);
    return SLUICE_SUCCESS;
}

static bool is_rate(float rate)
{
    return rate >= 0.0f && rate <= 1.0f;
}

static SluiceResult check_values(const SluiceNeuralCompressorCreateInfo *info,
                                 const SluiceLogCallback *log)
{
    if (!is_rate(info->networkRate))
        return slc_log_refusal(log, "networkRate is %g, must be 0 to 1", (double)info->networkRate);
    if (!is_rate(info->latentRate))
        return slc_log_refusal(log, "latentRate is %g, must be 0 to 1", (double)info->latentRate);
    for (uint32_t c = 0; c < info->channelCount; c++) {
        float weight = info->pChannels[c].weight;
        if (!(weight >= 0.0f && weight <= 1000.0f))
            return slc_log_refusal(log, "pChannels[%u].weight is %g, must be 0 to 1000", c,
                                   (double)weight);
    }
    return SLUICE_SUCCESS;
}

/* Plans the latent images by NTC_FORMAT: pairs of images, each half as large as its predecessor. */
static void plan_images(struct slc_train_plan *plan)
{
    uint32_t width = slc_max_u32(plan->width / plan->scale, 1);
    uint32_t height = slc_max_u32(plan->height / plan->scale, 1);
    uint32_t levels = slc_mip_count(slc_max_u32(width, height));
    plan->image_count = slc_min_u32((levels + 1) & ~1u, SLC_TRAIN_MAX_LATENT_IMAGES);
    for (uint32_t n = 0; n < plan->image_count; n++) {
        plan->images[n] = (struct slc_latent_image){slc_mip_size(plan->width / plan->scale, n),
                                                    slc_mip_size(plan->height / plan->scale, n),
                                                    plan->latent_texels};
        plan->latent_texels += plan->images[n].width * plan->images[n].height;
    }
}

/* Checks the number of latents, which shaders count in 32 bits. Errors: INVALID_ARGUMENT. */
static SluiceResult check_latents(const struct slc_train_plan *plan, const SluiceLogCallback *log)
{
    uint64_t count = (uint64_t)plan->latent_texels * plan->feature_count;
    if (count <= MAX_LATENTS)
        return SLUICE_SUCCESS;
    return slc_log_refusal(log,
                           "%u x %u texels, gridSizeScale %u and featureCount %u make %llu "
                           "latents; at most 2^30 are possible",
                           plan->width, plan->height, plan->scale, plan->feature_count,
                           (unsigned long long)count);
}

/* Distributes samples to mips in proportion to texels; each mip has at least one tile. */
static void plan_samples(struct slc_train_plan *plan)
{
    double total = (double)plan->texel_count;
    uint32_t rest = plan->tile_count;
    for (uint32_t m = plan->mip_count - 1; m > 0; m--) {
        double texels = (double)slc_mip_size(plan->width, m) * slc_mip_size(plan->height, m);
        uint32_t tiles = (uint32_t)(texels / total * plan->tile_count + 0.5);
        plan->mip_tiles[m] = slc_max_u32(tiles, 1);
        rest -= slc_min_u32(plan->mip_tiles[m], rest);
    }
    plan->mip_tiles[0] = slc_max_u32(rest, 1);
    plan->tile_count = 0;
    for (uint32_t m = 0; m < plan->mip_count; m++)
        plan->tile_count += plan->mip_tiles[m];
}

SluiceResult slc_train_plan_init(struct slc_train_plan *plan,
                                 const SluiceNeuralCompressorCreateInfo *info,
                                 const SluiceLogCallback *log)
{
    if (!info->pChannels || !info->ppMips)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = check_ranges(info, log);
    if (result == SLUICE_SUCCESS)
        result = check_values(info, log);
    if (result != SLUICE_SUCCESS)
        return result;
    uint32_t size = slc_max_u32(info->width, info->height);
    uint32_t batch = info->batchSize ? info->batchSize : default_batch;
    *plan = (struct slc_train_plan){
        .width = info->width,
        .height = info->height,
        .mip_count = info->mipCount ? info->mipCount : slc_mip_count(size),
        .channel_count = info->channelCount,
        .scale = info->gridSizeScale ? info->gridSizeScale : 4,
        .feature_count = info->featureCount ? info->featureCount : 16,
        .step_count = info->stepCount ? info->stepCount : default_steps,
        .tile_count = batch / TRAIN_TILE,
        .seed = info->seed,
        .network_rate = info->networkRate > 0.0f ? info->networkRate : default_network_rate,
        .latent_rate = info->latentRate > 0.0f ? info->latentRate : default_latent_rate};
    plan->fp8_steps = plan->step_count / 20;
    for (uint32_t m = 0; m < plan->mip_count; m++) {
        if (!info->ppMips[m])
            return SLUICE_ERROR_NULL_POINTER;
        plan->texel_count += (uint64_t)slc_mip_size(plan->width, m) * slc_mip_size(plan->height, m);
    }
    memcpy(plan->channels, info->pChannels, info->channelCount * sizeof *plan->channels);
    plan_images(plan);
    plan_samples(plan);
    return check_latents(plan, log);
}

uint32_t slc_train_first_image(const struct slc_train_plan *plan, uint32_t mip)
{
    static const int shared[6] = {2, 3, 3, 3, 4, 4};
    int n = ((int)mip - shared[plan->scale - 1] + 2) & ~1;
    int last = (int)plan->image_count - 2;
    return (uint32_t)(n < 0 ? 0 : n > last ? last : n);
}

float slc_train_position_scale(const struct slc_train_plan *plan, uint32_t mip)
{
    const struct slc_latent_image *image = &plan->images[slc_train_first_image(plan, mip)];
    float x = (float)image->width / (float)slc_mip_size(plan->width, mip);
    float y = (float)image->height / (float)slc_mip_size(plan->height, mip);
    return 0.5f * (x > y ? x : y);
}

float slc_train_position_lod(const struct slc_train_plan *plan, uint32_t mip)
{
    float lod = 0.25f * log2f(slc_train_position_scale(plan, mip));
    return lod < -1.0f ? -1.0f : lod > 1.0f ? 1.0f : lod;
}

uint32_t slc_train_latent_count(const struct slc_train_plan *plan)
{
    return plan->latent_texels * plan->feature_count;
}

static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static void write_image(const struct slc_train_plan *plan, uint32_t image, uint32_t *words)
{
    words[0] = plan->images[image].first_texel * (plan->feature_count / 2);
    words[1] = plan->images[image].width;
    words[2] = plan->images[image].height;
}

void slc_train_write_table(const struct slc_train_plan *plan, uint32_t *table)
{
    memset(table, 0, TRAIN_TABLE_WORDS * sizeof *table);
    uint32_t texel = 0, tile = 0;
    for (uint32_t m = 0; m < plan->mip_count; m++) {
        uint32_t *mip = table + (size_t)m * TRAIN_MIP_WORDS;
        uint32_t width = slc_mip_size(plan->width, m), height = slc_mip_size(plan->height, m);
        mip[TRAIN_MIP_FIRST_TEXEL] = texel;
        mip[TRAIN_MIP_WIDTH] = width;
        mip[TRAIN_MIP_HEIGHT] = height;
        mip[TRAIN_MIP_FIRST_TILE] = tile;
        mip[TRAIN_MIP_STRATUM] = slc_div_up_u32(width * height, plan->mip_tiles[m] * TRAIN_TILE);
        write_image(plan, slc_train_first_image(plan, m), mip + TRAIN_MIP_FINE);
        write_image(plan, slc_train_first_image(plan, m) + 1, mip + TRAIN_MIP_COARSE);
        mip[TRAIN_MIP_POSITION_SCALE] = bits_of(slc_train_position_scale(plan, m));
        mip[TRAIN_MIP_LOD] = bits_of(slc_train_position_lod(plan, m));
        texel += width * height;
        tile += plan->mip_tiles[m];
    }
    for (uint32_t c = 0; c < plan->channel_count; c++) {
        const SluiceNeuralTrainingChannel *channel = &plan->channels[c];
        uint32_t *words = table + TRAIN_CHANNELS + (size_t)c * TRAIN_CHANNEL_WORDS;
        words[TRAIN_CHANNEL_WEIGHT] = bits_of(channel->weight > 0.0f ? channel->weight : 1.0f);
        words[TRAIN_CHANNEL_MARGIN] = bits_of(channel->mask ? MASK_MARGIN : 0.0f);
        words[TRAIN_CHANNEL_CLAMPED] = channel->clamped || channel->mask;
    }
}

float slc_train_latent_unit(const struct slc_train_plan *plan)
{
    double samples[SLC_TRAIN_MAX_LATENT_IMAGES] = {0}, most = 1.0;
    for (uint32_t m = 0; m < plan->mip_count; m++) {
        samples[slc_train_first_image(plan, m)] += plan->mip_tiles[m] * (double)TRAIN_TILE;
        samples[slc_train_first_image(plan, m) + 1] += plan->mip_tiles[m] * (double)TRAIN_TILE;
    }
    for (uint32_t n = 0; n < plan->image_count; n++) {
        const struct slc_latent_image *image = &plan->images[n];
        /* A sample has four corners. Strata spread samples over the image, so 8 is far above the
         * number of samples at one texel. */
        double texels = (double)image->width * image->height;
        double mean = 4.0 * samples[n] / texels * 8.0;
        most = fmax(most, fmin(mean, 4.0 * samples[n]));
    }
    /* A sample's gradient is clamped to 8. */
    double unit = exp2(floor(log2(2147483648.0 / (8.0 * most))));
    return (float)fmin(unit, 1048576.0);
}
