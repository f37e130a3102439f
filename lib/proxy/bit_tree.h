/**
 * A set of numbers that finds its smallest and largest members in constant time: a bit for each
 * number, and a bit for each 64 bits below, in six levels.
 */
#ifndef SLC_PROXY_BIT_TREE_H
#define SLC_PROXY_BIT_TREE_H

#include <sluice/base.h>

#define SLC_BIT_LEVELS 6u
#define SLC_BIT_NONE UINT32_MAX

/** Zeroed: empty, with room for nothing. */
struct slc_bit_tree {
    uint64_t *words[SLC_BIT_LEVELS];      ///< owned
    uint32_t word_counts[SLC_BIT_LEVELS]; ///< of each level
    uint32_t count;                       ///< members
};

/** Makes room for numbers below `capacity`, at most 2^31. Returns false without memory; the set is
 *  as it was. */
bool slc_bits_reserve(struct slc_bit_tree *bits, const SluiceAllocationCallbacks *cb,
                      uint32_t capacity);
void slc_bits_finish(struct slc_bit_tree *bits, const SluiceAllocationCallbacks *cb);
/** Bytes allocated. */
uint64_t slc_bits_size(const struct slc_bit_tree *bits);

bool slc_bits_has(const struct slc_bit_tree *bits, uint32_t number);
/** Requires room. Nothing happens if the number is a member. */
void slc_bits_add(struct slc_bit_tree *bits, uint32_t number);
/** Nothing happens if the number is not a member. */
void slc_bits_remove(struct slc_bit_tree *bits, uint32_t number);
/** Time follows the members, not the room. */
void slc_bits_remove_all(struct slc_bit_tree *bits);
/** The smallest member that is at least `from`, or SLC_BIT_NONE. */
uint32_t slc_bits_next(const struct slc_bit_tree *bits, uint32_t from);
/** The largest member, or SLC_BIT_NONE. */
uint32_t slc_bits_last(const struct slc_bit_tree *bits);

#endif /* SLC_PROXY_BIT_TREE_H */
