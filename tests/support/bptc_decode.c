#include "support/bptc_decode.h"

#include "bake/bc6h_modes.h"
#include "bake/block_partitions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct reader {
    const uint8_t *bytes;
    int at;
};

/* Takes bits one at a time, in the order of the specification. */
static int take(struct reader *reader, int count)
{
    int value = 0;
    for (int i = 0; i < count; i++, reader->at++)
        value |= (reader->bytes[reader->at / 8] >> (reader->at % 8) & 1) << i;
    return value;
}

static const int weights2[] = {0, 21, 43, 64};
static const int weights3[] = {0, 9, 18, 27, 37, 46, 55, 64};
static const int weights4[] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};

static int interpolate(int a, int b, int index, int bits)
{
    const int *weights = bits == 2 ? weights2 : bits == 3 ? weights3 : weights4;
    return ((64 - weights[index]) * a + weights[index] * b + 32) >> 6;
}

static int expand(int code, int bits)
{
    code <<= 8 - bits;
    return code | code >> bits;
}

struct bc7_mode {
    int regions, partition_bits, rotation_bits, selector_bits, color_bits, alpha_bits;
    int own_p, shared_p, index_bits, second_index_bits;
};

static const struct bc7_mode bc7_modes[8] = {
    [1] = {2, 6, 0, 0, 6, 0, 0, 1, 3, 0},
    [4] = {1, 0, 2, 1, 5, 6, 0, 0, 2, 3},
    [5] = {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    [6] = {1, 0, 0, 0, 7, 7, 1, 0, 4, 0},
};

static void take_indices(struct reader *reader, int bits, int partition, int regions,
                         int indices[16])
{
    for (int i = 0; i < 16; i++) {
        bool is_anchor = i == 0 || (regions == 2 && i == slc_partition_anchors[partition]);
        indices[i] = take(reader, bits - is_anchor);
    }
}

bool bc7_decode(const uint8_t block[16], uint8_t rgba[64], int *mode)
{
    struct reader reader = {block, 0};
    int ends[4][4], first[16], second[16];
    for (*mode = 0; *mode < 8 && take(&reader, 1) == 0;)
        ++*mode;
    if (*mode == 8 || bc7_modes[*mode].regions == 0)
        return false;
    const struct bc7_mode *m = &bc7_modes[*mode];
    int partition = take(&reader, m->partition_bits), rotation = take(&reader, m->rotation_bits);
    int selector = take(&reader, m->selector_bits), end_count = 2 * m->regions;
    for (int c = 0; c < 4; c++)
        for (int e = 0; e < end_count; e++)
            ends[e][c] = take(&reader, c < 3 ? m->color_bits : m->alpha_bits);
    int has_p = m->own_p || m->shared_p, p = 0;
    for (int e = 0; e < end_count && has_p; e++) {
        p = m->own_p || e % 2 == 0 ? take(&reader, 1) : p;
        for (int c = 0; c < 4; c++)
            ends[e][c] = ends[e][c] << 1 | p;
    }
    for (int e = 0; e < end_count; e++)
        for (int c = 0; c < 4; c++) {
            int bits = (c < 3 ? m->color_bits : m->alpha_bits) + has_p;
            ends[e][c] = c == 3 && m->alpha_bits == 0 ? 255 : expand(ends[e][c], bits);
        }
    take_indices(&reader, m->index_bits, partition, m->regions, first);
    if (m->second_index_bits)
        take_indices(&reader, m->second_index_bits, partition, m->regions, second);
    for (int i = 0; i < 16; i++) {
        int region = m->regions == 2 ? slc_partitions[partition] >> i & 1 : 0;
        const int(*pair)[4] = (const int(*)[4])ends + 2 * region;
        for (int c = 0; c < 4; c++) {
            bool use_second = m->second_index_bits && (c < 3) == (selector == 1);
            int index = use_second ? second[i] : first[i];
            int bits = use_second ? m->second_index_bits : m->index_bits;
            rgba[4 * i + c] = (uint8_t)interpolate(pair[0][c], pair[1][c], index, bits);
        }
        if (rotation) {
            uint8_t alpha = rgba[4 * i + 3];
            rgba[4 * i + 3] = rgba[4 * i + rotation - 1];
            rgba[4 * i + rotation - 1] = alpha;
        }
    }
    return reader.at == 128;
}

static int sign_extend(int value, int bits)
{
    return value >> (bits - 1) & 1 ? value - (1 << bits) : value;
}

/* "rw0-9" and "rw15-10", as bc6h_modes.h writes them. */
static void take_ends(struct reader *reader, const struct slc_bc6h_mode *mode, int ends[4][3])
{
    for (const char *at = mode->layout; at;) {
        int first, last, used;
        char channel, end;
        int found = sscanf(at, "%c%c%d%n", &channel, &end, &first, &used);
        last = first;
        if (found == 3 && at[used] == '-')
            last = atoi(at + used + 1);
        int *value = &ends[end - 'w'][channel == 'r' ? 0 : channel == 'g' ? 1 : 2];
        for (int i = 0; i <= abs(last - first); i++)
            *value |= take(reader, 1) << (last < first ? first - i : first + i);
        at = strchr(at, ' ');
        at = at ? at + 1 : NULL;
    }
}

static int bc6h_unquantize(int code, int bits, bool is_signed)
{
    if (!is_signed)
        return bits >= 15                ? code
               : code == 0               ? 0
               : code == (1 << bits) - 1 ? 0xffff
                                         : ((code << 16) + 0x8000) >> bits;
    int sign = code < 0 ? -1 : 1;
    code *= sign;
    if (bits >= 16 || code == 0)
        return sign * code;
    return sign * (code >= (1 << (bits - 1)) - 1 ? 0x7fff : ((code << 15) + 0x4000) >> (bits - 1));
}

/* The format's arithmetic on two numbers of 16 bits, to a half. */
static uint16_t bc6h_mix(int a, int b, int index, int bits, bool is_signed)
{
    int value = interpolate(a, b, index, bits);
    if (!is_signed)
        return (uint16_t)(value * 31 >> 6);
    return (uint16_t)(value < 0 ? 0x8000 | (-value * 31 >> 5) : value * 31 >> 5);
}

bool bc6h_decode(bool is_signed, const uint8_t block[16], uint16_t rgb[48], int *mode)
{
    const struct slc_bc6h_mode *m = NULL;
    int ends[4][3] = {{0}}, indices[16];
    struct reader reader = {block, 0};
    for (int i = 0; i < SLC_BC6H_MODE_COUNT; i++)
        if ((block[0] & ((1 << slc_bc6h_modes[i].value_bits) - 1)) == slc_bc6h_modes[i].value)
            m = &slc_bc6h_modes[i];
    if (!m)
        return false;
    *mode = m->number;
    take(&reader, m->value_bits);
    take_ends(&reader, m, ends);
    int partition = m->regions == 2 ? take(&reader, 5) : 0;
    for (int e = 0; e < 2 * m->regions; e++)
        for (int c = 0; c < 3; c++) {
            bool is_delta = e > 0 && m->deltas[c];
            int bits = is_delta ? m->deltas[c] : m->bits;
            if (is_delta)
                ends[e][c] = (ends[0][c] + sign_extend(ends[e][c], bits)) & ((1 << m->bits) - 1);
        }
    for (int e = 0; e < 2 * m->regions; e++)
        for (int c = 0; c < 3; c++) {
            int code = is_signed ? sign_extend(ends[e][c], m->bits) : ends[e][c];
            ends[e][c] = bc6h_unquantize(code, m->bits, is_signed);
        }
    int index_bits = m->regions == 2 ? 3 : 4;
    take_indices(&reader, index_bits, partition, m->regions, indices);
    for (int i = 0; i < 16; i++) {
        int region = m->regions == 2 ? slc_partitions[partition] >> i & 1 : 0;
        for (int c = 0; c < 3; c++)
            rgb[3 * i + c] = bc6h_mix(ends[2 * region][c], ends[2 * region + 1][c], indices[i],
                                      index_bits, is_signed);
    }
    return reader.at == 128;
}
