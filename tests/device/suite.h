/**
 * Conformance test of samples, each with its own map, written in compute and in fragment shaders.
 * Brute force checks that the marked tiles include the required ones and that all are allowed.
 */
#ifndef TESTS_DEVICE_SUITE_H
#define TESTS_DEVICE_SUITE_H

#include "device/conform.h"
#include "device/oracle.h"

#define SUITE_MAX_SAMPLES 65536u
#define SUITE_MODES 5u

extern const uint32_t suite_modes[SUITE_MODES]; ///< all address modes

struct suite {
    struct conform c;
    struct conform_sample samples[SUITE_MAX_SAMPLES];
    uint32_t count;
    struct oracle_filter filter;
    struct oracle_tiles required, asked;
    struct oracle_allowed allowed;
    uint64_t needed, excess, marks;
};

/** The one suite, empty; filters LINEAR with this device's fixed-point coordinates. */
struct suite *suite_begin(struct harness *h);

/** Gradients of 2^lod texels along the axes. */
struct ConformInput suite_level_input(const struct SluiceTextureEntry *e, double lod);

void suite_add(struct suite *s, struct SluiceTextureEntry entry, struct ConformInput in, double u,
               double v);

/**
 * Runs both stages. Prints lines "name value unit": the number of samples, of tiles that exact
 * samplers need, and of tiles that are requested beyond those.
 */
void suite_end(struct suite *s, const char *name);

/** Fails the test with all that is known of the sample. */
void suite_describe(const struct conform_sample *sample, const char *what, uint32_t level,
                    uint32_t x, uint32_t y);

/** The sums over all suites. */
void suite_print_total(void);

#endif /* TESTS_DEVICE_SUITE_H */
