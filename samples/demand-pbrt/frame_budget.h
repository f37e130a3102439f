/** Limits the host's work per frame before the launch. Needs no device; the caller supplies the
 * clock. */
#ifndef DEMAND_PBRT_FRAME_BUDGET_H
#define DEMAND_PBRT_FRAME_BUDGET_H

#include <stdbool.h>

/** Set `seconds`, `now` and `user_data`, and zero the rest. */
struct frame_budget {
    double seconds; ///< frame time; 0: no limit
    double (*now)(void *user_data);
    void *user_data;
    /* Private. */
    double start, work_end;
    double last;    ///< time when the frame or its last item began
    double longest; ///< longest recent item, in s; decays by half per frame
    double reserve; ///< time kept for the top level and the launch after the items, in s
};

void frame_budget_begin(struct frame_budget *budget);
/** Returns whether another item may begin: true if an item as long as the longest recent one would
 * end in time. Call it between any two items. */
bool frame_budget_has_time(struct frame_budget *budget);
/** Call after the last item. Returns the total time of all items in s. */
double frame_budget_end_work(struct frame_budget *budget);
/** Call after the launch. Returns the frame time in s. */
double frame_budget_end(struct frame_budget *budget);

#endif /* DEMAND_PBRT_FRAME_BUDGET_H */
