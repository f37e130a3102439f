/** Internal functions of recordings, for played*.c only. */
#ifndef SLUICE_VIEW_PLAYED_PARTS_H
#define SLUICE_VIEW_PLAYED_PARTS_H

#include "played.h"

#define PLAYED_FIRST_STRIDE 64u
#define PLAYED_MOST_POINT_SIZE ((size_t)256 << 20)

/** Keeps the state as a checkpoint at the begin of a frame. If checkpoints exceed most_point_size,
 *  drops every second one and doubles the stride. False without memory. */
bool played_point_add(struct played *played, uint32_t frame);
void played_points_finish(struct played *played);
/** Adds the events of the call that was just played. Returns the number of evicted wanted tiles. */
uint32_t played_take_events(struct played *played, const SluiceTraceCall *call);

#endif /* SLUICE_VIEW_PLAYED_PARTS_H */
