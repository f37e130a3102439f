#include "neural/gdeflate.h"

#include "base/little_endian.h"

#include <string.h>

enum { LANES = 32, MAX_BITS = 15, LITERALS = 288, DISTANCES = 32, END_OF_BLOCK = 256 };

/* Canonical Huffman code: counts per length, and symbols in the order of their codes. */
struct code {
    uint16_t counts[MAX_BITS + 1];
    uint16_t symbols[LITERALS];
};

struct inflater {
    const uint8_t *in;
    size_t in_size, in_at;
    uint8_t *out;
    size_t out_size, out_at;
    uint64_t bits[LANES];
    uint32_t bit_count[LANES];
    uint32_t lane;
    uint32_t missing; /* words read beyond the end of the input */
    size_t copy_at[LANES];
    uint32_t copy_size[LANES]; /* 0: no copy waits for its distance in this lane */
    bool is_bad;
    struct code literal, distance;
};

static void refill(struct inflater *s)
{
    uint32_t word = 0;
    if (s->bit_count[s->lane] >= 32)
        return;
    if (s->in_size - s->in_at >= 4) {
        word = slc_get_u32(s->in + s->in_at);
        s->in_at += 4;
    } else if (++s->missing > LANES) {
        s->is_bad = true; /* otherwise zeros would be endless empty blocks */
    }
    s->bits[s->lane] |= (uint64_t)word << s->bit_count[s->lane];
    s->bit_count[s->lane] += 32;
}

static void advance(struct inflater *s)
{
    refill(s);
    s->lane = (s->lane + 1) % LANES;
}

/* Takes bits. At most 31 between two refills: a code of 15 bits and 16 extra bits. */
static uint32_t take(struct inflater *s, uint32_t count)
{
    uint32_t value = (uint32_t)(s->bits[s->lane] & (((uint64_t)1 << count) - 1));
    s->bits[s->lane] >>= count;
    s->bit_count[s->lane] -= count;
    return value;
}

/* Makes a code. False: over-subscribed. In incomplete codes, decode detects missing symbols. */
static bool make_code(struct code *code, const uint8_t *lengths, uint32_t count)
{
    uint16_t offsets[MAX_BITS + 2] = {0};
    int32_t left = 1;
    memset(code->counts, 0, sizeof code->counts);
    for (uint32_t i = 0; i < count; i++)
        code->counts[lengths[i]]++;
    code->counts[0] = 0;
    for (uint32_t b = 1; b <= MAX_BITS; b++) {
        left = 2 * left - code->counts[b];
        if (left < 0)
            return false;
        offsets[b + 1] = (uint16_t)(offsets[b] + code->counts[b]);
    }
    for (uint32_t i = 0; i < count; i++)
        if (lengths[i])
            code->symbols[offsets[lengths[i]]++] = (uint16_t)i;
    return true;
}

static uint32_t decode(struct inflater *s, const struct code *code)
{
    uint32_t first = 0, index = 0, value = 0;
    for (uint32_t b = 1; b <= MAX_BITS; b++) {
        value |= take(s, 1);
        uint32_t count = code->counts[b];
        if (value < first + count)
            return code->symbols[index + (value - first)];
        index += count;
        first = (first + count) << 1;
        value <<= 1;
    }
    s->is_bad = true;
    return END_OF_BLOCK;
}

static void make_fixed_codes(struct inflater *s)
{
    uint8_t lengths[LITERALS];
    memset(lengths, 8, 144);
    memset(lengths + 144, 9, 112);
    memset(lengths + 256, 7, 24);
    memset(lengths + 280, 8, 8);
    make_code(&s->literal, lengths, LITERALS);
    memset(lengths, 5, DISTANCES);
    make_code(&s->distance, lengths, DISTANCES);
}

/* Writes a length, or repeats of a length. Returns the number of lengths. */
static uint32_t read_lengths(struct inflater *s, const struct code *code, uint8_t *lengths,
                             uint32_t at)
{
    uint32_t symbol = decode(s, code);
    uint32_t count = 1;
    uint8_t length = (uint8_t)symbol;
    if (symbol == 16) {
        count = 3 + take(s, 2);
        s->is_bad |= at == 0;
        length = at ? lengths[at - 1] : 0;
    } else if (symbol > 16) {
        count = symbol == 17 ? 3 + take(s, 3) : 11 + take(s, 7);
        length = 0;
    }
    for (uint32_t i = 0; i < count && at + i < LITERALS + DISTANCES; i++)
        lengths[at + i] = length;
    return count;
}

