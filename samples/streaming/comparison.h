/**
 * The frames of a walk against those of the truth, after the walk: PSNR where it was not computed
 * meanwhile, SSIM and FLIP of some. Until then frames are in files without a name.
 */
#ifndef SAMPLES_STREAMING_COMPARISON_H
#define SAMPLES_STREAMING_COMPARISON_H

#include "frame_file.h"
#include "gallery.h"
#include "measure.h"

struct comparison {
    const struct gallery *gallery; ///< borrowed
    struct measure *measure;       ///< borrowed
    struct frame_file streamed;    ///< all frames with --reference, else those that are looked at
    struct frame_file truth;       ///< of the same frames, without --reference
    double lowest;                 ///< PSNR so far
};

/** Frames that have pictures, in order. */
struct written_frames {
    uint32_t *frames; ///< room for all frames of the walk
    uint32_t count;
};

bool comparison_begin(const struct gallery *gallery, struct measure *measure,
                      struct comparison *comparison);
/** A zeroed struct is fine. */
void comparison_finish(struct comparison *comparison);

/**
 * Keeps a frame of the walk, if it will be looked at. `truth` is NULL with --reference; else the
 * frame's PSNR must be in the record.
 */
bool comparison_keep(struct comparison *comparison, uint32_t frame, const uint8_t *pixels,
                     const uint8_t *truth, bool written);

/**
 * Completes the records, on all processors, and writes the pictures of the error of the written
 * frames and, with --reference, these frames and their truth. The frame that differs most is
 * written, too, with --write-frames some. Nothing without a truth.
 */
bool comparison_run(const struct comparison *comparison, struct written_frames *written);

#endif /* SAMPLES_STREAMING_COMPARISON_H */
