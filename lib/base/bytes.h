/** Blocks of sixteen bytes. Arrays that are processed in blocks are padded to whole blocks. */
#ifndef SLC_BASE_BYTES_H
#define SLC_BASE_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#endif

#define SLC_BLOCK 16

/** Block. Operations are element by element; comparisons give 255 for true. */
typedef uint8_t slc_block __attribute__((vector_size(SLC_BLOCK)));

/** Returns the bytes of an array of `count` bytes, with padding. */
static inline size_t slc_padded(size_t count)
{
    return (count + SLC_BLOCK - 1) / SLC_BLOCK * SLC_BLOCK;
}

static inline slc_block slc_load_block(const uint8_t *bytes)
{
    slc_block b;
    memcpy(&b, bytes, sizeof b);
    return b;
}

static inline void slc_store_block(uint8_t *bytes, slc_block b)
{
    memcpy(bytes, &b, sizeof b);
}

static inline slc_block slc_block_of(uint8_t byte)
{
    return (slc_block){0} + byte;
}

static inline slc_block slc_min_block(slc_block a, slc_block b)
{
#if defined(__SSE2__)
    return (slc_block)_mm_min_epu8((__m128i)a, (__m128i)b);
#elif defined(__ARM_NEON)
    return (slc_block)vminq_u8((uint8x16_t)a, (uint8x16_t)b);
#else
    slc_block less = (slc_block)(a < b);
    return (a & less) | (b & ~less);
#endif
}

static inline slc_block slc_max_block(slc_block a, slc_block b)
{
#if defined(__SSE2__)
    return (slc_block)_mm_max_epu8((__m128i)a, (__m128i)b);
#elif defined(__ARM_NEON)
    return (slc_block)vmaxq_u8((uint8x16_t)a, (uint8x16_t)b);
#else
    return ~slc_min_block(~a, ~b);
#endif
}

/** 255 where the bytes are equal. */
static inline slc_block slc_equal_block(slc_block a, slc_block b)
{
    return (slc_block)(a == b);
}

/** Bit i: byte i of the two differs. */
static inline uint32_t slc_block_difference(slc_block a, slc_block b)
{
#if defined(__SSE2__)
    return 0xFFFFu ^ (uint32_t)_mm_movemask_epi8(_mm_cmpeq_epi8((__m128i)a, (__m128i)b));
#else
    uint64_t words[2];
    slc_block differ = ~slc_equal_block(a, b);
    uint32_t bits = 0;
    memcpy(words, &differ, sizeof words);
    if (!(words[0] | words[1]))
        return 0;
    for (uint32_t i = 0; i < SLC_BLOCK; i++)
        bits |= (uint32_t)(differ[i] & 1) << i;
    return bits;
#endif
}

/** Returns where a batch of sums must end: a byte of a sum can count at most 255 blocks. */
static inline size_t slc_batch_end(size_t i, size_t padded)
{
    return i + 255 * SLC_BLOCK < padded ? i + 255 * SLC_BLOCK : padded;
}

/** Counts the set bits of a block's difference, without a population count instruction. */
static inline uint32_t slc_count_bits(uint32_t bits)
{
    bits -= bits >> 1 & 0x5555;
    bits = (bits & 0x3333) + (bits >> 2 & 0x3333);
    bits = (bits + (bits >> 4)) & 0x0F0F;
    return (bits + (bits >> 8)) & 31;
}

/** Returns the sum of the bytes. */
static inline uint32_t slc_block_sum(slc_block b)
{
#if defined(__SSE2__)
    __m128i halves = _mm_sad_epu8((__m128i)b, _mm_setzero_si128());
    return (uint32_t)_mm_cvtsi128_si32(halves) + (uint32_t)_mm_extract_epi16(halves, 4);
#else
    uint32_t sum = 0;
    for (uint32_t i = 0; i < SLC_BLOCK; i++)
        sum += b[i];
    return sum;
#endif
}

/** out[i] = min(in[2 i], in[2 i + 1]), i < count. Both are written and read in whole blocks. */
static inline void slc_halve_bytes(const uint8_t *in, uint32_t count, uint8_t *out)
{
    uint32_t i = 0;
#if defined(__SSE2__)
    for (; i < count; i += SLC_BLOCK / 2) {
        __m128i v = (__m128i)slc_load_block(in + 2 * i);
        __m128i least = _mm_min_epu8(_mm_and_si128(v, _mm_set1_epi16(255)), _mm_srli_epi16(v, 8));
        _mm_storel_epi64((__m128i *)(void *)(out + i), _mm_packus_epi16(least, least));
    }
#else
    for (; i < count; i++)
        out[i] = in[2 * i] < in[2 * i + 1] ? in[2 * i] : in[2 * i + 1];
#endif
}

/** Fills short rows, for which a call of memset would be most of the work. */
static inline void slc_fill_bytes(uint8_t *bytes, uint8_t value, size_t count)
{
    uint64_t word = UINT64_C(0x0101010101010101) * value;
    if (count > 4 * sizeof word) {
        memset(bytes, value, count);
    } else if (count >= sizeof word) {
        for (size_t i = 0; i + sizeof word < count; i += sizeof word)
            memcpy(bytes + i, &word, sizeof word);
        memcpy(bytes + count - sizeof word, &word, sizeof word);
    } else if (count >= 4) {
        memcpy(bytes, &word, 4);
        memcpy(bytes + count - 4, &word, 4);
    } else {
        for (size_t i = 0; i < count; i++)
            ((volatile uint8_t *)bytes)[i] = value; /* keeps compilers from calling memset */
    }
}

/** True if all `count` bytes, > 0, have this value. */
static inline bool slc_bytes_are(const uint8_t *bytes, size_t count, uint8_t value)
{
    return bytes[0] == value && memcmp(bytes, bytes + 1, count - 1) == 0;
}

#endif /* SLC_BASE_BYTES_H */
