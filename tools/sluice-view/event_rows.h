/** The events that the list of events shows. */
#ifndef SLUICE_VIEW_EVENT_ROWS_H
#define SLUICE_VIEW_EVENT_ROWS_H

#include "facts.h"

#define EVENT_ANY_REASON 0u ///< else 1 + SluiceTileEventReason

/** Writes the newest events, newest first, at most `most`. `texture`: index; STAGE_NO_TEXTURE: of
 *  all. Returns how many. */
uint32_t event_rows_find(const struct view_facts *facts, uint32_t reason, uint32_t texture,
                         const SluiceTileEvent **rows, uint32_t most);

#endif /* SLUICE_VIEW_EVENT_ROWS_H */
