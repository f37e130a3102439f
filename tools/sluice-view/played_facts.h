/** Facts for the panels about the frame of a recording at the cursor. */
#ifndef SLUICE_VIEW_PLAYED_FACTS_H
#define SLUICE_VIEW_PLAYED_FACTS_H

#include "facts.h"
#include "played.h"

/** Creates facts of a recording. `facts->texture_count` must be set. False without memory. */
bool played_facts_create(const struct stage *stage, struct view_facts *facts);
/** Updates the facts if the cursor has moved. */
void played_facts_update(const struct stage *stage, struct view_facts *facts);
/** Prints the figures of the frame at the cursor, for --json. */
void played_print_json(const struct stage *stage, const struct view_facts *facts);

#endif /* SLUICE_VIEW_PLAYED_FACTS_H */
