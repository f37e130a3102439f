#include "bake/bc6h_encode.h"

#include "bake/bc6h_modes.h"
#include "bake/block_bits.h"
#include "bake/block_fit.h"
#include "bake/block_partitions.h"
#include "bake/block_regions.h"

#include <assert.h>
#include <string.h>

#define PARTITIONS 32
#define LARGEST 0x7bff /* 65504 as a half */

/* Work per quality. tests/bake/encoder_figures measures time and PSNR. */
struct effort {
    int rounds;     ///< number of refinements of the ends
    int tries;      ///< partitions whose two regions are fitted
    int64_t enough; ///< two regions are tried if one region has a larger error
    bool all_modes; ///< false: only the most precise mode that holds the ends
};

static const struct effort efforts[] = {
    [SLUICE_BAKE_QUALITY_NORMAL] = {1, 1, 16 * 3 * 16, false},
    [SLUICE_BAKE_QUALITY_FAST] = {1, 1, 16 * 3 * 2500, false},
    [SLUICE_BAKE_QUALITY_BEST] = {3, 4, 0, true},
};

/* Texels as whole numbers: steps between a half and 0. */
struct texels {
    bool is_signed;
    int32_t steps[16][3];
};

/* One way to encode a block. */
struct candidate {
    const struct slc_bc6h_mode *mode;
    int64_t error; ///< sum of squared steps; -1: none
    int partition;
    int32_t codes[4][3]; ///< codes of the ends w, x, y and z
    uint8_t indices[16];
};

static int32_t steps_of(uint16_t half, bool is_signed)
{
    int32_t magnitude = half & 0x7fff;
    if (magnitude > 0x7c00)
        return 0;
    if (magnitude > LARGEST)
        magnitude = LARGEST;
    return half & 0x8000 ? is_signed ? -magnitude : 0 : magnitude;
}

