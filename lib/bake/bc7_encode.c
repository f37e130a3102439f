#include "bake/bc7_encode.h"

#include "bake/bc7_modes.h"
#include "bake/block_bits.h"
#include "bake/block_partitions.h"

#include <assert.h>
#include <float.h>
#include <string.h>

#define BATCH 64

/* Work per quality. tests/bake/encoder_figures measures time and PSNR. Errors are sums of squares
 * over a block. */
struct effort {
    int rounds;           ///< number of refinements of the ends of mode 6
    float enough;         ///< other modes are tried if mode 6 has a larger error
    int partitions;       ///< partitions of mode 1 that are ranked
    int tries;            ///< best ranked partitions that are fitted
    int rounds_of_others; ///< number of refinements for modes 1, 4 and 5
    int rotations[2];     ///< rotations of modes 4 and 5, for blocks with alpha
    int opaque_rotations[2];
};

static const struct effort efforts[] = {
    [SLUICE_BAKE_QUALITY_NORMAL] = {2, 48.0f, 64, 1, 1, {1, 1}, {0, 0}},
    [SLUICE_BAKE_QUALITY_FAST] = {1, 192.0f, 16, 1, 1, {1, 1}, {0, 0}},
    [SLUICE_BAKE_QUALITY_BEST] = {4, 0.0f, 64, 8, 3, {4, 4}, {4, 4}},
};

static void load_lanes(const uint8_t (*rgba)[64], const uint8_t *which, size_t count,
                       struct slc_bc7_texels *texels)
{
    texels->is_opaque = (slc_ints){0} - 1;
    texels->has_black = (slc_ints){0};
    for (size_t l = 0; l < SLC_LANES; l++) {
        const uint8_t *block = rgba[which[l < count ? l : count - 1]];
        for (int i = 0; i < 16; i++) {
            for (int c = 0; c < 4; c++)
                texels->channels[c][i][l] = (float)block[4 * i + c];
            if (block[4 * i + 3] != 255)
                texels->is_opaque[l] = 0;
            else if ((block[4 * i] | block[4 * i + 1] | block[4 * i + 2]) == 0)
                texels->has_black[l] = -1;
        }
    }
}

/* Tries modes 4 and 5 in the lanes of `which`. */
static void try_rotations(const struct slc_bc7_texels *texels, int rounds, const int rotations[2],
                          slc_ints which, struct slc_bc7_block *blocks[SLC_LANES])
{
    struct slc_bc7_block unused = {.error = 0.0f}, *lanes[SLC_LANES];
    bool any = false;
    for (int l = 0; l < SLC_LANES; l++) {
        lanes[l] = which[l] ? blocks[l] : &unused;
        any |= which[l] != 0;
    }
    for (int r = 0; r < rotations[0] && any; r++)
        slc_bc7_try_mode_4(texels, rounds, r, lanes);
    for (int r = 0; r < rotations[1] && any; r++)
        slc_bc7_try_mode_5(texels, rounds, r, lanes);
}

static void try_others(const struct effort *effort, const struct slc_bc7_texels *texels,
                       struct slc_bc7_block *blocks[SLC_LANES])
{
    bool any_opaque = false;
    for (int l = 0; l < SLC_LANES; l++)
        any_opaque |= texels->is_opaque[l] != 0;
    if (any_opaque)
        slc_bc7_try_mode_1(texels, effort->rounds_of_others, effort->partitions, effort->tries,
                           blocks);
    /* Mode 6 cannot store opaque black: alpha 255 sets the p bits of all channels. */
    static const int for_black[2] = {0, 1};
    int rounds = effort->rounds_of_others;
    try_rotations(texels, rounds, for_black, texels->is_opaque & texels->has_black, blocks);
    try_rotations(texels, rounds, effort->opaque_rotations, texels->is_opaque, blocks);
    try_rotations(texels, rounds, effort->rotations, ~texels->is_opaque, blocks);
}

/* Swaps the ends of a region if the highest bit of its anchor index is set: blocks do not store
 * that bit. */
