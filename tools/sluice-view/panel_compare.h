/** A and B of a comparison: names, figures beside each other, and the set that is edited. */
#ifndef SLUICE_VIEW_PANEL_COMPARE_H
#define SLUICE_VIEW_PANEL_COMPARE_H

#include "app.h"

/** "B: feedback off". Returns `text`. */
const char *panel_compare_name(const struct view_app *app, char *text, size_t size);
/** Figures of A and B, in the legend. */
void panel_compare_figures(const struct view_app *app);
/** Buttons that choose which set the controls edit, and presets of B. */
void panel_compare_choose(struct view_app *app);

/** A set while controls edit it. */
struct panel_compare_set {
    bool is_b, has_facts;
    struct view_settings a, before; ///< of B: A's, and those of B at first
};

/** Puts the set that is edited into app->settings, and what is known of it into app->facts. B shows
 *  what it is drawn with, and follows A no longer once a control has changed it. */
void panel_compare_begin_set(struct view_app *app, struct panel_compare_set *set);
void panel_compare_end_set(struct view_app *app, const struct panel_compare_set *set);

#endif /* SLUICE_VIEW_PANEL_COMPARE_H */
