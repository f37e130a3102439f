/**
 * The page table of demand loading, which shaders look pages up in (sluice/shared/demand.h), and
 * its copy on the host.
 *
 * What is shown, hidden and refused takes effect with the next record: the words that changed go
 * through memory that the host writes, one slot per launch in flight, and one dispatch puts them in
 * their places, whatever their number. Nothing is recorded where nothing changed.
 *
 * A block is taken when the first of its 32 pages is shown, refused or kept, and free again when
 * the last is hidden and not kept: at once, because words and directory change together. So there
 * is always a block if block_capacity is at least the number of pages that are shown, refused or
 * kept at any time, and pages are hidden before others are shown.
 *
 * Host memory: a word and a bit per 32 pages (8.3 MiB for 64 Mi; looking a page up is one load,
 * where a map would cost more for all of its entries as soon as one in ten has a block), and 290
 * bytes per block, with four more per launch in flight, for as many as were ever in use at once.
 * Threads: external.
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
    uint32_t block_capacity; ///< 1 to SLC_PAGE_BLOCKS_MAX; at worst each resident page has its own
    uint32_t slot_count;     ///< launches in flight, 1 to 16
};

struct slc_page_directory {
    const struct slc_vk *vk;     ///< borrowed
    const struct slc_caps *caps; ///< borrowed
    SluiceAllocationCallbacks cb;
    struct slc_buffer directory; ///< a word per block of pages
    struct slc_buffer blocks;    ///< SLUICE_DEMAND_BLOCK_WORDS per block; block 0 is nobody's
    struct slc_buffer masks;     ///< SluiceDemandBlockMasks per block
    struct slc_buffer readback;  ///< per slot a word of used bits per block
    struct slc_compute patch, take_used;
    uint64_t page_capacity;
    uint32_t block_capacity, slot_count;
    bool cleared; ///< the device's buffers

    uint32_t *entries;         ///< owned; the directory: a block each, or none
    uint64_t *changed_entries; ///< owned; a bit per entry
    uint32_t *entry_list;      ///< owned; those that changed, each once
    uint32_t entry_list_count, entry_list_capacity;
    struct slc_page_blocks pool;
    bool changed;          ///< any block is marked
    uint32_t recorded_end; ///< the device has no blocks in use from here on
    struct slc_page_directory_slot {
        struct slc_buffer upload;
        uint32_t patch_count; ///< in `upload`, of the last record
        bool cleared;         ///< that record cleared the device's buffers
        uint32_t used_end;    ///< blocks whose used bits were taken
    } slots[SLC_COMPUTE_SETS];
};

/** Bytes of device memory: directory, blocks and masks. */
uint64_t slc_page_directory_device_size(const struct slc_page_directory_create_info *info);

/** `vk` and `caps` must outlive it. Errors: LIMIT_EXCEEDED if a buffer is beyond the device's
 *  maxStorageBufferRange; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. After an error all is
 *  finished. */
SluiceResult slc_page_directory_init(struct slc_page_directory *dir, const struct slc_vk *vk,
                                     const struct slc_caps *caps,
                                     const SluiceAllocationCallbacks *cb,
                                     const struct slc_page_directory_create_info *info);
/** Of a zeroed directory: nothing to do. No commands under way use it. */
void slc_page_directory_finish(struct slc_page_directory *dir);

/**
 * The page is resident with this value from the next record on; whatever it was before. `wide`: the
 * value's high half is its second word; else only the low 32 bits count, and the second word is not
 * written. Errors, with nothing changed, both only if the page's block has no other page:
 * LIMIT_EXCEEDED if all blocks are in use; OUT_OF_HOST_MEMORY.
 */
SluiceResult slc_page_directory_show(struct slc_page_directory *dir, uint32_t page, uint64_t value,
                                     bool wide);
/** Shown with the word SLUICE_DEMAND_PAGE_REFUSED: a tile that shaders do not ask for. */
SluiceResult slc_page_directory_refuse(struct slc_page_directory *dir, uint32_t page);
/** Absent: its bit in the mask is cleared, its words stay what they are. Of a page that is neither
 *  shown nor refused: nothing. */
void slc_page_directory_hide(struct slc_page_directory *dir, uint32_t page);
/** Shaders may set the page's used bit from the next record on, even while it is not shown: its
 *  block stays. Errors: as slc_page_directory_show. */
SluiceResult slc_page_directory_keep(struct slc_page_directory *dir, uint32_t page);
/** Ends slc_page_directory_keep. Does nothing if the page is not kept. */
void slc_page_directory_unkeep(struct slc_page_directory *dir, uint32_t page);
/** Shown with this value, of which the low 32 bits count. */
bool slc_page_directory_shows(const struct slc_page_directory *dir, uint32_t page, uint32_t value);
/** True if shaders see the page with this 64-bit value. */
bool slc_page_directory_shows_wide(const struct slc_page_directory *dir, uint32_t page,
                                   uint64_t value);
/** Shown or refused. */
bool slc_page_directory_has(const struct slc_page_directory *dir, uint32_t page);

/**
 * Records what changed since the last time, and, the first time, clears the device's buffers. With
 * barriers: from all shaders before to all shaders and transfers after, nothing if nothing changed.
 * Binds a compute pipeline and set 0. What is recorded must be submitted, in the order of the
 * calls, or abandoned. `slot`: its last submission is complete. Errors, with nothing recorded and
 * all changes kept: OUT_OF_DEVICE_MEMORY, VULKAN, when the slot must grow; LIMIT_EXCEEDED if so
 * much has changed that the slot would be beyond the device's maxStorageBufferRange, eight bytes
 * for each word.
 */
SluiceResult slc_page_directory_record(struct slc_page_directory *dir, VkCommandBuffer commands,
                                       uint32_t slot);

/** The last record of the slot was never submitted, nor were those after it, whose slots are
 * abandoned as well: what it was to change, the next record changes. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_page_directory_abandon(struct slc_page_directory *dir, uint32_t slot);

/**
 * Takes the used bits of all blocks in use: copies them into the slot and clears them. With
 * barriers: from all shaders before, to all shaders and the host after. Belongs after a launch;
 * pages are those that the last record showed. `slot`: as above, and read.
 */
void slc_page_directory_record_used(struct slc_page_directory *dir, VkCommandBuffer commands,
                                    uint32_t slot);

/** Zeroed: before the first. */
struct slc_page_used_iterator {
    uint32_t block, bits;
};
/**
 * The next page whose used bit was set when record_used was executed for the slot, once that
 * submission is complete; false if there are no more. By block, ascending within it. Pages that are
 * hidden by now count, too: it is what the launch used, whoever owns the blocks today.
 */
bool slc_page_directory_next_used(const struct slc_page_directory *dir, uint32_t slot,
                                  struct slc_page_used_iterator *iterator, uint32_t *page);

/* Of page_directory.c and page_directory_record.c alone. */
/** Room for so many entries more in the list, and for those of all blocks in use, so that hiding
 *  never fails. False: no memory. */
bool slc_page_directory_reserve_entries(struct slc_page_directory *dir, uint32_t count);
/** The device may have another word there. */
void slc_page_directory_change_entry(struct slc_page_directory *dir, uint32_t entry);

#endif /* SLC_DEMAND_VULKAN_PAGE_DIRECTORY_H */