static void turn_region(struct slc_bc7_block *block, int set, uint16_t region, int anchor,
                        int last_index, uint8_t *ends[2], int first, int count)
{
    if (block->indices[set][anchor] <= last_index / 2)
        return;
    for (int c = first; c < first + count; c++) {
        uint8_t end = ends[0][c];
        ends[0][c] = ends[1][c];
        ends[1][c] = end;
    }
    for (int i = 0; i < 16; i++)
        if (region >> i & 1)
            block->indices[set][i] = (uint8_t)(last_index - block->indices[set][i]);
}

static void put_indices(struct slc_block_bits *bits, const uint8_t indices[16], uint32_t count,
                        int anchor)
{
    for (int i = 0; i < 16; i++)
        slc_put_bits(bits, indices[i], count - (i == 0 || i == anchor));
}

static void pack_mode_6(struct slc_bc7_block *block, struct slc_block_bits *bits)
{
    uint8_t *ends[2] = {block->ends[0][0], block->ends[0][1]};
    turn_region(block, 0, 0xffff, 0, 15, ends, 0, 4);
    slc_put_bits(bits, 1u << 6, 7);
    for (int c = 0; c < 4; c++)
        for (int e = 0; e < 2; e++)
            slc_put_bits(bits, ends[e][c] >> 1, 7);
    for (int e = 0; e < 2; e++)
        slc_put_bits(bits, ends[e][0] & 1, 1);
    put_indices(bits, block->indices[0], 4, 0);
}

static void pack_mode_1(struct slc_bc7_block *block, struct slc_block_bits *bits)
{
    uint16_t partition = slc_partitions[block->partition];
    int anchor = slc_partition_anchors[block->partition];
    uint8_t *ends[4] = {block->ends[0][0], block->ends[0][1], block->ends[1][0], block->ends[1][1]};
    turn_region(block, 0, (uint16_t)~partition, 0, 7, ends, 0, 3);
    turn_region(block, 0, partition, anchor, 7, ends + 2, 0, 3);
    slc_put_bits(bits, 1u << 1, 2);
    slc_put_bits(bits, block->partition, 6);
    for (int c = 0; c < 3; c++)
        for (int e = 0; e < 4; e++)
            slc_put_bits(bits, ends[e][c] >> 1, 6);
    for (int e = 0; e < 4; e += 2)
        slc_put_bits(bits, ends[e][0] & 1, 1);
    put_indices(bits, block->indices[0], 3, anchor);
}

/* Modes 4 and 5: the first set of indices in the file is the shorter one. */
static void pack_two_sets(struct slc_bc7_block *block, struct slc_block_bits *bits)
{
    bool is_mode_4 = block->mode == 4;
    uint32_t color_bits = is_mode_4 ? 5 : 7, alpha_bits = is_mode_4 ? 6 : 8;
    uint32_t index_bits[2] = {2 + (is_mode_4 && block->swaps_indices),
                              2 + (is_mode_4 && !block->swaps_indices)};
    uint8_t *ends[2] = {block->ends[0][0], block->ends[0][1]};
    turn_region(block, 0, 0xffff, 0, (1 << index_bits[0]) - 1, ends, 0, 3);
    turn_region(block, 1, 0xffff, 0, (1 << index_bits[1]) - 1, ends, 3, 1);
    slc_put_bits(bits, 1u << block->mode, block->mode + 1u);
    slc_put_bits(bits, block->rotation, 2);
    if (is_mode_4)
        slc_put_bits(bits, block->swaps_indices, 1);
    for (int c = 0; c < 4; c++)
        for (int e = 0; e < 2; e++)
            slc_put_bits(bits, ends[e][c], c < 3 ? color_bits : alpha_bits);
    int first = block->swaps_indices;
    put_indices(bits, block->indices[first], index_bits[first], 0);
    put_indices(bits, block->indices[!first], index_bits[!first], 0);
}

static void pack(struct slc_bc7_block *block, uint8_t out[16])
{
    struct slc_block_bits bits = {0};
    switch (block->mode) {
    case 1: pack_mode_1(block, &bits); break;
    case 6: pack_mode_6(block, &bits); break;
    default: pack_two_sets(block, &bits); break;
    }
    assert(bits.count == 128);
    slc_store_bits(&bits, out);
}

