/**
 * A and B of a comparison: two sets of the settings that streaming and sampling depend on
 * (control_is_of_sets). Each set is a view_settings. B leaves all other fields unused.
 */
#ifndef SLUICE_VIEW_SETS_H
#define SLUICE_VIEW_SETS_H

#include "settings.h"

#include <stdbool.h>
#include <stddef.h>

#define SETS_SMALL_BUDGET (16u << 20) ///< bytes; budget of VIEW_WITH_BUDGET

/** Copies the settings of a set. Other fields of `to` stay. */
void sets_copy(const struct view_settings *from, struct view_settings *to);
/** Copies the settings of a set that take effect when the scene is opened. */
void sets_copy_opened(const struct view_settings *from, struct view_settings *to);
/** Returns true if a scene that was opened with `opened` must be opened again for `now`. */
bool sets_must_reopen(const struct view_settings *opened, const struct view_settings *now);
/** Sets one setting of a set. False, with a line on stderr that begins with `speaker`, for a wrong
 *  value and for a name that is unknown or not part of sets. Nothing changes then. */
bool sets_set(struct view_settings *set, const char *name, const char *value, const char *speaker);
/** Reads "budget=16,probability=1/512". False as sets_set; settings before the wrong one are set.
 */
bool sets_read(struct view_settings *set, const char *text, const char *speaker);
/** Writes the settings that differ between A and B, in the syntax of sets_read. "": none. */
void sets_write(const struct view_settings *a, const struct view_settings *b, char *text,
                size_t size);
/** Returns all settings of the second picture: shared settings from `a`, and the set of B. Outside
 *  view 8 and with a->compared VIEW_WITH_B, the set comes from `b`. Otherwise it follows `a`. */
struct view_settings sets_of_second(const struct view_settings *a, const struct view_settings *b);
/** Exchanges A and B. B stops following A. */
void sets_swap(struct view_settings *a, struct view_settings *b);
/** Names the second set in a few words: "everything", "16 MB", "feedback off". Returns `text`. */
const char *sets_name_second(const struct view_settings *a, const struct view_settings *b,
                             char *text, size_t size);

#endif /* SLUICE_VIEW_SETS_H */
