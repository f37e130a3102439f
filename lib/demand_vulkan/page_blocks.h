/**
 * The blocks of the page table as the host knows them: who owns each, what its words are to be, and
 * what of that the device does not have yet. Lowest ones are handed out first, so that those in use
 * stay together. Block 0 is nobody's.
 */
#ifndef SLC_DEMAND_VULKAN_PAGE_BLOCKS_H
#define SLC_DEMAND_VULKAN_PAGE_BLOCKS_H

#include <sluice/base.h>
#include <sluice/shared/demand.h>

#define SLC_NO_ENTRY UINT32_MAX

struct slc_page_block {
    uint32_t entry;           ///< of the directory
    uint32_t resident;        ///< a bit per page that is shown or refused
    uint32_t kept;            ///< a bit per page that the block stays for, shown or not
    uint32_t device_resident; ///< what the device has of it
    uint32_t changed;         ///< a bit per page whose word the device does not have
    uint32_t changed_wide;    ///< the same of second words
    bool fresh;               ///< taken since the last record
    uint32_t words[SLUICE_DEMAND_BLOCK_WORDS];
};

struct slc_page_blocks {
    SluiceAllocationCallbacks cb;
    struct slc_page_block *table; ///< owned; `room` of them
    uint64_t *free, *changed;     ///< owned; a bit per block of `room`
    uint32_t *owners;             ///< owned; entries as the device knows them, SLC_NO_ENTRY: none
    uint32_t *used_owners;        ///< owned; slot_count times `room`: the same, as they were
    uint32_t capacity;            ///< block 0 included
    uint32_t room;                ///< grows up to `capacity`
    uint32_t slot_count;
    uint32_t count;     ///< in use
    uint32_t free_hint; ///< none is free before
};

void slc_page_blocks_init(struct slc_page_blocks *blocks, const SluiceAllocationCallbacks *cb,
                          uint32_t capacity, uint32_t slot_count);
/** Of zeroed ones: nothing to do. */
void slc_page_blocks_finish(struct slc_page_blocks *blocks);

/** A block for `entry`, with no page resident, marked as changed. Errors, with nothing changed:
 *  LIMIT_EXCEEDED if all are in use; OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_blocks_take(struct slc_page_blocks *blocks, uint32_t entry, uint32_t *block);
/** Marked as changed, too. */
void slc_page_blocks_give(struct slc_page_blocks *blocks, uint32_t block);

void slc_page_blocks_mark(struct slc_page_blocks *blocks, uint32_t block);
bool slc_page_blocks_is_free(const struct slc_page_blocks *blocks, uint32_t block);
/** The first block from `from` on that is marked as changed, or `room`. */
uint32_t slc_page_blocks_next_changed(const struct slc_page_blocks *blocks, uint32_t from);
/** No block is marked any more. */
void slc_page_blocks_unmark(struct slc_page_blocks *blocks);

#endif /* SLC_DEMAND_VULKAN_PAGE_BLOCKS_H */
