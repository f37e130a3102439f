/** Selects events for the list of events. */
#ifndef SLUICE_VIEW_EVENT_ROWS_H
#define SLUICE_VIEW_EVENT_ROWS_H

#include "facts.h"

#define EVENT_ANY_REASON 0u ///< other values: 1 + SluiceTileEventReason

/** Writes at most `most` events, newest first. Returns their number. `texture`: index;
 *  STAGE_NO_TEXTURE: events of all textures. */
uint32_t event_rows_find(const struct view_facts *facts, uint32_t reason, uint32_t texture,
                         const SluiceTileEvent **rows, uint32_t most);

#endif /* SLUICE_VIEW_EVENT_ROWS_H */
