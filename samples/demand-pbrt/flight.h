/** An interactive preview without a window: the camera moves, and each frame has a time budget. */
#ifndef DEMAND_PBRT_FLIGHT_H
#define DEMAND_PBRT_FLIGHT_H

#include "frame_budget.h"
#include "launches.h"

/** Time of a part of the frames' work. */
struct flight_phase {
    double sum, most; ///< seconds
};

/** Zeroed, except `frame_count` and `budget`, is the start. */
struct flight {
    uint32_t frame_count;
    struct frame_budget budget;
    double *seconds; ///< owned; one per frame
    double missing;  ///< pixels that showed boxes or had no material, summed over the frames
    uint64_t resolved, most_resolved; ///< boxes, in total and at most in one frame
    struct flight_phase work, top_level, launch;
};

/** Moves the picture's camera in `constants` to a share of the way. 1 leaves it. */
void flight_place_camera(const struct scene *scene, const struct pbrt_options *options,
                         const uint32_t size[2], double share, struct PbrtLaunch *constants);

/**
 * Flies once around the vertical axis through the middle of the scene, or from --fly-from, and ends
 * at the picture's camera. Each frame resolves the requests of the previous one, nearest first,
 * within its time budget, and traces all pixels once. Afterwards launches_run can be called.
 * Reports errors on stderr.
 */
bool flight_run(struct launches *launches, struct flight *flight);
/** Makes what launches requested, nearest first, within the time since frame_budget_begin. Does not
 * wait for other threads. Reports errors on stderr. */
bool flight_serve(struct launches *launches, struct flight *flight);
void flight_finish(struct flight *flight);

/** Prints figures, like summary_print. */
void flight_print(const struct flight *flight, bool json);

#endif /* DEMAND_PBRT_FLIGHT_H */
