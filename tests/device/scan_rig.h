/** The scan of requests, an oracle that sorts, and buffers for input and output. */
#ifndef TESTS_DEVICE_SCAN_RIG_H
#define TESTS_DEVICE_SCAN_RIG_H

#include "device/demand_rig.h"

#include "demand_vulkan/scan.h"

#define SCAN_RIG_SLOTS 3u

struct scan_want { /* in the order of the list */
    uint32_t age, rank, page;
};

struct scan_rig {
    struct harness *h;
    struct slc_vk vk;
    struct slc_caps caps;
    struct slc_demand_scan scan;
    uint32_t page_capacity, section_count, list_capacity;
    struct harness_buffer requests, sections; /* written by shaders, cleared by the oracle */
    struct harness_buffer requests_after, sections_after; /* content left by the device */
    uint8_t *ranks, *old;                                 /* by section */
    struct scan_want *wants;
    uint32_t want_count, want_capacity;
    struct SluiceDemandScanResult expected;
    uint32_t slot, page_end, capacity;
    bool clear, send_ranks;
};

/** Initializes without requests, with ranks 0, page_end covering all pages, and the capacity of the
 * list. `want_capacity`: for scan_rig_scan, most requests at once; for scan_rig_scan_many, most
 * listed pages. */
void scan_rig_init(struct scan_rig *r, struct harness *h, uint32_t section_count,
                   uint32_t list_capacity, uint32_t want_capacity);
void scan_rig_finish(struct scan_rig *r);

bool scan_rig_bit(const struct harness_buffer *buffer, uint32_t bit);
void scan_rig_set_bit(struct harness_buffer *buffer, uint32_t bit, bool value);
/** Requests a page like a shader. */
void scan_rig_request(struct scan_rig *r, uint32_t page);

/** Scans on the device, and on the host by sorting. Fails the test if list, result, remaining
 * requests, or words around the list differ. */
void scan_rig_scan(struct scan_rig *r);
/** Scans like scan_rig_scan, with a host that walks all ages, ranks and sections, for more requests
 * than can be sorted. */
void scan_rig_scan_many(struct scan_rig *r);

#endif /* TESTS_DEVICE_SCAN_RIG_H */
