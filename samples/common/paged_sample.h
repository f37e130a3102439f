/** Beginning and end of samples that draw one picture on a device with pages. */
#ifndef SAMPLES_COMMON_PAGED_SAMPLE_H
#define SAMPLES_COMMON_PAGED_SAMPLE_H

#include "../../tools/common/gpu.h"
#include "../../tools/common/shared_options.h"

#include <stdbool.h>

/** Options that these samples share. */
struct paged_sample {
    const char *output, *device;
    bool validation, list_devices;
};

/** Returned by paged_sample_begin if the sample goes on. */
#define PAGED_SAMPLE_GOES_ON (-1)

/**
 * Creates the device. `outcome` is that of reading the options. Returns PAGED_SAMPLE_GOES_ON, or
 * the program's exit status: 0 after --help and --list-devices, 1 if something failed, 2 for wrong
 * usage, 77 if no device has pages.
 */
int paged_sample_begin(enum option_outcome outcome, const struct paged_sample *sample,
                       struct gpu *gpu);

/** Returns the exit status. `gpu` may have been destroyed. Messages of validation layers are a
 *  failure. */
int paged_sample_end(struct gpu *gpu, bool good);

#endif /* SAMPLES_COMMON_PAGED_SAMPLE_H */
