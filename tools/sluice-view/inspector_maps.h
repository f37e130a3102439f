/** What the inspector draws of a texture: states of its tiles, and maps of squares per tile of
 *  level 0. */
#ifndef SLUICE_VIEW_INSPECTOR_MAPS_H
#define SLUICE_VIEW_INSPECTOR_MAPS_H

#include "facts.h"
#include "stage.h"

struct inspector_maps {
    SluiceTextureId id; ///< whose they are
    bool known;
    double next; ///< seconds when they are looked at again
    SluiceStreamedTextureLayout layout;
    uint8_t *states;    ///< owned; SluiceTileState by tile
    uint8_t *resident;  ///< in `states`; levels, rows of minMipWidth
    uint8_t *requested; ///< likewise
    bool feedback_known;
    SluiceStreamedTextureLayout feedback_layout; ///< of the texture that has feedback
    uint8_t *feedback; ///< owned; levels that shaders marked, rows of feedbackWidth
};

/** Looks at a texture 10 times per second, or at once at another one. A recording is looked
 *  at in each frame. False if it cannot be looked
 *  at. `seconds`: of the viewer's life. */
bool inspector_maps_update(struct inspector_maps *maps, const struct stage *stage, uint32_t texture,
                           double seconds);
/** A zeroed struct is fine. */
void inspector_maps_finish(struct inspector_maps *maps);

#endif /* SLUICE_VIEW_INSPECTOR_MAPS_H */