/* Encodes a block of one color exactly. In mode 5, every value of R, G and B is a third of the way
 * between two ends of 7 bits. */
static void make_plain(const uint8_t color[4], struct slc_bc7_block *block)
{
    *block = (struct slc_bc7_block){.mode = 5};
    for (int c = 0; c < 3; c++) {
        block->ends[0][0][c] = color[c] >> 1;
        block->ends[0][1][c] = (uint8_t)((color[c] < 128 ? color[c] + 1 : color[c] - 1) >> 1);
    }
    block->ends[0][0][3] = block->ends[0][1][3] = color[3];
    memset(block->indices[0], 1, 16);
}

static bool find_plain(const uint8_t rgba[64], struct slc_bc7_block *block)
{
    for (int i = 1; i < 16; i++)
        if (memcmp(rgba, rgba + 4 * i, 4) != 0)
            return false;
    make_plain(rgba, block);
    return true;
}

/* Texels that differ by a step or two may be nearer to their mean, which is exact, than to the ends
 * of other modes. */
#define MOST_ERROR_OF_ENDS 64.0f

static void try_mean(const uint8_t rgba[64], struct slc_bc7_block *block)
{
    uint8_t mean[4];
    int error = 0;
    if (block->error == 0.0f || block->error > MOST_ERROR_OF_ENDS)
        return;
    for (int c = 0; c < 4; c++) {
        int sum = 8, squares = 0;
        for (int i = c; i < 64; i += 4)
            sum += rgba[i];
        mean[c] = (uint8_t)(sum / 16);
        for (int i = c; i < 64; i += 4)
            squares += (rgba[i] - mean[c]) * (rgba[i] - mean[c]);
        error += squares;
    }
    if ((float)error < block->error)
        make_plain(mean, block);
}

/* True if modes other than 6 should be tried. The p bits of mode 6 cannot store opaque black, nor
 * alpha 0 or 255 beside other alphas, exactly. */
static bool is_poor(const struct effort *effort, const uint8_t rgba[64], float error)
{
    bool is_opaque = true, has_extreme = false, has_black = false;
    if (error == 0.0f || error > effort->enough)
        return error > 0.0f;
    for (int i = 0; i < 64; i += 4) {
        is_opaque &= rgba[i + 3] == 255;
        has_extreme |= rgba[i + 3] == 0 || rgba[i + 3] == 255;
        has_black |= (rgba[i] | rgba[i + 1] | rgba[i + 2]) == 0;
    }
    return is_opaque ? has_black : has_extreme;
}

static void encode_batch(const struct effort *effort, const uint8_t (*rgba)[64], size_t count,
                         uint8_t *out)
{
    struct slc_bc7_block blocks[BATCH], *lanes[SLC_LANES], unused;
    struct slc_bc7_texels texels;
    uint8_t which[BATCH];
    size_t left = 0, poor = 0;
    for (size_t b = 0; b < count; b++)
        if (!find_plain(rgba[b], &blocks[b])) {
            blocks[b].error = FLT_MAX;
            which[left++] = (uint8_t)b;
        }
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < left; i += SLC_LANES) {
            for (size_t l = 0; l < SLC_LANES; l++)
                lanes[l] = i + l < left ? &blocks[which[i + l]] : &unused;
            unused.error = 0.0f;
            load_lanes(rgba, which + i, left - i, &texels);
            if (pass == 0)
                slc_bc7_try_mode_6(&texels, effort->rounds, lanes);
            else
                try_others(effort, &texels, lanes);
        }
        for (size_t i = 0; i < left && pass == 0; i++)
            if (is_poor(effort, rgba[which[i]], blocks[which[i]].error))
                which[poor++] = which[i];
        left = poor;
    }
    for (size_t b = 0; b < count; b++) {
        try_mean(rgba[b], &blocks[b]);
        pack(&blocks[b], out + 16 * b);
    }
}

void slc_encode_bc7(SluiceBakeQuality quality, const uint8_t (*rgba)[64], size_t count,
                    uint8_t *blocks)
{
    for (size_t b = 0; b < count; b += BATCH)
        encode_batch(&efforts[quality], rgba + b, count - b < BATCH ? count - b : BATCH,
                     blocks + 16 * b);
}
