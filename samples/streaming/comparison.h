/**
 * Compares the frames of a walk with the truth, after the walk. Computes PSNR where the walk has
 * not, and SSIM and FLIP of some frames. Until then the frames are in unnamed files.
 */
#ifndef SAMPLES_STREAMING_COMPARISON_H
#define SAMPLES_STREAMING_COMPARISON_H

#include "frame_file.h"
#include "gallery.h"
#include "measure.h"

struct comparison {
    const struct gallery *gallery; ///< borrowed
    struct measure *measure;       ///< borrowed
    struct frame_file streamed;    ///< with --reference all frames, else the frames to measure
    struct frame_file truth; ///< true versions of the frames in `streamed`; unused with --reference
    double lowest;           ///< PSNR so far
};

/** Frames whose pictures are written, in order. */
struct written_frames {
    uint32_t *frames; ///< room for all frames of the walk
    uint32_t count;
};

bool comparison_begin(const struct gallery *gallery, struct measure *measure,
                      struct comparison *comparison);
/** Accepts a zeroed struct. */
void comparison_finish(struct comparison *comparison);

/**
 * Keeps a frame of the walk if it will be measured. With --reference `truth` is NULL. Without it
 * the record must hold the frame's PSNR.
 */
bool comparison_keep(struct comparison *comparison, uint32_t frame, const uint8_t *pixels,
                     const uint8_t *truth, bool written);

/**
 * Completes the records on all processors. Writes error pictures of the written frames. With
 * --reference also writes these frames and their truth; with --write-frames some, also the frame
 * that differs most. Does nothing without a truth.
 */
bool comparison_run(const struct comparison *comparison, struct written_frames *written);

#endif /* SAMPLES_STREAMING_COMPARISON_H */
