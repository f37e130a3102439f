/**
 * Required tiles of the finished picture: the pages that its complete paths have sampled, see
 * shaders/notes.glsl. Includes pages that were refused for lack of memory. If memory is so short
 * that later samples are blurrier, includes the pages of the earlier, sharper samples.
 */
#ifndef TRACER_NEEDS_H
#define TRACER_NEEDS_H

#include "../../tools/common/gpu.h"

/** Zeroed is empty. */
struct needs {
    bool on;
    struct gpu_buffer pages; ///< on the device: a bit per page; small if off
};

/** Clears all bits. Reports errors on stderr. */
bool needs_create(const struct gpu *gpu, bool on, struct needs *needs);
void needs_destroy(const struct gpu *gpu, struct needs *needs);

/** Call only while no launch is running. Reports errors on stderr. */
bool needs_count(const struct gpu *gpu, const struct needs *needs, uint64_t *page_count);

#endif /* TRACER_NEEDS_H */
