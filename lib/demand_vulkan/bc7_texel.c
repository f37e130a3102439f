/*
 * The first texel of a BC7 block. It is in the first subset of every partition and its index is
 * that subset's anchor, so neither the table of partitions nor any other index is needed.
 * Source: Khronos Data Format Specification, "BPTC Unorm".
 */
#include "demand_vulkan/opening.h"

/* Bits of each part of a block, in the order of the specification's table. */
struct mode {
    uint8_t subsets, partition, rotation, selection, color, alpha, endpoint_p, shared_p, index[2];
};

static const struct mode modes[8] = {
    {3, 4, 0, 0, 4, 0, 1, 0, {3, 0}}, {2, 6, 0, 0, 6, 0, 0, 1, {3, 0}},
    {3, 6, 0, 0, 5, 0, 0, 0, {2, 0}}, {2, 6, 0, 0, 7, 0, 1, 0, {2, 0}},
    {1, 0, 2, 1, 5, 6, 0, 0, {2, 3}}, {1, 0, 2, 0, 7, 8, 0, 0, {2, 2}},
    {1, 0, 0, 0, 7, 7, 1, 0, {4, 0}}, {2, 6, 0, 0, 5, 5, 1, 0, {2, 0}}};

struct bits {
    const uint8_t *bytes;
    uint32_t at;
};

static uint32_t take(struct bits *bits, uint32_t count)
{
    uint32_t value = 0;
    for (uint32_t i = 0; i < count; i++, bits->at++)
        value |= (uint32_t)(bits->bytes[bits->at / 8] >> bits->at % 8 & 1) << i;
    return value;
}

/* Reads both endpoints of the first subset, widened to 8 bits. */
static void read_endpoints(struct bits *bits, const struct mode *mode, uint32_t ends[2][4])
{
    uint32_t p[2] = {0, 0}, has_p = mode->endpoint_p || mode->shared_p;
    for (uint32_t c = 0; c < 4; c++) {
        uint32_t count = c < 3 ? mode->color : mode->alpha;
        for (uint32_t e = 0; e < 2; e++)
            ends[e][c] = take(bits, count);
        bits->at += (2u * mode->subsets - 2) * count;
    }
    for (uint32_t e = 0; e < 2 && mode->endpoint_p; e++)
        p[e] = take(bits, 1);
    if (mode->endpoint_p)
        bits->at += 2u * mode->subsets - 2;
    if (mode->shared_p) {
        p[0] = p[1] = take(bits, 1);
        bits->at += mode->subsets - 1u;
    }
    for (uint32_t e = 0; e < 2; e++)
        for (uint32_t c = 0; c < 4; c++) {
            uint32_t count = (c < 3 ? mode->color : mode->alpha) + has_p;
            uint32_t value = (has_p ? ends[e][c] << 1 | p[e] : ends[e][c]) << (8 - count);
            ends[e][c] = c == 3 && !mode->alpha ? 255 : value | value >> count;
        }
}

/* Returns the weight of an index, in 64ths. */
static uint32_t weight(uint32_t bit_count, uint32_t index)
{
    static const uint8_t two[] = {0, 21, 43, 64}, three[] = {0, 9, 18, 27, 37, 46, 55, 64};
    static const uint8_t four[] = {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
    return bit_count == 2 ? two[index] : bit_count == 3 ? three[index] : four[index];
}

void slc_bc7_texel(const uint8_t block[16], float rgba[4])
{
    struct bits bits = {block, 0};
    uint32_t number = 0, ends[2][4], weights[2];
    while (number < 8 && take(&bits, 1) == 0)
        number++;
    for (uint32_t c = 0; c < 4; c++)
        rgba[c] = 0;
    if (number == 8)
        return; /* reserved: transparent black */
    const struct mode *mode = &modes[number];
    bits.at += mode->partition;
    uint32_t rotation = take(&bits, mode->rotation), selection = take(&bits, mode->selection);
    read_endpoints(&bits, mode, ends);
    weights[0] = weight(mode->index[0], take(&bits, mode->index[0] - 1u));
    bits.at += 15u * mode->index[0] - (mode->subsets - 1u);
    weights[1] =
        mode->index[1] ? weight(mode->index[1], take(&bits, mode->index[1] - 1u)) : weights[0];
    for (uint32_t c = 0; c < 4; c++) {
        uint32_t w = weights[(c == 3) != (selection == 1)];
        uint32_t to = rotation && c == 3 ? rotation - 1 : rotation && c == rotation - 1 ? 3 : c;
        rgba[to] = (float)(((64 - w) * ends[0][c] + w * ends[1][c] + 32) >> 6) / 255;
    }
}
