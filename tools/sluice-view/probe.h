/** Values of picture and streamer at a point, for the legend and the inspector. */
#ifndef SLUICE_VIEW_PROBE_H
#define SLUICE_VIEW_PROBE_H

#include "camera.h"
#include "facts.h"
#include "stage.h"

struct view_probe {
    bool known;          ///< the point has a texture, and the streamer knows it
    bool of_b;           ///< the values belong to the picture of B
    uint32_t texture;    ///< index; STAGE_NO_TEXTURE: none
    uint32_t texel[2];   ///< texel of level 0
    uint8_t resident;    ///< finest resident level at the point; SLUICE_MIP_UNTOUCHED: none
    uint8_t requested;   ///< finest requested level; SLUICE_MIP_UNTOUCHED: none
    uint32_t tile_index; ///< index of the finest resident tile at the point, or of the mip tail
    SluiceTile tile;     ///< this tile, with its slot
    SluiceTileState state;
    uint32_t loads, failures; ///< loads and failed loads of the tile
    double age;               ///< seconds since it was loaded; below 0: unknown
    double density;           ///< texels of level 0 per pixel; 0: unknown
    double lod;          ///< level of detail that the camera requests; valid if `density` is known
    double camera_level; ///< finest level that `lod` samples; below 0: finer than the file
    SluiceVulkanExplanation why;
};

/** Reads the values at a pick. The level of detail stays unknown. */
void probe_point(const struct stage *stage, const struct view_facts *facts,
                 const struct stage_pick *pick, struct view_probe *probe);
/** Adds the level of detail. `texels`: from stage_pick_pixel. */
void probe_pixel(const float texels[4], const struct view_settings *settings,
                 struct view_probe *probe);

#endif /* SLUICE_VIEW_PROBE_H */
