/**
 * The compute passes that turn request bits into a list: shaders/demand.
 *
 * Owns the buffers of requests and of sections that shaders write, see sluice/shared/demand.h. A
 * scan lists at most `capacity` pages, ordered by age (sections that have bits left over from an
 * earlier scan first), rank of their section, and id. What it lists is cleared; all else stays for
 * the next scan, and its sections are older from then on. The order is made of prefix sums: the
 * same requests, ranks and scans before give the same list on every device.
 *
 * One dispatch, or four where the last result had many sections. It looks at a bit per 1024 pages,
 * and then at sections that are flagged: nothing else costs. Threads: external.
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
    struct slc_buffer requests;  ///< a bit per page: shaders set it. STORAGE | TRANSFER_SRC, _DST
    struct slc_buffer sections;  ///< a bit per section: shaders set it with any bit of its pages
    struct slc_buffer postponed; ///< a bit per section
    struct slc_buffer ranks;     ///< a byte per section
    struct slc_buffer scratch;   ///< of one scan: see sluice/shared/demand_scan.h
    struct slc_buffer readback;  ///< a slot per launch in flight: the result, then page ids
    struct slc_compute compute;
    uint64_t page_capacity;
    uint32_t slot_count, list_capacity;
    uint32_t workgroup_count; ///< of the passes over requests
    uint32_t section_count;   ///< of the last result
    /** Up to so many in the last result the next scan is made by one workgroup; what it finds is
     * the same. */
    uint32_t one_group_sections;
};

/** Bytes of device memory of all buffers, but the readback, which is host memory. For 64 Mi pages
 *  8.6 MiB. */
uint64_t slc_demand_scan_device_size(const struct slc_demand_scan_create_info *info);

/** Errors: LIMIT_EXCEEDED if a buffer is beyond the device's maxStorageBufferRange;
 *  OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY, VULKAN. After an error all is finished. */
SluiceResult slc_demand_scan_init(struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  const struct slc_caps *caps,
                                  const struct slc_demand_scan_create_info *info);
/** Of a zeroed scan: nothing to do. No commands under way use it. */
void slc_demand_scan_finish(struct slc_demand_scan *scan, const struct slc_vk *vk);

/**
 * Transfers, before everything else that is recorded here: no page is requested, all ranks are 0.
 * For these three the caller puts barriers around: from all shaders before to TRANSFER, and from
 * TRANSFER to all shaders after. They may follow each other with none in between, but for the same
 * ranks and the same pages.
 */
void slc_demand_scan_record_clear(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  VkCommandBuffer commands);
/** `ranks`: those of all sections (slc_page_space_ranks), below SLUICE_DEMAND_RANKS, copied at
 * once; of them `count` from section `first` have changed. The bytes go into the command buffer. */
void slc_demand_scan_record_ranks(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                  VkCommandBuffer commands, const uint8_t *ranks, uint32_t first,
                                  uint32_t count);
/** Pages that nobody asks for any more, a range of slc_page_space: their bits are cleared, so that
 * a request that was postponed does not become one for whatever gets these ids next. */
void slc_demand_scan_record_forget(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                                   VkCommandBuffer commands, uint32_t first_page, uint64_t count);

/**
 * Records the scan, with barriers: from all shaders before, and to all shaders, transfers and the
 * host after. Binds a compute pipeline and set 0. Only sections below `page_end` (rounded up to
 * whole ones; at most page_capacity) are looked at. `slot`: read by the host already, or never
 * used. `capacity` up to list_capacity.
 */
void slc_demand_scan_record(const struct slc_demand_scan *scan, const struct slc_vk *vk,
                            VkCommandBuffer commands, uint32_t slot, uint64_t page_end,
                            uint32_t capacity);

/** What the scan wrote, once its submission is complete. `*pages` has listedCount ids and stays
 *  until the slot is used again. */
struct SluiceDemandScanResult slc_demand_scan_result(struct slc_demand_scan *scan, uint32_t slot,
                                                     const uint32_t **pages);

#endif /* SLC_DEMAND_VULKAN_SCAN_H */
