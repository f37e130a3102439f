/** Parts of the inspector: the levels of a texture, and one of its tiles. */
#ifndef SLUICE_VIEW_INSPECTOR_PARTS_H
#define SLUICE_VIEW_INSPECTOR_PARTS_H

#include "panels.h"

/** Draws all levels side by side, with a square per tile and holes for missing tiles. */
void inspector_draw_levels(struct view_app *app, uint32_t texture);
/** Draws maps with a square per region or tile of level 0: feedback as read back, wanted, resident
 *  and missing levels, and numbers of loads. */
void inspector_draw_maps(struct view_app *app, uint32_t texture);
/** Draws the tile under the mouse, or otherwise at the inspected point, if it is on this texture.
 */
void inspector_draw_tile(const struct view_app *app, uint32_t texture);

#endif /* SLUICE_VIEW_INSPECTOR_PARTS_H */
