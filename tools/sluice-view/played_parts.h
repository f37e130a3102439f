/** Parts of a recording that is looked at, for played*.c alone. */
#ifndef SLUICE_VIEW_PLAYED_PARTS_H
#define SLUICE_VIEW_PLAYED_PARTS_H

#include "played.h"

#define PLAYED_FIRST_STRIDE 64u
#define PLAYED_MOST_POINT_SIZE ((size_t)256 << 20)

/** Keeps the state as the begin of a frame. Beyond the most bytes, every second point goes and the
 *  stride doubles. False without memory. */
bool played_point_add(struct played *played, uint32_t frame);
void played_points_finish(struct played *played);
/** Takes in the events of the call that was just played. Returns how many wanted tiles were
 *  evicted. */
uint32_t played_take_events(struct played *played, const SluiceTraceCall *call);

#endif /* SLUICE_VIEW_PLAYED_PARTS_H */
