/**
 * Page table of demand loading, in which shaders look up pages (sluice/shared/demand.h), and its
 * copy on the host.
 *
 * Changes take effect with the next record. Changed words go through host-visible memory, one slot
 * per launch in flight. One dispatch copies them to their places, whatever their number. Without
 * changes nothing is recorded.
 *
 * A block is taken when the first of its 32 pages is shown, refused or kept. It is free again at
 * once when the last page is hidden and not kept, because words and directory change together. So
 * there is always a block if block_capacity is at least the number of pages that are shown, refused
 * or kept at any time, and pages are hidden before others are shown.
 *
 * Host memory: a word and a bit per 32 pages (8.3 MiB for 64 Mi pages), and 290 bytes per block,
 * plus four per launch in flight, for the most blocks that were ever in use. A lookup is one load.
 * A hash map would take more memory as soon as one entry in ten has a block. Threads: external.
 */
#ifndef SLC_DEMAND_VULKAN_PAGE_DIRECTORY_H
#define SLC_DEMAND_VULKAN_PAGE_DIRECTORY_H

#include "demand_vulkan/page_blocks.h"
#include "vulkan/buffer.h"
#include "vulkan/compute.h"

#include <sluice/shared/demand_scan.h>

#define SLC_PAGE_BLOCKS_MAX 0xFFFFFFu

struct slc_page_directory_create_info {
    uint64_t page_capacity;  ///< 1 to 2^31, a multiple of SLUICE_DEMAND_BLOCK_PAGES
    uint32_t block_capacity; ///< 1 to SLC_PAGE_BLOCKS_MAX; at worst one per resident page
    uint32_t slot_count;     ///< launches in flight, 1 to 16
};

struct slc_page_directory {
    const struct slc_vk *vk;     ///< borrowed
    const struct slc_caps *caps; ///< borrowed
    SluiceAllocationCallbacks cb;
    struct slc_buffer directory; ///< one word per block of pages
    struct slc_buffer blocks;    ///< SLUICE_DEMAND_BLOCK_WORDS per block; block 0 is unused
    struct slc_buffer masks;     ///< SluiceDemandBlockMasks per block
    struct slc_buffer readback;  ///< per slot: one word of used bits per block
    struct slc_compute patch, take_used;
    uint64_t page_capacity;
    uint32_t block_capacity, slot_count;
    bool cleared; ///< the device's buffers are cleared

    uint32_t *entries;         ///< owned; the directory: block of each entry, or none
    uint64_t *changed_entries; ///< owned; one bit per entry
    uint32_t *entry_list;      ///< owned; changed entries, each once
    uint32_t entry_list_count, entry_list_capacity;
    struct slc_page_blocks pool;
    bool changed;          ///< some block is marked
    uint32_t recorded_end; ///< end of the blocks in use on the device
    struct slc_page_directory_slot {
        struct slc_buffer upload;
        uint32_t patch_count; ///< patches in `upload`, of the last record
        bool cleared;         ///< the last record cleared the device's buffers
        uint32_t used_end;    ///< number of blocks whose used bits were taken
    } slots[SLC_COMPUTE_SETS];
};

/** Returns the bytes of device memory: directory, blocks and masks. */
uint64_t slc_page_directory_device_size(const struct slc_page_directory_create_info *info);

/** Creates the buffers. `vk` and `caps` must outlive them. Errors: LIMIT_EXCEEDED if a buffer is
 *  beyond the device's maxStorageBufferRange; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN.
 * After an error all is finished. */
SluiceResult slc_page_directory_init(struct slc_page_directory *dir, const struct slc_vk *vk,
                                     const struct slc_caps *caps,
                                     const SluiceAllocationCallbacks *cb,
                                     const struct slc_page_directory_create_info *info);
/** Destroys the buffers. No commands in progress may use them. `dir` may be zeroed. */
void slc_page_directory_finish(struct slc_page_directory *dir);

