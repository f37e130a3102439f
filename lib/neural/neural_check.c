#include "neural/neural_set.h"

#include "base/checked.h"

#include <math.h>

static SluiceResult corrupt(const struct SluiceNeuralSet *set, const char *field, uint64_t value,
                            const char *limit)
{
    return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA, "%s is %llu; %s", field,
                          (unsigned long long)value, limit);
}

struct slc_neural_shape slc_neural_shape_of(SluiceNeuralNetwork network)
{
    if (network == SLUICE_NEURAL_NETWORK_SCHEMA3)
        return (struct slc_neural_shape){{48, 64, 48, 32}, {64, 48, 32, 16}};
    return (struct slc_neural_shape){{48 + 16 * (uint32_t)network, 64, 64, 64}, {64, 64, 64, 16}};
}

static SluiceResult check_root(const struct SluiceNeuralSet *set,
                               const struct slc_neural_document *d)
{
    if (d->schema != 1 && d->schema != 3)
        return slc_input_fail(&set->file, SLUICE_ERROR_UNSUPPORTED,
                              "schemaVersion is %u; 1 and 3 are read", d->schema);
    if (d->width == 0 || d->height == 0)
        return corrupt(set, d->width ? "height" : "width", 0, "at least 1 texel is needed");
    if (d->width > SLUICE_NEURAL_MAX_SIZE || d->height > SLUICE_NEURAL_MAX_SIZE)
        return slc_input_fail(&set->file, SLUICE_ERROR_UNSUPPORTED,
                              "has %u x %u texels; at most %d in each direction are read", d->width,
                              d->height, SLUICE_NEURAL_MAX_SIZE);
    if (d->channel_count == 0 || d->channel_count > SLUICE_NEURAL_MAX_CHANNELS)
        return corrupt(set, "numChannels", d->channel_count, "1 to 16 are possible");
    if (d->color_space_count && d->color_space_count != d->channel_count)
        return corrupt(set, "the length of channels", d->color_space_count,
                       "numChannels differs from it");
    if (d->mip_count == 0 || d->mip_count > slc_mip_count(slc_max_u32(d->width, d->height)))
        return corrupt(set, "numColorMips", d->mip_count, "that many the size does not have");
    if (d->color_mip_count != d->mip_count && !(d->schema == 1 && d->color_mip_count == 0))
        return corrupt(set, "the length of colorMips", d->color_mip_count,
                       "numColorMips differs from it");
    return SLUICE_SUCCESS;
}

static SluiceResult check_textures(struct SluiceNeuralSet *set, const struct slc_neural_document *d)
{
    for (uint32_t i = 0; i < d->texture_count; i++) {
        const struct slc_neural_document_texture *texture = &d->textures[i];
        uint32_t first = texture->first_channel, count = texture->channel_count;
        if (count == 0 || count > 4)
            return corrupt(set, "numChannels of a texture", count, "1 to 4 are possible");
        if (first >= d->channel_count || count > d->channel_count - first)
            return corrupt(set, "firstChannel of a texture", first,
                           "its channels are not below numChannels");
        set->info.validChannels |= ((1u << count) - 1) << first;
        set->textures[i] = *texture;
    }
    for (uint32_t i = 0; i < d->color_space_count; i++)
        set->color_spaces[i] = d->color_spaces[i];
    set->info.textureCount = d->texture_count;
    return SLUICE_SUCCESS;
}

static bool is_feature_count(uint32_t count)
{
    return count == 4 || count == 8 || count == 12 || count == 16;
}

static bool is_bit_count(uint32_t bits)
{
    return bits == 1 || bits == 2 || bits == 4 || bits == 8;
}

static SluiceResult check_shape(struct SluiceNeuralSet *set, const struct slc_neural_document *d)
{
    bool is_one = d->schema == 1;
    SluiceNeuralSetInfo *info = &set->info;
    info->highFeatures = is_one ? d->high_features : d->features;
    info->lowFeatures = is_one ? d->low_features : d->features;
    info->highBits = is_one ? d->high_bits : 4;
    info->lowBits = is_one ? d->low_bits : 4;
    if (!is_feature_count(info->highFeatures))
        return corrupt(set, is_one ? "highResFeatures" : "numFeatures", info->highFeatures,
                       "4, 8, 12 and 16 are possible");
    if (!is_feature_count(info->lowFeatures))
        return corrupt(set, "lowResFeatures", info->lowFeatures, "4, 8, 12 and 16 are possible");
    if (!is_bit_count(info->highBits))
        return corrupt(set, "highResQuantBits", info->highBits, "1, 2, 4 and 8 are possible");
    if (!is_bit_count(info->lowBits))
        return corrupt(set, "lowResQuantBits", info->lowBits, "1, 2, 4 and 8 are possible");
    return SLUICE_SUCCESS;
}

