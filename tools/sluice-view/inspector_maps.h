/** Data of a texture that the inspector draws: states of tiles, and maps with one value per tile of
 *  level 0. */
#ifndef SLUICE_VIEW_INSPECTOR_MAPS_H
#define SLUICE_VIEW_INSPECTOR_MAPS_H

#include "facts.h"
#include "stage.h"

struct inspector_maps {
    SluiceTextureId id; ///< texture of the maps
    bool known;
    double next; ///< seconds of the next update
    SluiceStreamedTextureLayout layout;
    uint8_t *states;    ///< owned; SluiceTileState by tile
    uint8_t *resident;  ///< points into `states`; levels, in rows of minMipWidth
    uint8_t *requested; ///< points into `states`; levels, in rows of minMipWidth
    bool feedback_known;
    SluiceStreamedTextureLayout feedback_layout; ///< layout of the texture that writes feedback
    uint8_t *feedback; ///< owned; levels that shaders marked, in rows of feedbackWidth
};

/** Updates the maps: 10 times per second, at once for another texture, and in each frame of a
 *  recording. `seconds`: time since the viewer began. False if the texture cannot be read. */
bool inspector_maps_update(struct inspector_maps *maps, const struct stage *stage, uint32_t texture,
                           double seconds);
/** Frees the maps. A zeroed struct is allowed. */
void inspector_maps_finish(struct inspector_maps *maps);

#endif /* SLUICE_VIEW_INSPECTOR_MAPS_H */
