/**
 * The table of all controls. A row makes the option, the widget with its hint, the line in the file
 * of settings, the event `set` of scripts, and the part of "copy command line".
 */
#ifndef SLUICE_VIEW_CONTROLS_H
#define SLUICE_VIEW_CONTROLS_H

#include "settings.h"

#include "../common/option_table.h"

#include <stdio.h>

enum control_flags {
    CONTROL_LOGARITHMIC = 1,
    CONTROL_REOPENS = 2, ///< the scene is opened again when it changes
    CONTROL_PASSING = 4, ///< not kept in files of settings
    CONTROL_STARTS = 8,  ///< takes effect when the program begins
    CONTROL_OF_BOTH = 64 ///< A and B of a comparison share it, though streaming depends on it
};

struct control {
    const char *group, *label;
    struct option option; ///< `value` is an offset into view_settings; see control_option
    size_t offset;
    const char *format; ///< of the widget: "%.2f s"
    unsigned flags;
};

#define CONTROLS_MAX 80

const struct control *controls_get(uint32_t *count);
/** NULL: there is none of this name. */
const struct control *controls_find(const char *name);
/** Whether streaming or sampling depends on it: A and B of a comparison have one each. */
bool control_is_of_sets(const struct control *control);
/** The row as an option over these settings. */
struct option control_option(const struct control *control, struct view_settings *settings);
/** Writes headings and options. Returns how many; there is room for 2 * CONTROLS_MAX. */
size_t controls_write_options(struct view_settings *settings, struct option *options);
void controls_set_defaults(struct view_settings *settings);
void control_reset(const struct control *control, struct view_settings *settings);
/** False, with a line on stderr behind `speaker`, for an unknown name or a wrong value. */
bool controls_set(struct view_settings *settings, const char *name, const char *value,
                  const char *speaker);
/** False if the budget is neither 0 nor at least 4 MiB. */
bool controls_budget_fits(const struct view_settings *settings);
#define CONTROLS_BUDGET_WANTED "wants 0, or from 4M to 1T"
/** The value as a user would write it. Returns `text`. */
const char *control_write(const struct control *control, const struct view_settings *settings,
                          char *text, size_t size);
bool control_is_default(const struct control *control, const struct view_settings *settings);
/** Takes over what is not the default in `from`. */
void controls_take_changes(const struct view_settings *from, struct view_settings *to);
/** " --budget 64 --view 3": what is not the default. */
void controls_write_command(const struct view_settings *settings, char *text, size_t size);

#endif /* SLUICE_VIEW_CONTROLS_H */