SluiceResult slc_neural_find_view(const struct SluiceNeuralSet *set,
                                  const struct slc_neural_document *d, uint32_t index,
                                  uint64_t size, struct slc_neural_view *view)
{
    if (index >= d->view_count)
        return corrupt(set, "the index of a view", index, "there is no such view");
    *view = d->views[index];
    if (view->offset > set->data_size || view->stored_size > set->data_size - view->offset)
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "view %u has %llu bytes at %llu; the data chunk has %llu", index,
                              (unsigned long long)view->stored_size,
                              (unsigned long long)view->offset, (unsigned long long)set->data_size);
    uint64_t has = view->is_compressed ? view->size : view->stored_size;
    if (has != size)
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "view %u has %llu bytes uncompressed, not %llu", index,
                              (unsigned long long)has, (unsigned long long)size);
    view->offset += set->data_offset;
    view->size = size;
    return SLUICE_SUCCESS;
}

static SluiceResult check_grid_size(const struct SluiceNeuralSet *set, uint32_t width,
                                    uint32_t height)
{
    if (width && height && width <= SLUICE_NEURAL_MAX_SIZE && height <= SLUICE_NEURAL_MAX_SIZE)
        return SLUICE_SUCCESS;
    return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                          "has latents of %u x %u texels; 1 to %d are possible", width, height,
                          SLUICE_NEURAL_MAX_SIZE);
}

/* Adds a bit-packed grid of schema 1. */
static SluiceResult add_grid(struct SluiceNeuralSet *set, const struct slc_neural_document *d,
                             const struct slc_neural_grid *shape, uint32_t bits_per_texel,
                             uint32_t view)
{
    struct slc_neural_grid *grid = &set->grids[set->grid_count++];
    *grid = *shape;
    grid->part_count = 1;
    SluiceResult result = check_grid_size(set, grid->width, grid->height);
    if (result != SLUICE_SUCCESS)
        return result;
    if (bits_per_texel && bits_per_texel != grid->features * grid->bits)
        return corrupt(set, "the bits per pixel of latents", bits_per_texel,
                       "features times bits differ from it");
    uint64_t codes = (uint64_t)grid->width * grid->height * grid->features;
    uint64_t size = (codes * grid->bits + 31) / 32 * 4;
    return slc_neural_find_view(set, d, view, size, &grid->parts[0]);
}

static SluiceResult add_latent_1(struct SluiceNeuralSet *set, const struct slc_neural_document *d,
                                 const struct slc_neural_document_latents *latents)
{
    const SluiceNeuralSetInfo *info = &set->info;
    struct slc_neural_grid high = {.width = latents->width,
                                   .height = latents->height,
                                   .features = info->highFeatures,
                                   .bits = info->highBits};
    struct slc_neural_grid low = {.width = latents->low_width,
                                  .height = latents->low_height,
                                  .features = info->lowFeatures,
                                  .bits = info->lowBits};
    SluiceResult result = add_grid(set, d, &high, latents->high_bits_per_texel, latents->high_view);
    if (result != SLUICE_SUCCESS)
        return result;
    return add_grid(set, d, &low, latents->low_bits_per_texel, latents->low_view);
}

static SluiceResult add_latent_3(struct SluiceNeuralSet *set, const struct slc_neural_document *d,
                                 const struct slc_neural_document_latents *latents)
{
    struct slc_neural_grid *grid = &set->grids[set->grid_count++];
    *grid = (struct slc_neural_grid){.width = latents->width,
                                     .height = latents->height,
                                     .features = d->features,
                                     .bits = 4,
                                     .part_count = d->features / 4};
    SluiceResult result = check_grid_size(set, grid->width, grid->height);
    if (result != SLUICE_SUCCESS)
        return result;
    if (latents->layer_view_count != grid->part_count)
        return corrupt(set, "the length of layerViews", latents->layer_view_count,
                       "numFeatures / 4 differs from it");
    uint64_t size = (uint64_t)grid->width * grid->height * 2;
    for (uint32_t i = 0; i < grid->part_count && result == SLUICE_SUCCESS; i++)
        result = slc_neural_find_view(set, d, latents->layer_views[i], size, &grid->parts[i]);
    return result;
}

static uint32_t rounded_ratio(uint32_t size, uint32_t grid)
{
    return (2 * size + grid) / (2 * grid);
}

