/**
 * Blocks of the page table on the host: their owners, their words, and changes that the device does
 * not have yet. Low blocks are taken first, so that blocks in use stay together. Block 0 is unused.
 */
#ifndef SLC_DEMAND_VULKAN_PAGE_BLOCKS_H
#define SLC_DEMAND_VULKAN_PAGE_BLOCKS_H

#include <sluice/base.h>
#include <sluice/shared/demand.h>

#define SLC_NO_ENTRY UINT32_MAX

struct slc_page_block {
    uint32_t entry;           ///< entry of the directory
    uint32_t resident;        ///< one bit per page that is shown or refused
    uint32_t kept;            ///< one bit per page that keeps the block, shown or not
    uint32_t device_resident; ///< `resident` as the device has it
    uint32_t changed;         ///< one bit per page whose word the device does not have
    uint32_t changed_wide;    ///< one bit per page whose second word the device does not have
    bool fresh;               ///< taken since the last record
    uint32_t words[SLUICE_DEMAND_BLOCK_WORDS];
};

struct slc_page_blocks {
    SluiceAllocationCallbacks cb;
    struct slc_page_block *table; ///< owned, [room]
    uint64_t *free, *changed;     ///< owned; one bit per block of `room`
    uint32_t *owners;      ///< owned, [room]: entries as the device has them; SLC_NO_ENTRY: none
    uint32_t *used_owners; ///< owned, [slot_count][room]: `owners` of earlier launches
    uint32_t capacity;     ///< most blocks, including block 0
    uint32_t room;         ///< allocated blocks; grows up to `capacity`
    uint32_t slot_count;
    uint32_t count;     ///< blocks in use
    uint32_t free_hint; ///< no block before this index is free
};

void slc_page_blocks_init(struct slc_page_blocks *blocks, const SluiceAllocationCallbacks *cb,
                          uint32_t capacity, uint32_t slot_count);
/** Frees the blocks. `blocks` may be zeroed. */
void slc_page_blocks_finish(struct slc_page_blocks *blocks);

/** Takes a block without resident pages for `entry`, and marks it as changed. Errors, with nothing
 *  changed: LIMIT_EXCEEDED if all blocks are in use; OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_blocks_take(struct slc_page_blocks *blocks, uint32_t entry, uint32_t *block);
/** Gives a block back, and marks it as changed. */
void slc_page_blocks_give(struct slc_page_blocks *blocks, uint32_t block);

void slc_page_blocks_mark(struct slc_page_blocks *blocks, uint32_t block);
bool slc_page_blocks_is_free(const struct slc_page_blocks *blocks, uint32_t block);
/** Returns the first block from `from` on that is marked as changed, or `room`. */
uint32_t slc_page_blocks_next_changed(const struct slc_page_blocks *blocks, uint32_t from);
/** Removes the marks of all blocks. */
void slc_page_blocks_unmark(struct slc_page_blocks *blocks);

#endif /* SLC_DEMAND_VULKAN_PAGE_BLOCKS_H */
