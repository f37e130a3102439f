/**
 * The table of all controls. One row defines the option, the widget with its hint, the line in the
 * file of settings, the event `set` of scripts, and the part of "copy command line".
 */
#ifndef SLUICE_VIEW_CONTROLS_H
#define SLUICE_VIEW_CONTROLS_H

#include "settings.h"

#include "../common/option_table.h"

#include <stdio.h>

enum control_flags {
    CONTROL_LOGARITHMIC = 1,
    CONTROL_REOPENS = 2, ///< a change opens the scene again
    CONTROL_PASSING = 4, ///< not kept in files of settings
    CONTROL_STARTS = 8,  ///< takes effect at the next program start
    CONTROL_OF_BOTH = 64 ///< A and B share the control, though streaming depends on it
};

struct control {
    const char *group, *label;
    struct option option; ///< `value` is an offset into view_settings; see control_option
    size_t offset;
    const char *format; ///< format of the widget: "%.2f s"
    unsigned flags;
};

#define CONTROLS_MAX 80

const struct control *controls_get(uint32_t *count);
/** Finds a control by name. NULL: there is none of this name. */
const struct control *controls_find(const char *name);
/** Returns true if A and B of a comparison have a value each: streaming or sampling depends on it.
 */
bool control_is_of_sets(const struct control *control);
/** Returns the row as an option that reads and writes `settings`. */
struct option control_option(const struct control *control, struct view_settings *settings);
/** Writes headings and options, at most 2 * CONTROLS_MAX. Returns their number. given[i] becomes
 * true once the command line has control i. */
size_t controls_write_options(struct view_settings *settings, bool given[CONTROLS_MAX],
                              struct option *options);
void controls_set_defaults(struct view_settings *settings);
void control_reset(const struct control *control, struct view_settings *settings);
/** Sets a control from text. False, with a line on stderr that begins with `speaker`, for an
 * unknown name or a wrong value. */
bool controls_set(struct view_settings *settings, const char *name, const char *value,
                  const char *speaker);
/** Returns false if the budget is neither 0 nor at least 4 MiB. */
bool controls_budget_fits(const struct view_settings *settings);
#define CONTROLS_BUDGET_WANTED "wants 0, or from 4M to 1T"
/** Writes the value in the syntax of the command line. Returns `text`. */
const char *control_write(const struct control *control, const struct view_settings *settings,
                          char *text, size_t size);
bool control_is_default(const struct control *control, const struct view_settings *settings);
/** Copies the controls that are given. */
void controls_take_given(const struct view_settings *from, const bool given[CONTROLS_MAX],
                         struct view_settings *to);
/** Writes the controls that are not at their default: " --budget 64 --view 3". */
void controls_write_command(const struct view_settings *settings, char *text, size_t size);

#endif /* SLUICE_VIEW_CONTROLS_H */
