/** Parts of the inspector: the levels of a texture, and one of its tiles. */
#ifndef SLUICE_VIEW_INSPECTOR_PARTS_H
#define SLUICE_VIEW_INSPECTOR_PARTS_H

#include "panels.h"

/** All levels side by side, a square per tile, with holes where nothing is resident. */
void inspector_draw_levels(struct view_app *app, uint32_t texture);
/** Feedback as it was read back, wanted and resident levels, missing ones, and how often tiles were
 *  loaded: maps of squares per region or tile of level 0. */
void inspector_draw_maps(struct view_app *app, uint32_t texture);
/** The tile under the mouse, or else at the point that was inspected, if it is of this texture. */
void inspector_draw_tile(const struct view_app *app, uint32_t texture);

#endif /* SLUICE_VIEW_INSPECTOR_PARTS_H */
