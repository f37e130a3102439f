/**
 * A and B of a comparison: two sets of the settings that streaming and sampling depend on
 * (control_is_of_sets). Each set is a view_settings; its other fields are unused in that of B.
 */
#ifndef SLUICE_VIEW_SETS_H
#define SLUICE_VIEW_SETS_H

#include "settings.h"

#include <stdbool.h>
#include <stddef.h>

#define SETS_SMALL_BUDGET (16u << 20) ///< of VIEW_WITH_BUDGET

/** Copies the settings of a set, and leaves the rest of `to`. */
void sets_copy(const struct view_settings *from, struct view_settings *to);
/** Copies those settings of a set that take effect when the scene is opened. */
void sets_copy_opened(const struct view_settings *from, struct view_settings *to);
/** Whether the scene must be opened again for `now`, if it was opened with `opened`. */
bool sets_must_reopen(const struct view_settings *opened, const struct view_settings *now);
/** Sets one setting of a set. False, with a line on stderr behind `speaker`, for a name that is
 *  unknown or of no set, and for a wrong value: nothing has changed then. */
bool sets_set(struct view_settings *set, const char *name, const char *value, const char *speaker);
/** Reads "budget=16,probability=1/512". False as sets_set: those before the wrong one are set. */
bool sets_read(struct view_settings *set, const char *text, const char *speaker);
/** Writes the settings of B that differ from those of A, as sets_read takes them. "": none. */
void sets_write(const struct view_settings *a, const struct view_settings *b, char *text,
                size_t size);
/** Returns all that the second picture is drawn with: shared settings of `a`, and a set that
 *  follows `a` in view 8 and unless a->compared is VIEW_WITH_B. */
struct view_settings sets_of_second(const struct view_settings *a, const struct view_settings *b);
/** Exchanges A and B. B does not follow A from then on. */
void sets_swap(struct view_settings *a, struct view_settings *b);
/** Names the second set in a few words: "everything", "16 MB", "feedback off". Returns `text`. */
const char *sets_name_second(const struct view_settings *a, const struct view_settings *b,
                             char *text, size_t size);

#endif /* SLUICE_VIEW_SETS_H */
