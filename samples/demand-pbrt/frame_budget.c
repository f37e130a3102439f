#include "frame_budget.h"

/* Share of a maximum that is kept after each frame. */
#define FORGET_ITEM 0.5
#define FORGET_LAUNCH 0.7

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static double now(const struct frame_budget *b)
{
    return b->now(b->user_data);
}

void frame_budget_begin(struct frame_budget *b)
{
    b->start = b->last = now(b);
    b->longest *= FORGET_ITEM;
}

bool frame_budget_has_time(struct frame_budget *b)
{
    const double time = now(b);
    b->longest = larger(b->longest, time - b->last);
    b->last = time;
    return b->seconds == 0.0 || time - b->start + b->longest + b->reserve <= b->seconds;
}

double frame_budget_end_work(struct frame_budget *b)
{
    b->work_end = now(b);
    b->longest = larger(b->longest, b->work_end - b->last);
    return b->work_end - b->start;
}

double frame_budget_end(struct frame_budget *b)
{
    const double time = now(b), after = time - b->work_end;
    b->reserve = larger(after, FORGET_LAUNCH * b->reserve);
    return time - b->start;
}
