/** Lines and labels of the scene over the picture. Nothing hides them. */
#ifndef SLUICE_VIEW_OVERLAY_H
#define SLUICE_VIEW_OVERLAY_H

#include "app.h"

/** Draws the part of an edge that is in front of the camera. */
void overlay_edge(const struct view_app *app, struct vec3 from, struct vec3 to, uint32_t color);
/** Draws a short text beside a point, if the point is in front of the camera. */
void overlay_label(const struct view_app *app, struct vec3 at, const char *text);
/** Draws the frustum of a camera, from its position to a distance in parts of the scene's diagonal.
 */
void overlay_frustum(const struct view_app *app, const struct view_camera *camera, float distance,
                     uint32_t color);

#endif /* SLUICE_VIEW_OVERLAY_H */
