/** How long the host may work for a frame before it launches. No device; the clock is given. */
#ifndef DEMAND_PBRT_FRAME_BUDGET_H
#define DEMAND_PBRT_FRAME_BUDGET_H

#include <stdbool.h>

/** Zeroed but for `seconds`, `now` and `user_data` is the beginning. */
struct frame_budget {
    double seconds; ///< of a frame; 0: no limit
    double (*now)(void *user_data);
    void *user_data;
    /* Private. */
    double start, work_end;
    double last;    ///< when the last item began, or the frame
    double longest; ///< item, as far as it is remembered
    double reserve; ///< what follows the items: the top level and the launch
};

void frame_budget_begin(struct frame_budget *budget);
/** Whether another item may begin: it would end in time, if it takes as long as the longest of the
 *  last frames. Call it between any two items. */
bool frame_budget_has_time(struct frame_budget *budget);
/** After the last item. Returns the seconds of all items. */
double frame_budget_end_work(struct frame_budget *budget);
/** After the launch. Returns the seconds of the frame. */
double frame_budget_end(struct frame_budget *budget);

#endif /* DEMAND_PBRT_FRAME_BUDGET_H */
