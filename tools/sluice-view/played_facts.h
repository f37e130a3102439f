/** Facts for the panels, of the frame of a recording at the cursor. */
#ifndef SLUICE_VIEW_PLAYED_FACTS_H
#define SLUICE_VIEW_PLAYED_FACTS_H

#include "facts.h"
#include "played.h"

/** `facts` has its number of textures. False without memory. */
bool played_facts_create(const struct stage *stage, struct view_facts *facts);
/** Does nothing while the cursor stays. */
void played_facts_update(const struct stage *stage, struct view_facts *facts);
/** Prints the figures of the frame at the cursor for programs. */
void played_print_json(const struct stage *stage, const struct view_facts *facts);

#endif /* SLUICE_VIEW_PLAYED_FACTS_H */