static SluiceResult check_latents(struct SluiceNeuralSet *set, const struct slc_neural_document *d)
{
    SluiceResult result = SLUICE_SUCCESS;
    if (d->latent_count == 0 || (d->schema == 3 && d->latent_count % 2))
        return corrupt(set, "the length of latents", d->latent_count,
                       "at least 1, in schema 3 an even number, is needed");
    for (uint32_t i = 0; i < d->latent_count && result == SLUICE_SUCCESS; i++)
        result = (d->schema == 1 ? add_latent_1 : add_latent_3)(set, d, &d->latents[i]);
    if (result != SLUICE_SUCCESS)
        return result;
    for (uint32_t g = 0; g < set->grid_count; g++)
        for (uint32_t p = 0; p < set->grids[g].part_count; p++)
            set->info.latentSize += set->grids[g].parts[p].stored_size;
    set->info.latentImageCount = d->latent_count;
    set->info.gridScale =
        slc_max_u32(1, slc_min_u32(rounded_ratio(d->width, set->grids[0].width),
                                   rounded_ratio(d->height, set->grids[0].height)));
    return SLUICE_SUCCESS;
}

/* Returns a mip's latents by the writer's rule, for files of version 0.5, which do not store them.
 */
static struct slc_neural_document_mip missing_mip(const struct slc_neural_document *d,
                                                  uint32_t scale, uint32_t mip)
{
    uint32_t own = slc_mip_count(scale - 1); /* ceil(log2(scale)) */
    uint32_t latent = slc_min_u32(d->latent_count - 1, mip > own ? (mip - own) / 2 : 0);
    return (struct slc_neural_document_mip){.latent_mip = latent};
}

static void complete_position(struct slc_neural_document_mip *m, uint32_t schema, uint32_t mip)
{
    double level = (double)mip - 2.0 * m->latent_mip;
    if (schema == 1 && !(m->has_position & 1))
        m->position_lod = level / 3;
    if (schema == 1 && !(m->has_position & 2))
        m->position_scale = exp2(level);
    if (schema == 1)
        m->has_position = 3;
}

static SluiceResult check_mip(struct SluiceNeuralSet *set, const struct slc_neural_document *d,
                              uint32_t mip)
{
    struct slc_neural_document_mip m = d->mips[mip];
    uint32_t width = slc_mip_size(d->width, mip), height = slc_mip_size(d->height, mip);
    uint32_t uses = d->schema == 1 ? 1 : 2;
    if (d->schema == 1 && (d->color_mip_count == 0 || m.latent_mip == SLC_NONE))
        m = missing_mip(d, set->info.gridScale, mip);
    if ((m.width && m.width != width) || (m.height && m.height != height))
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "mip %u has %u x %u texels, not %u x %u", mip, m.width, m.height,
                              width, height);
    if (m.latent_mip >= d->latent_count || m.latent_mip % uses)
        return corrupt(set, "latentMip", m.latent_mip, "there are no such latents for a mip");
    complete_position(&m, d->schema, mip);
    if (m.has_position != 3 || !(fabs(m.position_lod) <= 1024) ||
        !(m.position_scale > 0 && m.position_scale <= 65536))
        return slc_input_fail(&set->file, SLUICE_ERROR_CORRUPT_DATA,
                              "positionLod or positionScale of mip %u is missing or out of range",
                              mip);
    set->mips[mip] = (struct slc_neural_mip){
        .width = width,
        .height = height,
        .first_grid = d->schema == 1 ? 2 * m.latent_mip : m.latent_mip,
        .position_lod = (float)m.position_lod,
        .position_scale = (float)m.position_scale,
    };
    if (mip && set->mips[mip].first_grid < set->mips[mip - 1].first_grid)
        return corrupt(set, "latentMip", m.latent_mip, "a finer mip has coarser latents");
    return SLUICE_SUCCESS;
}

static SluiceResult check_mips(struct SluiceNeuralSet *set, const struct slc_neural_document *d)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (uint32_t i = 0; i < d->mip_count && result == SLUICE_SUCCESS; i++)
        result = check_mip(set, d, i);
    return result;
}

SluiceResult slc_neural_check(struct SluiceNeuralSet *set,
                              const struct slc_neural_document *document)
{
    SluiceResult (*const checks[])(struct SluiceNeuralSet *, const struct slc_neural_document *) = {
        check_textures, check_shape, check_latents, check_mips};
    SluiceResult result = check_root(set, document);
    set->info.schema = document->schema;
    set->info.width = document->width;
    set->info.height = document->height;
    set->info.mipCount = document->mip_count;
    set->info.channelCount = document->channel_count;
    for (size_t i = 0; i < sizeof checks / sizeof *checks && result == SLUICE_SUCCESS; i++)
        result = checks[i](set, document);
    return result;
}
