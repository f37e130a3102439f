/** A page table on the device beside a naive one, and a shader that uses its pages. */
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
    bool used; ///< true: used since the used bits were taken, or since its block was empty
};

struct directory_rig {
    struct harness *h;
    struct slc_vk vk;
    struct slc_caps caps;
    struct slc_page_directory dir;
    uint32_t page_capacity, block_capacity;
    struct naive_page *pages;                       ///< pages as the next record must show them
    struct naive_page *before;                      ///< pages as the last record showed them
    uint32_t *group_counts;                         ///< by 32 pages: number of resident ones
    uint32_t group_count;                           ///< number of groups with any
    struct harness_buffer directory, blocks, masks; ///< last content on the device
    struct harness_buffer uses;                     ///< pages that the shader looks up
    struct slc_compute use;
    uint32_t use_count, slot;
    bool *used[DIRECTORY_RIG_SLOTS]; ///< by page: expected result of next_used
};

void directory_rig_init(struct directory_rig *r, struct harness *h,
                        const SluiceAllocationCallbacks *cb, uint32_t page_capacity,
                        uint32_t block_capacity);
void directory_rig_finish(struct directory_rig *r);

/** Shows a page on both sides. Fails the test if they disagree whether there is a block for it. */
void directory_rig_show(struct directory_rig *r, uint32_t page, uint64_t value, bool wide);
void directory_rig_refuse(struct directory_rig *r, uint32_t page);
void directory_rig_hide(struct directory_rig *r, uint32_t page);

/** Notes the last record's pages on the host, as the device must show them. */
void directory_rig_recorded(struct directory_rig *r);
/** Records the changes, then compares every meaningful word. */
void directory_rig_record(struct directory_rig *r);
/** Launches a shader that looks up the first use_count pages of `uses`. `takes`: then moves the
 * used bits into the slot. Without `takes`, nothing may have changed since the last record. */
void directory_rig_launch(struct directory_rig *r, bool takes);
/** Checks that the slot's used bits are those of its launch. */
void directory_rig_check_used(struct directory_rig *r, uint32_t slot);

#endif /* TESTS_DEVICE_DIRECTORY_RIG_H */
