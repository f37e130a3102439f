/** A sweep whose figures are formulas of the point's index, and the files of its runs. */
#ifndef TESTS_TRADEOFF_PAGE_SWEEP_H
#define TESTS_TRADEOFF_PAGE_SWEEP_H

#include "sweep.h"

#define PAGE_SWEEP_POINTS 11
#define PAGE_SWEEP_DONE 9 ///< the first points; then one that failed, and one that is pending
#define PAGE_SWEEP_BASE 2
#define PAGE_SWEEP_SETTINGS 3
#define PAGE_SWEEP_RECOMMENDATIONS 3
#define PAGE_SWEEP_EQUAL 3   ///< the point whose psnr_mean_db is 999
#define PAGE_SWEEP_UNKNOWN 5 ///< the point without gpu_ms_median

enum page_sweep_metric {
    PAGE_SWEEP_MEMORY, ///< resident_bytes_peak: (1 + 5 i mod 11) 4 MiB
    PAGE_SWEEP_FLIP,   ///< flip_mean: (1 + 7 i mod 11) / 100
    PAGE_SWEEP_PSNR,   ///< psnr_mean_db: 40 - i
    PAGE_SWEEP_TIME,   ///< gpu_ms_median: 2 + i mod 4
    PAGE_SWEEP_ODD,    ///< neither less nor more is better: -infinity
    PAGE_SWEEP_METRICS
};

struct page_sweep {
    struct sweep sweep;
    struct sweep_point points[PAGE_SWEEP_POINTS];
    struct sweep_estimate estimates[PAGE_SWEEP_POINTS][PAGE_SWEEP_METRICS];
    struct sweep_estimate deltas[PAGE_SWEEP_POINTS][PAGE_SWEEP_METRICS];
    char *values[PAGE_SWEEP_POINTS][PAGE_SWEEP_SETTINGS];
    char folders[PAGE_SWEEP_POINTS][512];
    struct sweep_recommendation recommendations[PAGE_SWEEP_RECOMMENDATIONS];
};

/** Text of each word in the hostile sweep. */
extern const char page_sweep_hostile[];

/**
 * Half widths are a fiftieth of the mean. For differences to the base they are 0, but 3 for
 * gpu_ms_median. Folders are ROOT/I. `hostile`: all words are hostile.
 */
void page_sweep_init(struct page_sweep *s, const char *root, bool hostile);

/** Creates a point's folder, and writes a file into it. */
void page_sweep_add_file(const struct page_sweep *s, uint32_t point, const char *name,
                         const void *bytes, size_t size);

/**
 * Writes frames.csv: psnr_db is 20 + (7 frame + point) mod 30 but 999 in frame 1, missing_pixels
 * 100 in frame 0, else none, of 1000 sampled_pixels.
 */
void page_sweep_add_frames(const struct page_sweep *s, uint32_t point, uint32_t frames);

/** Writes a PNG file of 4x2 pixels, behind whose end there are `filler_size` bytes that are `id`.
 */
void page_sweep_add_picture(const struct page_sweep *s, uint32_t point, const char *kind,
                            uint32_t frame, uint8_t id, size_t filler_size);

#endif /* TESTS_TRADEOFF_PAGE_SWEEP_H */
