/**
 * Functions of shaders/include/sluice by number: how each is called in C and on a device, on which
 * arguments, and how far its results are from those of exact arithmetic (long double, integers).
 */
#ifndef TESTS_EXTREMES_NUMERICS_H
#define TESTS_EXTREMES_NUMERICS_H

#include "extremes/extremes.h"

#include "numerics_shared.h"

#define NUMERICS_ROWS 3u

/** One kind of error; bounds in C and on a device. */
struct numerics_error {
    const char *name, *unit;
    double bound, device_bound;
};

struct numerics_function {
    const char *name;
    struct numerics_error errors[NUMERICS_ROWS]; ///< those without a name are not there
    uint64_t quick, many;                        ///< cases
    void (*make)(uint64_t i, uint32_t *arguments);
    void (*call)(const uint32_t *arguments, uint32_t *results); ///< in C, or NULL
    /** Adds to rows, one per error; or to none, if nothing is promised for the arguments. `device`:
     *  denormals may have been 0, and NaN may have been anything. */
    void (*check)(const uint32_t *arguments, const uint32_t *results, bool device,
                  struct extremes_row *rows);
};

/** Element i is function i of numerics_shared.h. */
extern const struct numerics_function numerics_lod[NUMERICS_LOD_COUNT];
extern const struct numerics_function numerics_regions[NUMERICS_REGION_COUNT];
extern const struct numerics_function numerics_pages[NUMERICS_PAGE_COUNT];

/** By the number in numerics_shared.h. */
const struct numerics_function *numerics_find(uint32_t function);

/** Rows of a function, before the first case; and prints them, with the prefix "c" or "device". */
void numerics_begin(const struct numerics_function *f, bool device,
                    struct extremes_row rows[NUMERICS_ROWS]);
void numerics_end(const struct numerics_function *f, bool device,
                  struct extremes_row rows[NUMERICS_ROWS]);

float numerics_real(const uint32_t *words, uint32_t i);
/** All of the first `count` are numbers, and as finite as sluiceIsFinite has it. */
bool numerics_are_finite(const uint32_t *words, uint32_t count);

/** Levels of detail of derivatives in texels, without bias, in exact arithmetic. */
struct numerics_lods {
    long double finest, coarsest, isotropic;
    long double longer, minor; ///< lengths: of the longer derivative, of the ellipse's minor axis
};
struct numerics_lods numerics_exact_lods(const float dx[2], const float dy[2],
                                         long double anisotropy);

/** The place inside [0, 1] that shows the same, of a finite coordinate. */
long double numerics_exact_fold(float coordinate, uint32_t mode);

/* Arguments that several functions share: */

/** dx, dy: any floats, pairs of special ones, or a footprint that is nearly one thing or another:
 *  a whole level, thin, parallel. */
void numerics_make_derivatives(uint64_t i, uint32_t *words);
/** Any; for every second case near the image. */
float numerics_make_coordinate(uint64_t i);
float numerics_make_bias(uint64_t i);
float numerics_make_anisotropy(uint64_t i);
uint32_t numerics_make_size(uint64_t i);

#endif /* TESTS_EXTREMES_NUMERICS_H */
