/**
 * Scan of requests: compute passes that turn request bits into a list (shaders/demand).
 *
 * Owns the buffers of requests and sections that shaders write, see sluice/shared/demand.h. A scan
 * lists at most `capacity` pages, ordered by age (sections with bits left from an earlier scan
 * first), rank of their section, and id. Listed bits are cleared. Other bits stay for the next
 * scan, and their sections become older. The order comes from prefix sums: equal requests, ranks
 * and earlier scans give equal lists on every device.
 *
 * One dispatch, or four if the last result had many sections. The cost is one bit per 1024 pages,
 * plus the flagged sections. Threads: external.
 */
#ifndef SLC_DEMAND_VULKAN_SCAN_H
#define SLC_DEMAND_VULKAN_SCAN_H

#include "vulkan/buffer.h"
#include "vulkan/compute.h"

#include <sluice/shared/demand_scan.h>

struct slc_demand_scan_create_info {
    uint64_t page_capacity; ///< 1 to 2^31, a multiple of SLUICE_DEMAND_SECTION_PAGES
    uint32_t slot_count;    ///< launches in flight, 1 to 16
    uint32_t list_capacity; ///< pages that a scan may list, 0 to 2^20
};

struct slc_demand_scan {
    struct slc_buffer requests;  ///< one bit per page, set by shaders. STORAGE | TRANSFER_SRC, _DST
    struct slc_buffer sections;  ///< one bit per section, set by shaders with any bit of its pages
    struct slc_buffer postponed; ///< one bit per section
    struct slc_buffer ranks;     ///< one byte per section
    struct slc_buffer scratch;   ///< for one scan, see sluice/shared/demand_scan.h
    struct slc_buffer readback;  ///< one slot per launch in flight: the result, then page ids
    struct slc_compute compute;
    uint64_t page_capacity;
    uint32_t slot_count, list_capacity;
    uint32_t workgroup_count; ///< workgroups of the passes over requests
    uint32_t section_count;   ///< sections in the last result
    /** Most sections in the last result for which the next scan runs as one workgroup. The result
     * is equal. */
    uint32_t one_group_sections;
};

/** Returns the bytes of device memory of all buffers, without the readback, which is host memory.
 *  8.6 MiB for 64 Mi pages. */
uint64_t slc_demand_scan_device_size(const struct slc_demand_scan_create_info *info);

/** Creates buffers and passes. Errors: LIMIT_EXCEEDED if a buffer is beyond the device's
 *  maxStorageBufferRange; OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. After an error all is
 *  finished. */
SluiceResult slc_demand_scan_init(struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  const struct slc_caps *caps,
                                  const struct slc_demand_scan_create_info *info);
/** Destroys buffers and passes. No commands in progress may use them. `scan` may be zeroed. */
void slc_demand_scan_finish(struct slc_demand_scan *scan, const struct slc_vk *vk);

/**
 * Records transfers that clear all requests and ranks. Record it before all other functions here.
 *
 * For this function and the next two the caller records barriers: from all earlier shaders to
 * TRANSFER, and from TRANSFER to all later shaders. No barrier is necessary between them, unless
 * they write equal ranks or pages.
 */
void slc_demand_scan_record_clear(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  VkCommandBuffer commands);
/** Records changed ranks. `ranks`: ranks of all sections (slc_page_space_ranks), below
 * SLUICE_DEMAND_RANKS, of which `count` from `first` on have changed. The command buffer has a
 * copy.
 */
void slc_demand_scan_record_ranks(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  VkCommandBuffer commands, const uint8_t *ranks, uint32_t first,
                                  uint32_t count);
/** Clears the bits of a freed range of slc_page_space, so that postponed requests do not become
 * requests for the next owner of these ids. */
void slc_demand_scan_record_forget(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                   VkCommandBuffer commands, uint32_t first_page, uint64_t count);

/**
 * Records the scan, with barriers: from all earlier shaders, and to all later shaders, transfers
 * and the host. Binds a compute pipeline and set 0. Scans only sections below `page_end` (rounded
 * up to whole sections; at most page_capacity). `slot`: read by the host already, or never used.
 * `capacity`: at most list_capacity.
 */
void slc_demand_scan_record(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                            VkCommandBuffer commands, uint32_t slot, uint64_t page_end,
                            uint32_t capacity);

/** Gets the result of a scan, whose submission must be complete. `*pages` has listedCount ids, and
 *  stays until the slot is used again. */
struct SluiceDemandScanResult slc_demand_scan_result(struct slc_demand_scan *scan, uint32_t slot,
                                                     const uint32_t **pages);

#endif /* SLC_DEMAND_VULKAN_SCAN_H */
