/** A page table on the device beside a naive one, and a shader that uses pages of it. */
#ifndef TESTS_DEVICE_DIRECTORY_RIG_H
#define TESTS_DEVICE_DIRECTORY_RIG_H

#include "device/demand_rig.h"

#include "demand_vulkan/page_directory.h"
#include "vulkan/compute.h"

#define DIRECTORY_RIG_SLOTS 3u
#define DIRECTORY_RIG_USES 4096u

struct naive_page {
    uint64_t value;
    bool there, wide;
    bool used; ///< since the used bits were taken, or nothing of its block was there
};

struct directory_rig {
    struct harness *h;
    struct slc_vk vk;
    struct slc_caps caps;
    struct slc_page_directory dir;
    uint32_t page_capacity, block_capacity;
    struct naive_page *pages;                       ///< as the next record is to show them
    struct naive_page *before;                      ///< as the last record showed them
    uint32_t *group_counts;                         ///< by 32 pages: those that are there
    uint32_t group_count;                           ///< that have any
    struct harness_buffer directory, blocks, masks; ///< what the device had last
    struct harness_buffer uses;                     ///< pages that the shader looks up
    struct slc_compute use;
    uint32_t use_count, slot;
    bool *used[DIRECTORY_RIG_SLOTS]; ///< by page: what next_used must yield
};

void directory_rig_init(struct directory_rig *r, struct harness *h,
                        const SluiceAllocationCallbacks *cb, uint32_t page_capacity,
                        uint32_t block_capacity);
void directory_rig_finish(struct directory_rig *r);

/** On both sides; fails the test if they disagree about whether there is a block for it. */
void directory_rig_show(struct directory_rig *r, uint32_t page, uint64_t value, bool wide);
void directory_rig_refuse(struct directory_rig *r, uint32_t page);
void directory_rig_hide(struct directory_rig *r, uint32_t page);

/** The host's part of the last record: what the device is to show. */
void directory_rig_recorded(struct directory_rig *r);
/** Records the changes, and then compares every word that says something. */
void directory_rig_record(struct directory_rig *r);
/** A launch that looks up the first use_count pages of `uses`; then, if `takes`, takes the used
 * bits into the slot. Where it does not, nothing has changed since the last record. */
void directory_rig_launch(struct directory_rig *r, bool takes);
/** What the slot says is what that launch used. */
void directory_rig_check_used(struct directory_rig *r, uint32_t slot);

#endif /* TESTS_DEVICE_DIRECTORY_RIG_H */
