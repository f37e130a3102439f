/** Reads what the picture and the streamer have at a point: for the legend and the inspector. */
#ifndef SLUICE_VIEW_PROBE_H
#define SLUICE_VIEW_PROBE_H

#include "camera.h"
#include "facts.h"
#include "stage.h"

struct view_probe {
    bool known;          ///< a texture is there, and the streamer knows it
    bool of_b;           ///< values of the picture of B
    uint32_t texture;    ///< index; STAGE_NO_TEXTURE: none
    uint32_t texel[2];   ///< of level 0
    uint8_t resident;    ///< finest level that is resident there; SLUICE_MIP_UNTOUCHED: none
    uint8_t requested;   ///< that the manager is asked for; SLUICE_MIP_UNTOUCHED: none
    uint32_t tile_index; ///< of the finest tile that is resident there, or of the mip tail
    SluiceTile tile;     ///< with its slot
    SluiceTileState state;
    uint32_t loads, failures; ///< of the tile
    double age;               ///< seconds since it was loaded; below 0: unknown
    double density;           ///< texels of level 0 per pixel; 0: unknown
    double lod;               ///< that the camera asks for, if density is known
    double camera_level;      ///< the finest level that this samples; below 0: finer than the file
    SluiceVulkanExplanation why;
};

/** Looks at the point of a pick. The level of detail stays unknown. */
void probe_point(const struct stage *stage, const struct view_facts *facts,
                 const struct stage_pick *pick, struct view_probe *probe);
/** Adds the level of detail. `texels`: of stage_pick_pixel. */
void probe_pixel(const float texels[4], const struct view_settings *settings,
                 struct view_probe *probe);

#endif /* SLUICE_VIEW_PROBE_H */
