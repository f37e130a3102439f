/** A layer between the library and a real device that lets calls fail on request. */
#ifndef TESTS_EXTREMES_FAILING_LAYER_H
#define TESTS_EXTREMES_FAILING_LAYER_H

#include "device/harness.h"

/** The only layer, of one device. Set it before any function is queried. */
struct failing_layer {
    PFN_vkGetInstanceProcAddr get; ///< function of the loader below
    uint64_t calls;                ///< number of calls that may fail
    uint64_t failing_call;         ///< number of the call to fail, from 1; 0: none
    bool fails_on;                 ///< true: later calls fail too
    VkResult failure;
    uint64_t memory_left;    ///< bytes left for allocations of 256 KiB or more
    uint32_t waited_in_vain; ///< waits that were requested after a permanent failure
};

extern struct failing_layer failing_layer;

/** Resets the count of calls; `call` fails. Memory is unlimited. */
void failing_layer_set(struct harness *h, uint64_t call, bool fails_on, VkResult failure);
PFN_vkVoidFunction failing_layer_get(VkInstance instance, const char *name);

#endif /* TESTS_EXTREMES_FAILING_LAYER_H */
