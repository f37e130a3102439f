/** Between the library and a real device: calls that may fail do so when the test says it. */
#ifndef TESTS_EXTREMES_FAILING_LAYER_H
#define TESTS_EXTREMES_FAILING_LAYER_H

#include "device/harness.h"

/** One at a time, of one device; set before the first function is asked for. */
struct failing_layer {
    PFN_vkGetInstanceProcAddr get; ///< of the loader below
    uint64_t calls;                ///< of functions that may fail
    uint64_t failing_call;         ///< from 1; 0: none
    bool fails_on;                 ///< and all later ones
    VkResult failure;
    uint64_t memory_left;    ///< bytes of allocations of 256 KiB and more
    uint32_t waited_in_vain; ///< waits that were asked for after a failure that goes on
};

extern struct failing_layer failing_layer;

/** Counts from 0; `call` fails. Memory is as much as there is. */
void failing_layer_set(struct harness *h, uint64_t call, bool fails_on, VkResult failure);
PFN_vkVoidFunction failing_layer_get(VkInstance instance, const char *name);

#endif /* TESTS_EXTREMES_FAILING_LAYER_H */
