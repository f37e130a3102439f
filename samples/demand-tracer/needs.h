/**
 * What the finished picture needed: the pages that its complete paths have sampled, see
 * shaders/notes.glsl. Those that were refused for want of memory are among them; and where memory
 * is so short that samples become blurrier meanwhile, those of the sharper samples before.
 */
#ifndef TRACER_NEEDS_H
#define TRACER_NEEDS_H

#include "../../tools/common/gpu.h"

/** Zeroed is empty. */
struct needs {
    bool on;
    struct gpu_buffer pages; ///< on the device: a bit per page; small when off
};

/** No page is needed yet. Says on stderr why it failed. */
bool needs_create(const struct gpu *gpu, bool on, struct needs *needs);
void needs_destroy(const struct gpu *gpu, struct needs *needs);

/** When no launch is under way. Says on stderr why it failed. */
bool needs_count(const struct gpu *gpu, const struct needs *needs, uint64_t *page_count);

#endif /* TRACER_NEEDS_H */
