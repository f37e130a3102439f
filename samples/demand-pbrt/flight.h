/** An interactive preview without a window: the camera moves, and each frame has a time budget. */
#ifndef DEMAND_PBRT_FLIGHT_H
#define DEMAND_PBRT_FLIGHT_H

#include "frame_budget.h"
#include "launches.h"

/** Part of the frames. */
struct flight_phase {
    double sum, most; ///< seconds
};

/** Zeroed but for the first two is the beginning. */
struct flight {
    uint32_t frame_count;
    struct frame_budget budget;
    double *seconds; ///< owned; of each frame
    double missing;  ///< pixels that showed boxes or had no material, of all frames
    uint64_t resolved, most_resolved; ///< boxes, in all and in one frame
    struct flight_phase work, top_level, launch;
};

/** Moves the camera of the picture, which is in `constants`, to a share of the way; 1 leaves it. */
void flight_place_camera(const struct scene *scene, const struct pbrt_options *options,
                         const uint32_t size[2], double share, struct PbrtLaunch *constants);

/**
 * Flies once around the vertical axis through the middle of the scene, or from --fly-from, and ends
 * at the camera of the picture. Each frame resolves what the last one asked for, the nearest first,
 * until its time is spent, and traces all pixels once. Afterwards everything is ready for
 * launches_run. Says on stderr why it failed.
 */
bool flight_run(struct launches *launches, struct flight *flight);
/** Makes what launches asked for, the nearest first, within the time of the frame, which
 *  frame_budget_begin began: work of threads is not waited for. Says on stderr why it failed. */
bool flight_serve(struct launches *launches, struct flight *flight);
void flight_finish(struct flight *flight);

/** Prints figures, as summary_print does. */
void flight_print(const struct flight *flight, bool json);

#endif /* DEMAND_PBRT_FLIGHT_H */