static int32_t min_i32(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* Converts a code to 16 bits, as the specification does. */
static int32_t unquantize(int32_t code, int bits, bool is_signed)
{
    if (!is_signed)
        return bits >= 15                ? code
               : code == 0               ? 0
               : code == (1 << bits) - 1 ? 0xffff
                                         : ((code << 16) + 0x8000) >> bits;
    int32_t magnitude = code < 0 ? -code : code, value = magnitude;
    if (bits < 16 && magnitude != 0)
        value = magnitude >= (1 << (bits - 1)) - 1 ? 0x7fff
                                                   : ((magnitude << 15) + 0x4000) >> (bits - 1);
    return code < 0 ? -value : value;
}

/* Converts an interpolated 16-bit number to steps. */
static int32_t finish(int32_t value, bool is_signed)
{
    if (!is_signed)
        return (value * 31) >> 6;
    return value < 0 ? -((-value * 31) >> 5) : (value * 31) >> 5;
}

/* Returns the code with the nearest number, or a code next to it. */
static int32_t quantize(float steps, int bits, bool is_signed)
{
    float magnitude = steps < 0.0f ? -steps : steps;
    magnitude = magnitude > (float)LARGEST ? (float)LARGEST : magnitude;
    int32_t whole = (int32_t)(magnitude + 0.5f);
    if (!is_signed)
        return steps < 0.0f ? 0 : min_i32((whole * 64 + 30) / 31, 0xffff) >> (16 - bits);
    int32_t code = min_i32((whole * 32 + 30) / 31, 0x7fff) >> (16 - bits);
    return steps < 0.0f ? -code : code;
}

static int region_of(const struct slc_bc6h_mode *mode, int partition, int texel)
{
    return mode->regions == 2 ? slc_partitions[partition] >> texel & 1 : 0;
}

/* Writes the colors between two ends, in steps. */
static void make_palette(const struct texels *texels, int bits, int count,
                         const int32_t codes[2][3], int32_t palette[16][3])
{
    for (int c = 0; c < 3; c++) {
        int32_t a = unquantize(codes[0][c], bits, texels->is_signed);
        int32_t b = unquantize(codes[1][c], bits, texels->is_signed);
        for (int i = 0; i < count; i++) {
            int32_t weight = (i * 64 + (count - 1) / 2) / (count - 1);
            palette[i][c] = finish((a * (64 - weight) + b * weight + 32) >> 6, texels->is_signed);
        }
    }
}

static int64_t distance(const int32_t a[3], const int32_t b[3])
{
    int64_t sum = 0;
    for (int c = 0; c < 3; c++)
        sum += (int64_t)(a[c] - b[c]) * (a[c] - b[c]);
    return sum;
}

/* Returns the nearest of three colors: the one by projection and its two neighbors. */
static int find_index(const int32_t texel[3], const int32_t palette[16][3], int count,
                      int64_t *error)
{
    int64_t along = 0, length = 0;
    for (int c = 0; c < 3; c++) {
        int64_t step = palette[count - 1][c] - palette[0][c];
        along += step * (texel[c] - palette[0][c]);
        length += step * step;
    }
    int guess = along <= 0 ? 0 : along >= length ? count - 1 : (int)(along * (count - 1) / length);
    int first = guess > 0 ? guess - 1 : 0, last = guess + 2 < count ? guess + 2 : count - 1;
    int best = first;
    int64_t least = distance(texel, palette[first]);
    for (int i = first + 1; i <= last; i++) {
        int64_t own = distance(texel, palette[i]);
        if (own < least) {
            least = own;
            best = i;
        }
    }
    *error += least;
    return best;
}

/* Swaps the ends of a region if the highest bit of its anchor index is set: blocks do not store
 * that bit. */
static void turn(struct candidate *candidate, int region, int anchor, int count)
{
    if (candidate->indices[anchor] < count / 2)
        return;
    for (int c = 0; c < 3; c++) {
        int32_t code = candidate->codes[2 * region][c];
        candidate->codes[2 * region][c] = candidate->codes[2 * region + 1][c];
        candidate->codes[2 * region + 1][c] = code;
    }
    for (int i = 0; i < 16; i++)
        if (region_of(candidate->mode, candidate->partition, i) == region)
            candidate->indices[i] = (uint8_t)(count - 1 - candidate->indices[i]);
}

static bool deltas_fit(const struct candidate *candidate)
{
    const struct slc_bc6h_mode *mode = candidate->mode;
    for (int e = 1; e < 2 * mode->regions && mode->deltas[0]; e++)
        for (int c = 0; c < 3; c++) {
            int32_t delta = candidate->codes[e][c] - candidate->codes[0][c];
            int32_t limit = 1 << (mode->deltas[c] - 1);
            if (delta < -limit || delta >= limit)
                return false;
        }
    return true;
}

/* Makes codes and indices. Returns false if the mode cannot hold the ends. */
static bool make_candidate(const struct texels *texels, const float ends[4][3],
                           struct candidate *candidate)
{
    const struct slc_bc6h_mode *mode = candidate->mode;
    int count = mode->regions == 2 ? 8 : 16;
    int32_t palettes[2][16][3];
    for (int e = 0; e < 2 * mode->regions; e++)
        for (int c = 0; c < 3; c++)
            candidate->codes[e][c] = quantize(ends[e][c], mode->bits, texels->is_signed);
    struct candidate widest = *candidate; /* with the ends swapped, the base of the differences */
    bool may_fit = deltas_fit(candidate);
    for (int c = 0; c < 3; c++) {
        int32_t code = widest.codes[0][c];
        widest.codes[0][c] = widest.codes[1][c];
        widest.codes[1][c] = code;
    }
    if (!may_fit && !deltas_fit(&widest))
        return false;
    for (int r = 0; r < mode->regions; r++)
        make_palette(texels, mode->bits, count, (const int32_t(*)[3])candidate->codes + 2 * r,
                     palettes[r]);
    candidate->error = 0;
    for (int i = 0; i < 16; i++) {
        int region = region_of(mode, candidate->partition, i);
        candidate->indices[i] = (uint8_t)find_index(
            texels->steps[i], (const int32_t(*)[3])palettes[region], count, &candidate->error);
    }
    turn(candidate, 0, 0, count);
    if (mode->regions == 2)
        turn(candidate, 1, slc_partition_anchors[candidate->partition], count);
    return deltas_fit(candidate);
}

/* Finds the ends with the least squared error for the indices of a region. */
static void solve(const struct texels *texels, const struct candidate *candidate, int region,
                  float ends[2][3])
{
    int count = candidate->mode->regions == 2 ? 8 : 16;
    int64_t aa = 0, ab = 0, bb = 0, a_sum[3] = {0}, b_sum[3] = {0};
    for (int i = 0; i < 16; i++) {
        if (region_of(candidate->mode, candidate->partition, i) != region)
            continue;
        int64_t b = (candidate->indices[i] * 64 + (count - 1) / 2) / (count - 1), a = 64 - b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
        for (int c = 0; c < 3; c++) {
            a_sum[c] += a * texels->steps[i][c];
            b_sum[c] += b * texels->steps[i][c];
        }
    }
    int64_t det = aa * bb - ab * ab;
    for (int c = 0; c < 3 && det > 0; c++) {
        ends[0][c] = (float)((double)(a_sum[c] * bb - b_sum[c] * ab) * 64.0 / (double)det);
        ends[1][c] = (float)((double)(b_sum[c] * aa - a_sum[c] * ab) * 64.0 / (double)det);
    }
}

static void try_ends(const struct effort *effort, const struct texels *texels, int regions,
                     int partition, float ends[4][3], struct candidate *best)
{
    for (int round = 0; round <= effort->rounds; round++) {
        struct candidate nearest = {.error = -1};
        for (int m = 0; m < SLC_BC6H_MODE_COUNT; m++) {
            struct candidate candidate = {.mode = &slc_bc6h_modes[m], .partition = partition};
            if (candidate.mode->regions != regions ||
                !make_candidate(texels, (const float(*)[3])ends, &candidate))
                continue;
            if (nearest.error < 0 || candidate.error < nearest.error)
                nearest = candidate;
            if (!effort->all_modes)
                break;
        }
        assert(nearest.error >= 0); /* modes 10 and 11 hold everything */
        if (best->error < 0 || nearest.error < best->error)
            *best = nearest;
        for (int r = 0; r < regions; r++)
            solve(texels, &nearest, r, ends + 2 * r);
    }
}

/* Colors that differ by little more than mode 14 can hold are nearer to their mean in that mode
 * than to the coarse steps of the other modes. */
static void try_mean(const struct texels *texels, struct candidate *best)
{
    struct candidate candidate = {.mode = &slc_bc6h_modes[0]};
    float ends[4][3] = {{0}};
    for (int c = 0; c < 3; c++) {
        int32_t sum = 0;
        for (int i = 0; i < 16; i++)
            sum += texels->steps[i][c];
        ends[0][c] = ends[1][c] = (float)sum / 16.0f;
    }
    if (make_candidate(texels, (const float(*)[3])ends, &candidate) &&
        candidate.error < best->error)
        *best = candidate;
}

/* SLC_LANES blocks. Each block's first texel is subtracted from its channels, so that sums stay
 * precise. */
struct lanes {
    slc_floats channels[3][16];
    struct texels texels[SLC_LANES];
};

/* Finds the ends of one or two regions of each block. Bit i of `mask`: texel i is in region 1. */
static void find_ends(const struct lanes *lanes, int regions, slc_ints mask,
                      float ends[SLC_LANES][4][3])
{
    slc_floats weights[16], line[2][4];
    const slc_floats(*c)[16] = lanes->channels;
    const struct slc_fit_points points = {3, {c[0], c[1], c[2]}, weights};
    for (int r = 0; r < regions; r++) {
        for (int i = 0; i < 16; i++)
            weights[i] = slc_to_floats(r ? mask >> i & 1 : ~(mask >> i) & 1);
        slc_fit_line(&points, line);
        for (int l = 0; l < SLC_LANES; l++)
            for (int e = 0; e < 2; e++)
                for (int k = 0; k < 3; k++)
                    ends[l][2 * r + e][k] = line[e][k][l] + (float)lanes->texels[l].steps[0][k];
    }
}

static void encode_lanes(const struct effort *effort, const struct lanes *lanes, int count,
                         struct candidate best[SLC_LANES])
{
    float ends[SLC_LANES][4][3];
    slc_floats estimates[PARTITIONS];
    bool any = false;
    find_ends(lanes, 1, (slc_ints){0}, ends);
    for (int l = 0; l < count; l++) {
        best[l].error = -1;
        try_ends(effort, &lanes->texels[l], 1, 0, ends[l], &best[l]);
        if (best[l].error > 0)
            try_mean(&lanes->texels[l], &best[l]);
        any |= best[l].error > effort->enough;
    }
    if (!any)
        return;
    slc_estimate_regions(lanes->channels, PARTITIONS, estimates);
    for (int t = 0; t < effort->tries; t++) {
        slc_ints partition = slc_take_regions(estimates, PARTITIONS), mask = {0};
        for (int l = 0; l < SLC_LANES; l++)
            mask[l] = slc_partitions[partition[l]];
        find_ends(lanes, 2, mask, ends);
        for (int l = 0; l < count; l++)
            if (best[l].error > effort->enough)
                try_ends(effort, &lanes->texels[l], 2, partition[l], ends[l], &best[l]);
    }
}

/* "rw0-9": the red of end w, from the first bit to the last. */
static const char *put_field(struct slc_block_bits *bits, const char *field,
                             const uint32_t fields[4][3])
{
    int channel = field[0] == 'r' ? 0 : field[0] == 'g' ? 1 : 2, end = field[1] - 'w', range[2];
    field += 2;
    for (int k = 0; k < 2; k++) {
        range[k] = k ? range[0] : 0;
        if (k && *field != '-')
            break;
        field += k;
        for (range[k] = 0; *field >= '0' && *field <= '9'; field++)
            range[k] = 10 * range[k] + (*field - '0');
    }
    int step = range[1] < range[0] ? -1 : 1;
    for (int b = range[0]; b != range[1] + step; b += step)
        slc_put_bits(bits, fields[end][channel] >> b & 1, 1);
    return *field == ' ' ? field + 1 : field;
}

static void pack(const struct candidate *candidate, uint8_t block[16])
{
    const struct slc_bc6h_mode *mode = candidate->mode;
    struct slc_block_bits bits = {0};
    uint32_t fields[4][3] = {{0}};
    for (int e = 0; e < 2 * mode->regions; e++)
        for (int c = 0; c < 3; c++) {
            int32_t base = e > 0 && mode->deltas[c] ? candidate->codes[0][c] : 0;
            fields[e][c] = (uint32_t)(candidate->codes[e][c] - base);
        }
    slc_put_bits(&bits, mode->value, mode->value_bits);
    for (const char *field = mode->layout; *field;)
        field = put_field(&bits, field, (const uint32_t(*)[3])fields);
    if (mode->regions == 2)
        slc_put_bits(&bits, (uint32_t)candidate->partition, 5);
    int anchor = mode->regions == 2 ? slc_partition_anchors[candidate->partition] : 0;
    for (int i = 0; i < 16; i++)
        slc_put_bits(&bits, candidate->indices[i],
                     (mode->regions == 2 ? 3 : 4) - (uint32_t)(i == 0 || i == anchor));
    assert(bits.count == 128);
    slc_store_bits(&bits, block);
}

void slc_encode_bc6h(bool is_signed, SluiceBakeQuality quality, const uint16_t (*rgba)[64],
                     size_t count, uint8_t *blocks)
{
    for (size_t b = 0; b < count; b += SLC_LANES) {
        int lane_count = count - b < SLC_LANES ? (int)(count - b) : SLC_LANES;
        struct candidate best[SLC_LANES];
        struct lanes lanes;
        for (int l = 0; l < SLC_LANES; l++) {
            struct texels *texels = &lanes.texels[l];
            const uint16_t *block = rgba[b + (size_t)(l < lane_count ? l : lane_count - 1)];
            texels->is_signed = is_signed;
            for (int i = 0; i < 16; i++)
                for (int c = 0; c < 3; c++) {
                    texels->steps[i][c] = steps_of(block[4 * i + c], is_signed);
                    lanes.channels[c][i][l] = (float)(texels->steps[i][c] - texels->steps[0][c]);
                }
        }
        encode_lanes(&efforts[quality], &lanes, lane_count, best);
        for (int l = 0; l < lane_count; l++)
            pack(&best[l], blocks + 16 * (b + (size_t)l));
    }
}
