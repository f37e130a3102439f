#include "proxy/bit_tree.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <assert.h>
#include <string.h>

static bool grow_level(struct slc_bit_tree *bits, const SluiceAllocationCallbacks *cb,
                       uint32_t level, uint32_t count)
{
    uint32_t old = bits->word_counts[level];
    if (count <= old)
        return true;
    uint64_t *words = slc_regrow(cb, bits->words[level], old, count, sizeof *words);
    if (!words)
        return false;
    memset(words + old, 0, (count - old) * sizeof *words);
    bits->words[level] = words;
    bits->word_counts[level] = count;
    return true;
}

bool slc_bits_reserve(struct slc_bit_tree *bits, const SluiceAllocationCallbacks *cb,
                      uint32_t capacity)
{
    if (capacity <= (uint64_t)bits->word_counts[0] * 64)
        return true;
    uint32_t count = slc_max_u32(slc_div_up_u32(capacity, 64), 2 * bits->word_counts[0]);
    for (uint32_t level = SLC_BIT_LEVELS; level-- > 0;) {
        uint64_t span = (uint64_t)1 << 6 * level; /* words of level 0 under one word */
        if (!grow_level(bits, cb, level, (uint32_t)((count + span - 1) / span)))
            return false;
    }
    return true;
}

void slc_bits_finish(struct slc_bit_tree *bits, const SluiceAllocationCallbacks *cb)
{
    for (uint32_t level = 0; level < SLC_BIT_LEVELS; level++)
        slc_free(cb, bits->words[level], bits->word_counts[level], sizeof *bits->words[level]);
    *bits = (struct slc_bit_tree){0};
}

uint64_t slc_bits_size(const struct slc_bit_tree *bits)
{
    uint64_t size = 0;
    for (uint32_t level = 0; level < SLC_BIT_LEVELS; level++)
        size += bits->word_counts[level] * sizeof *bits->words[level];
    return size;
}

bool slc_bits_has(const struct slc_bit_tree *bits, uint32_t number)
{
    uint32_t word = number / 64;
    return word < bits->word_counts[0] && (bits->words[0][word] >> number % 64 & 1);
}

void slc_bits_add(struct slc_bit_tree *bits, uint32_t number)
{
    assert(number / 64 < bits->word_counts[0]);
    if (slc_bits_has(bits, number))
        return;
    bits->count++;
    for (uint32_t level = 0; level < SLC_BIT_LEVELS; level++, number /= 64) {
        uint64_t *word = &bits->words[level][number / 64], old = *word;
        *word |= (uint64_t)1 << number % 64;
        if (old)
            return; /* bits above are set already */
    }
}

void slc_bits_remove(struct slc_bit_tree *bits, uint32_t number)
{
    if (!slc_bits_has(bits, number))
        return;
    bits->count--;
    for (uint32_t level = 0; level < SLC_BIT_LEVELS; level++, number /= 64) {
        uint64_t *word = &bits->words[level][number / 64];
        *word &= ~((uint64_t)1 << number % 64);
        if (*word)
            return;
    }
}

void slc_bits_remove_all(struct slc_bit_tree *bits)
{
    for (uint32_t i = slc_bits_next(bits, 0); i != SLC_BIT_NONE; i = slc_bits_next(bits, i))
        slc_bits_remove(bits, i);
}

static uint32_t lowest(uint64_t word)
{
    uint32_t bit = 0;
    for (uint32_t half = 32; half; half /= 2)
        if ((word >> bit & (((uint64_t)1 << half) - 1)) == 0)
            bit += half;
    return bit;
}

static uint32_t highest(uint64_t word)
{
    return word >> 32 ? 32 + slc_log2_u32((uint32_t)(word >> 32)) : slc_log2_u32((uint32_t)word);
}

uint32_t slc_bits_next(const struct slc_bit_tree *bits, uint32_t from)
{
    uint32_t level = 0;
    for (;; level++, from = from / 64 + 1) { /* go up to a word with a bit at or behind `from` */
        if (level == SLC_BIT_LEVELS || from / 64 >= bits->word_counts[level])
            return SLC_BIT_NONE;
        uint64_t word = bits->words[level][from / 64] >> from % 64;
        if (word) {
            from += lowest(word);
            break;
        }
    }
    while (level-- > 0)
        from = from * 64 + lowest(bits->words[level][from]);
    return from;
}

uint32_t slc_bits_last(const struct slc_bit_tree *bits)
{
    uint32_t at = 0;
    if (bits->count == 0)
        return SLC_BIT_NONE;
    for (uint32_t level = SLC_BIT_LEVELS; level-- > 0;)
        at = at * 64 + highest(bits->words[level][at]);
    return at;
}
