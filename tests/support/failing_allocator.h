/** Allocator that fails after n calls, checks the sizes passed to free, and counts blocks that are
 * left. */
#ifndef TESTS_SUPPORT_FAILING_ALLOCATOR_H
#define TESTS_SUPPORT_FAILING_ALLOCATOR_H

#include <sluice/base.h>

struct failing_allocator {
    uint64_t calls;        ///< allocations asked for so far
    uint64_t refuse_from;  ///< this call and all later ones get NULL; UINT64_MAX: none
    uint64_t refuse_count; ///< but after so many refusals all succeed; 0: none does
    uint64_t live_bytes;   ///< not given back; threads must not overlap in it
    uint64_t live_count;
    SluiceAllocationCallbacks callbacks; ///< pass a pointer to this
};

/** `refuse_from` calls succeed. */
void failing_allocator_init(struct failing_allocator *allocator, uint64_t refuse_from);

#endif /* TESTS_SUPPORT_FAILING_ALLOCATOR_H */
