/** Start and end of samples that draw a picture on a device with paged residency. */
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

/** Return value of paged_sample_begin: the sample continues. */
#define PAGED_SAMPLE_GOES_ON (-1)

/**
 * Creates the device. `outcome`: result of options_parse. Returns PAGED_SAMPLE_GOES_ON, or the
 * program's exit status: 0 after --help and --list-devices, 1 after an error, 2 for wrong usage, 77
 * if no device supports paged residency.
 */
int paged_sample_begin(enum option_outcome outcome, const struct paged_sample *sample,
                       struct gpu *gpu);

/** Returns the exit status. `gpu` may be destroyed before. Messages of validation layers count as a
 * failure. */
int paged_sample_end(struct gpu *gpu, bool good);

#endif /* SAMPLES_COMMON_PAGED_SAMPLE_H */
