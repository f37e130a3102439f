#include "bake/bc7_modes.h"

#include "bake/block_partitions.h"
#include "bake/block_regions.h"

#include <stddef.h>

static void take_ends(const struct slc_bc7_fit *fit, int lane, int first, int count,
                      uint8_t ends[2][4])
{
    for (int e = 0; e < 2; e++)
        for (int c = 0; c < count; c++)
            ends[e][first + c] = (uint8_t)fit->ends[e][c][lane];
}

void slc_bc7_try_mode_6(const struct slc_bc7_texels *texels, int rounds,
                        struct slc_bc7_block *blocks[SLC_LANES])
{
    static const struct slc_bc7_precision precision = {8, SLC_P_BITS_OWN, 16};
    const slc_floats(*c)[16] = texels->channels;
    const struct slc_fit_points points = {4, {c[0], c[1], c[2], c[3]}, NULL};
    struct slc_bc7_fit fit;
    slc_bc7_fit_points(&points, &precision, texels->is_opaque, rounds, &fit);
    for (int l = 0; l < SLC_LANES; l++) {
        struct slc_bc7_block *block = blocks[l];
        if (fit.error[l] >= block->error)
            continue;
        *block = (struct slc_bc7_block){.error = fit.error[l], .mode = 6};
        take_ends(&fit, l, 0, 4, block->ends[0]);
        for (int i = 0; i < 16; i++)
            block->indices[0][i] = (uint8_t)fit.indices[i][l];
    }
}

static void fit_region(const struct slc_bc7_texels *texels, int rounds, slc_ints mask, int region,
                       struct slc_bc7_fit *fit)
{
    static const struct slc_bc7_precision precision = {7, SLC_P_BITS_SHARED, 8};
    const slc_floats(*c)[16] = texels->channels;
    slc_floats weights[16];
    const struct slc_fit_points points = {3, {c[0], c[1], c[2]}, weights};
    for (int i = 0; i < 16; i++)
        weights[i] = slc_to_floats(region ? mask >> i & 1 : ~(mask >> i) & 1);
    slc_bc7_fit_points(&points, &precision, (slc_ints){0}, rounds, fit);
}

void slc_bc7_try_mode_1(const struct slc_bc7_texels *texels, int rounds, int partitions, int tries,
                        struct slc_bc7_block *blocks[SLC_LANES])
{
    slc_floats estimates[SLC_PARTITION_COUNT];
    slc_estimate_regions(texels->channels, partitions, estimates);
    for (int t = 0; t < tries; t++) {
        struct slc_bc7_fit fits[2];
        slc_ints partition = slc_take_regions(estimates, partitions), mask = {0};
        for (int l = 0; l < SLC_LANES; l++)
            mask[l] = slc_partitions[partition[l]];
        fit_region(texels, rounds, mask, 0, &fits[0]);
        fit_region(texels, rounds, mask, 1, &fits[1]);
        slc_floats error = fits[0].error + fits[1].error;
        for (int l = 0; l < SLC_LANES; l++) {
            struct slc_bc7_block *block = blocks[l];
            if (!texels->is_opaque[l] || error[l] >= block->error)
                continue;
            *block = (struct slc_bc7_block){
                .error = error[l], .mode = 1, .partition = (uint8_t)partition[l]};
            take_ends(&fits[0], l, 0, 3, block->ends[0]);
            take_ends(&fits[1], l, 0, 3, block->ends[1]);
            for (int i = 0; i < 16; i++)
                block->indices[0][i] = (uint8_t)fits[mask[l] >> i & 1].indices[i][l];
        }
    }
}

/* Stores the two fits of modes 4 and 5, of three channels and of the separate one, if better. */
static void take_two(const struct slc_bc7_fit *colors, const struct slc_bc7_fit *alpha,
                     const struct slc_bc7_block *kind, struct slc_bc7_block *blocks[SLC_LANES])
{
    slc_floats error = colors->error + alpha->error;
    for (int l = 0; l < SLC_LANES; l++) {
        struct slc_bc7_block *block = blocks[l];
        if (error[l] >= block->error)
            continue;
        *block = *kind;
        block->error = error[l];
        take_ends(colors, l, 0, 3, block->ends[0]);
        take_ends(alpha, l, 3, 1, block->ends[0]);
        for (int i = 0; i < 16; i++) {
            block->indices[0][i] = (uint8_t)colors->indices[i][l];
            block->indices[1][i] = (uint8_t)alpha->indices[i][l];
        }
    }
}

/* Separates one channel from three. `rotation` 1 to 3 swaps alpha with R, G or B. */
static void split(const struct slc_bc7_texels *texels, int rotation, struct slc_fit_points *colors,
                  struct slc_fit_points *alpha)
{
    *colors = (struct slc_fit_points){.channel_count = 3};
    *alpha = (struct slc_fit_points){.channel_count = 1};
    for (int c = 0; c < 3; c++)
        colors->channels[c] = texels->channels[c + 1 == rotation ? 3 : c];
    alpha->channels[0] = texels->channels[rotation ? rotation - 1 : 3];
}

void slc_bc7_try_mode_4(const struct slc_bc7_texels *texels, int rounds, int rotation,
                        struct slc_bc7_block *blocks[SLC_LANES])
{
    static const struct slc_bc7_precision color_4 = {5, SLC_P_BITS_NONE, 4};
    static const struct slc_bc7_precision color_8 = {5, SLC_P_BITS_NONE, 8};
    static const struct slc_bc7_precision alpha_4 = {6, SLC_P_BITS_NONE, 4};
    static const struct slc_bc7_precision alpha_8 = {6, SLC_P_BITS_NONE, 8};
    struct slc_fit_points colors, alpha;
    struct slc_bc7_fit color_fit, alpha_fit;
    const slc_ints none = {0};
    struct slc_bc7_block kind = {.mode = 4, .rotation = (uint8_t)rotation};
    split(texels, rotation, &colors, &alpha);
    colors.channel_count = 3; /* a constant for the inlined fit */
    alpha.channel_count = 1;
    slc_bc7_fit_points(&colors, &color_4, none, rounds, &color_fit);
    slc_bc7_fit_points(&alpha, &alpha_8, none, rounds, &alpha_fit);
    take_two(&color_fit, &alpha_fit, &kind, blocks);
    kind.swaps_indices = 1;
    slc_bc7_fit_points(&colors, &color_8, none, rounds, &color_fit);
    slc_bc7_fit_points(&alpha, &alpha_4, none, rounds, &alpha_fit);
    take_two(&color_fit, &alpha_fit, &kind, blocks);
}

void slc_bc7_try_mode_5(const struct slc_bc7_texels *texels, int rounds, int rotation,
                        struct slc_bc7_block *blocks[SLC_LANES])
{
    static const struct slc_bc7_precision color = {7, SLC_P_BITS_NONE, 4};
    static const struct slc_bc7_precision plain = {8, SLC_P_BITS_NONE, 4};
    struct slc_fit_points colors, alpha;
    struct slc_bc7_fit color_fit, alpha_fit;
    const slc_ints none = {0};
    const struct slc_bc7_block kind = {.mode = 5, .rotation = (uint8_t)rotation};
    split(texels, rotation, &colors, &alpha);
    colors.channel_count = 3;
    alpha.channel_count = 1;
    slc_bc7_fit_points(&colors, &color, none, rounds, &color_fit);
    slc_bc7_fit_points(&alpha, &plain, none, rounds, &alpha_fit);
    take_two(&color_fit, &alpha_fit, &kind, blocks);
}
