/**
 * Bit tree: set of numbers with the smallest and largest members in constant time. Level 0 has a
 * bit per number. Each of the five levels above has a bit per 64 bits of the level below.
 */
#ifndef SLC_PROXY_BIT_TREE_H
#define SLC_PROXY_BIT_TREE_H

#include <sluice/base.h>

#define SLC_BIT_LEVELS 6u
#define SLC_BIT_NONE UINT32_MAX

/** Zeroed: empty, capacity 0. */
struct slc_bit_tree {
    uint64_t *words[SLC_BIT_LEVELS];      ///< owned
    uint32_t word_counts[SLC_BIT_LEVELS]; ///< words of each level
    uint32_t count;                       ///< number of members
};

/** Makes room for numbers below `capacity`, at most 2^31. False: out of memory, and the set is
 *  unchanged. */
bool slc_bits_reserve(struct slc_bit_tree *bits, const SluiceAllocationCallbacks *cb,
                      uint32_t capacity);
void slc_bits_finish(struct slc_bit_tree *bits, const SluiceAllocationCallbacks *cb);
/** Returns the allocated bytes. */
uint64_t slc_bits_size(const struct slc_bit_tree *bits);

bool slc_bits_has(const struct slc_bit_tree *bits, uint32_t number);
/** Adds a number, for which there must be room. No effect on a member. */
void slc_bits_add(struct slc_bit_tree *bits, uint32_t number);
/** Removes a number. No effect if not a member. */
void slc_bits_remove(struct slc_bit_tree *bits, uint32_t number);
/** Removes all members. Time: proportional to members, not capacity. */
void slc_bits_remove_all(struct slc_bit_tree *bits);
/** Returns the smallest member >= `from`, or SLC_BIT_NONE. */
uint32_t slc_bits_next(const struct slc_bit_tree *bits, uint32_t from);
/** Returns the largest member, or SLC_BIT_NONE. */
uint32_t slc_bits_last(const struct slc_bit_tree *bits);

#endif /* SLC_PROXY_BIT_TREE_H */
