/**
 * Functions of shaders/include/sluice by number: their call in C and on a device, their arguments,
 * and the error of their results against exact arithmetic (long double, integers).
 */
#ifndef TESTS_EXTREMES_NUMERICS_H
#define TESTS_EXTREMES_NUMERICS_H

#include "extremes/extremes.h"

#include "numerics_shared.h"

#define NUMERICS_ROWS 3u

/** A kind of error, with bounds in C and on a device. */
struct numerics_error {
    const char *name, *unit;
    double bound, device_bound;
};

struct numerics_function {
    const char *name;
    struct numerics_error errors[NUMERICS_ROWS]; ///< errors; entries without a name are unused
    uint64_t quick, many;                        ///< number of cases
    void (*make)(uint64_t i, uint32_t *arguments);
    void (*call)(const uint32_t *arguments, uint32_t *results); ///< call in C, or NULL
    /** Adds to rows, one per error; to none if nothing is promised for the arguments. `device`:
     * denormals may have been flushed to 0, and NaN may have become any value. */
    void (*check)(const uint32_t *arguments, const uint32_t *results, bool device,
                  struct extremes_row *rows);
};

/** Element i is function i of numerics_shared.h. */
extern const struct numerics_function numerics_lod[NUMERICS_LOD_COUNT];
extern const struct numerics_function numerics_regions[NUMERICS_REGION_COUNT];
extern const struct numerics_function numerics_pages[NUMERICS_PAGE_COUNT];

/** Finds a function by its number in numerics_shared.h. */
const struct numerics_function *numerics_find(uint32_t function);

/** Initializes the rows of a function before the first case. numerics_end prints them, with the
 * prefix "c" or "device". */
void numerics_begin(const struct numerics_function *f, bool device,
                    struct extremes_row rows[NUMERICS_ROWS]);
void numerics_end(const struct numerics_function *f, bool device,
                  struct extremes_row rows[NUMERICS_ROWS]);

float numerics_real(const uint32_t *words, uint32_t i);
/** Returns whether the first `count` words are numbers, and finite as sluiceIsFinite defines it. */
bool numerics_are_finite(const uint32_t *words, uint32_t count);

/** Exact levels of detail for derivatives in texels, without bias. */
struct numerics_lods {
    long double finest, coarsest, isotropic;
    long double longer,
        minor; ///< lengths of the longer derivative, and of the ellipse's minor axis
};
struct numerics_lods numerics_exact_lods(const float dx[2], const float dy[2],
                                         long double anisotropy);

/** Folds a finite coordinate into [0, 1]. */
long double numerics_exact_fold(float coordinate, uint32_t mode);

/* Arguments that several functions share. */

/** Makes dx, dy: any floats, pairs of special floats, or a footprint near a special case: a whole
 * level, thin, parallel. */
void numerics_make_derivatives(uint64_t i, uint32_t *words);
/** Makes any coordinate; every second case is near the image. */
float numerics_make_coordinate(uint64_t i);
float numerics_make_bias(uint64_t i);
float numerics_make_anisotropy(uint64_t i);
uint32_t numerics_make_size(uint64_t i);

#endif /* TESTS_EXTREMES_NUMERICS_H */
