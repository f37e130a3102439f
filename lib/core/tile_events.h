/** Ring of the last state changes of tiles. Exists only if the application sets a capacity. */
#ifndef SLC_CORE_TILE_EVENTS_H
#define SLC_CORE_TILE_EVENTS_H

#include "core/state.h"

void slc_tile_events_finish(struct slc_tile_events *events, const SluiceAllocationCallbacks *cb);

/** Adds an event. Called by the residency machine; `user` is the manager. */
void slc_tile_event_add(void *user, const struct slc_node *node, uint8_t from, uint8_t to);

#endif /* SLC_CORE_TILE_EVENTS_H */