/**
 * Shows a page as resident with this value from the next record on. `wide`: the value's high half
 * is the second word; else only the low 32 bits count, and the second word is not written. Errors,
 * with nothing changed, only if the page's block has no other page: LIMIT_EXCEEDED if all blocks
 * are in use; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_page_directory_show(struct slc_page_directory *dir, uint32_t page, uint64_t value,
                                     bool wide);
/** Shows a page with the word SLUICE_DEMAND_PAGE_REFUSED, so that shaders do not request it. */
SluiceResult slc_page_directory_refuse(struct slc_page_directory *dir, uint32_t page);
/** Hides a page: clears its bit in the mask, and leaves its words. Does nothing if it is neither
 *  shown nor refused. */
void slc_page_directory_hide(struct slc_page_directory *dir, uint32_t page);
/** Keeps the block of a page, so that shaders may set its used bit from the next record on, even
 *  while it is hidden. Errors: as slc_page_directory_show. */
SluiceResult slc_page_directory_keep(struct slc_page_directory *dir, uint32_t page);
/** Ends slc_page_directory_keep. Does nothing if the page is not kept. */
void slc_page_directory_unkeep(struct slc_page_directory *dir, uint32_t page);
/** True if the page is shown with this value. Only the low 32 bits are compared. */
bool slc_page_directory_shows(const struct slc_page_directory *dir, uint32_t page, uint32_t value);
/** True if the page is shown with this 64-bit value. */
bool slc_page_directory_shows_wide(const struct slc_page_directory *dir, uint32_t page,
                                   uint64_t value);
/** True if the page is shown or refused. */
bool slc_page_directory_has(const struct slc_page_directory *dir, uint32_t page);

/**
 * Records the changes since the last record. The first record also clears the device's buffers.
 * Includes barriers, from all earlier shaders to all later shaders and transfers. Records nothing
 * without changes. Binds a compute pipeline and set 0. Submit the commands, in the order of the
 * calls, or abandon them. `slot`: its last submission must be complete. Errors, with nothing
 * recorded and all changes kept: OUT_OF_DEVICE_MEMORY, VULKAN, if the slot must grow;
 * LIMIT_EXCEEDED if the changed words, eight bytes each, exceed maxStorageBufferRange.
 */
SluiceResult slc_page_directory_record(struct slc_page_directory *dir, VkCommandBuffer commands,
                                       uint32_t slot);

/** Abandons the last record of a slot, which was never submitted. Abandon later records, too. The
 * next record repeats its changes. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_directory_abandon(struct slc_page_directory *dir, uint32_t slot);

/**
 * Records that the used bits of all blocks in use are copied into the slot and cleared. Includes
 * barriers, from all earlier shaders to all later shaders and the host. Record it after a launch.
 * Pages are as shown by the last record. `slot`: complete and read.
 */
void slc_page_directory_record_used(struct slc_page_directory *dir, VkCommandBuffer commands,
                                    uint32_t slot);

/** Iterator over used pages. Zeroed: before the first one. */
struct slc_page_used_iterator {
    uint32_t block, bits;
};
/**
 * Gets the next page whose used bit was set when record_used was executed for the slot. That
 * submission must be complete. False if there are no more. Sorted by block, then page. Includes
 * pages that are hidden by now, even if their block has another owner.
 */
bool slc_page_directory_next_used(const struct slc_page_directory *dir, uint32_t slot,
                                  struct slc_page_used_iterator *iterator, uint32_t *page);

/* Shared by page_directory.c and page_directory_record.c only. */
/** Reserves room in the list for `count` more entries, and for the entries of all blocks in use, so
 *  that hiding never fails. False without memory. */
bool slc_page_directory_reserve_entries(struct slc_page_directory *dir, uint32_t count);
/** Marks an entry as changed, because the device may have another word there. */
void slc_page_directory_change_entry(struct slc_page_directory *dir, uint32_t entry);

#endif /* SLC_DEMAND_VULKAN_PAGE_DIRECTORY_H */