static void read_dynamic_codes(struct inflater *s)
{
    static const uint8_t ORDER[19] = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                      11, 4,  12, 3, 13, 2, 14, 1, 15};
    uint8_t lengths[LITERALS + DISTANCES] = {0}, code_lengths[19] = {0};
    struct code code;
    uint32_t literals = 257 + take(s, 5), distances = 1 + take(s, 5), codes = 4 + take(s, 4);
    refill(s);
    if (literals > LITERALS) {
        s->is_bad = true;
        return;
    }
    for (uint32_t i = 0; i < codes; i++, advance(s))
        code_lengths[ORDER[i]] = (uint8_t)take(s, 3);
    s->lane = 0;
    s->is_bad |= !make_code(&code, code_lengths, 19);
    uint32_t at = 0;
    for (; at < literals + distances && !s->is_bad; advance(s))
        at += read_lengths(s, &code, lengths, at);
    s->lane = 0;
    if (s->is_bad || at != literals + distances || !make_code(&s->literal, lengths, literals) ||
        !make_code(&s->distance, lengths + literals, distances))
        s->is_bad = true;
}

/* Returns the copy length for symbols from 257 on, with extra bits. */
static uint32_t read_length(struct inflater *s, uint32_t symbol)
{
    uint32_t code = symbol - 257;
    if (code == 28)
        return 3 + take(s, 16);
    if (code > 28) {
        s->is_bad = true;
        return 0;
    }
    if (code < 8)
        return 3 + code;
    uint32_t extra = code / 4 - 1;
    return 3 + ((4 + code % 4) << extra) + take(s, extra);
}

static uint32_t read_distance(struct inflater *s)
{
    uint32_t code = decode(s, &s->distance);
    if (code >= DISTANCES) {
        s->is_bad = true;
        return 1;
    }
    if (code < 4)
        return 1 + code;
    uint32_t extra = code / 2 - 1;
    return 1 + ((2 + code % 2) << extra) + take(s, extra);
}

/* Executes the lane's pending copy. */
static void finish_copy(struct inflater *s)
{
    size_t to = s->copy_at[s->lane];
    uint32_t distance = read_distance(s);
    if (s->is_bad || distance > to) {
        s->is_bad = true;
        return;
    }
    for (uint32_t i = 0; i < s->copy_size[s->lane]; i++)
        s->out[to + i] = s->out[to + i - distance];
    s->copy_size[s->lane] = 0;
}

static bool reserve(struct inflater *s, uint32_t size)
{
    if (s->is_bad || size > s->out_size - s->out_at)
        s->is_bad = true;
    else
        s->out_at += size;
    return !s->is_bad;
}

/* Inflates symbols. A copy reads its distance at the next visit of its lane. */
static void inflate_symbols(struct inflater *s)
{
    uint32_t symbol = 0;
    for (; !s->is_bad; advance(s)) {
        if (s->copy_size[s->lane]) {
            finish_copy(s);
            continue;
        }
        symbol = decode(s, &s->literal);
        if (symbol == END_OF_BLOCK)
            break;
        uint32_t size = symbol < 256 ? 1 : read_length(s, symbol);
        if (!reserve(s, size))
            break;
        if (symbol < 256) {
            s->out[s->out_at - 1] = (uint8_t)symbol;
        } else {
            s->copy_at[s->lane] = s->out_at - size;
            s->copy_size[s->lane] = size;
        }
    }
    for (uint32_t i = 0; i < LANES && !s->is_bad; i++, advance(s))
        if (s->copy_size[s->lane])
            finish_copy(s);
}

static void inflate_stored(struct inflater *s)
{
    uint32_t size = take(s, 16);
    if (!reserve(s, size))
        return;
    for (uint8_t *out = s->out + s->out_at - size; size; size--, advance(s))
        *out++ = (uint8_t)take(s, 8);
    for (uint32_t i = 0; i < LANES; i++)
        advance(s);
}

static bool inflate_block(struct inflater *s)
{
    s->lane = 0;
    bool is_last = take(s, 1);
    uint32_t type = take(s, 2);
    refill(s);
    if (type == 0) {
        inflate_stored(s);
    } else if (type == 3) {
        s->is_bad = true;
    } else {
        if (type == 1)
            make_fixed_codes(s);
        else
            read_dynamic_codes(s);
        inflate_symbols(s);
    }
    return !is_last && !s->is_bad;
}

bool slc_gdeflate_inflate(const uint8_t *in, size_t in_size, uint8_t *out, size_t out_size)
{
    struct inflater s = {.in = in, .in_size = in_size, .out = out, .out_size = out_size};
    for (uint32_t i = 0; i < LANES; i++)
        advance(&s);
    while (inflate_block(&s)) {
    }
    return !s.is_bad && s.out_at == out_size;
}

bool slc_gdeflate_read_header(const uint8_t bytes[SLC_GDEFLATE_HEADER],
                              struct slc_gdeflate_header *header)
{
    uint32_t flags = slc_get_u32(bytes + 4), last = flags >> 2 & 0x3FFFF;
    header->tile_count = bytes[2] | (uint32_t)bytes[3] << 8;
    if (bytes[0] != 4 || bytes[1] != 0xFB || (flags & 3) != 1 || header->tile_count == 0 ||
        last > SLC_GDEFLATE_TILE)
        return false;
    header->size =
        (uint64_t)(header->tile_count - 1) * SLC_GDEFLATE_TILE + (last ? last : SLC_GDEFLATE_TILE);
    return true;
}
