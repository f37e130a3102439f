/** A and B of a comparison: names, figures side by side, and the set that is edited. */
#ifndef SLUICE_VIEW_PANEL_COMPARE_H
#define SLUICE_VIEW_PANEL_COMPARE_H

#include "app.h"

/** Writes the name of the second set: "B: feedback off". Returns `text`. */
const char *panel_compare_name(const struct view_app *app, char *text, size_t size);
/** Draws the figures of A and B in the legend. */
void panel_compare_figures(const struct view_app *app);
/** Draws buttons for the set that the controls edit, and for presets of B. */
void panel_compare_choose(struct view_app *app);

/** A set while controls edit it. */
struct panel_compare_set {
    bool is_b, has_facts;
    struct view_settings a, before; ///< if `is_b`: settings of A, and of B before the edit
};

/** Puts the edited set into app->settings and its facts into app->facts. B shows the settings that
 *  it is drawn with. B stops following A once a control has changed it. */
void panel_compare_begin_set(struct view_app *app, struct panel_compare_set *set);
void panel_compare_end_set(struct view_app *app, const struct panel_compare_set *set);

#endif /* SLUICE_VIEW_PANEL_COMPARE_H */
