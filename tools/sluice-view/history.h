/** Series of values over three spans of time, for graphs. */
#ifndef SLUICE_VIEW_HISTORY_H
#define SLUICE_VIEW_HISTORY_H

#include <stdbool.h>
#include <stdint.h>

#define HISTORY_POINTS 600u
#define HISTORY_FRAMES 3600u

enum history_span { HISTORY_10_SECONDS, HISTORY_MINUTE, HISTORY_ALL, HISTORY_SPANS };

/** Points of one span. A point has the largest value of the frames in its step. */
struct history_ring {
    double step;   ///< seconds per point
    float *values; ///< owned; [HISTORY_POINTS][series]
    uint64_t last; ///< number of the newest point: its time divided by the step
    uint32_t count;
};

struct history {
    struct history_ring rings[HISTORY_SPANS];
    uint32_t series_count;
    double seconds;       ///< time since the first frame
    float *frames;        ///< owned; seconds of the last HISTORY_FRAMES frames, a ring
    float *sorted;        ///< owned; scratch
    uint64_t frame_count; ///< number of frames so far
};

/** Creates a history. False, with a zeroed struct, without memory. */
bool history_create(uint32_t series_count, struct history *history);
/** Frees the history. A zeroed struct is allowed. */
void history_destroy(struct history *history);
/** Adds the values of a frame that took `seconds`. */
void history_add(struct history *history, double seconds, const float *values);
/** Number of known points of a span. */
uint32_t history_count(const struct history *history, enum history_span span);
/** Returns the value `age` points ago. */
float history_value(const struct history *history, enum history_span span, uint32_t series,
                    uint32_t age);
/** Writes all values of a series in a span, newest first. Returns their number, at most
 *  HISTORY_POINTS. */
uint32_t history_read(const struct history *history, enum history_span span, uint32_t series,
                      float *values);
/** Returns the age in points of a time in seconds since the first frame. UINT32_MAX if the span
 * does not contain the time. */
uint32_t history_age_of(const struct history *history, enum history_span span, double seconds);
/** Returns the time at the middle of a point. */
double history_time_of(const struct history *history, enum history_span span, uint32_t age);
/** Writes quantiles of the seconds per frame within a span, over at most the last HISTORY_FRAMES
 *  frames. `parts`: 0.5 for the median. */
void history_frame_times(struct history *history, enum history_span span, const double *parts,
                         uint32_t count, double *seconds);

#endif /* SLUICE_VIEW_HISTORY_H */
