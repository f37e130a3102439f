/** Materials and alpha textures: what shaders need of them is made when a ray asks for it. */
#ifndef DEMAND_PBRT_SURFACES_H
#define DEMAND_PBRT_SURFACES_H

#include "pbrt_shared.h"
#include "scene.h"
#include "table.h"
#include "textures.h"

/** A picture of a surface. */
struct wanted_picture {
    const struct picture_use *use;
    uint32_t op; ///< that samples it
    SluicePbrtEncoding encoding;
    float width;               ///< texels that rays want of it
    SluiceDemandTicket ticket; ///< of what was last loaded of it
};

/** Surfaces are numbered: materials first, then textures as alpha. Zeroed is empty. */
struct surfaces {
    struct table table;  ///< struct PbrtSurface
    struct table ops;    ///< struct PbrtOp
    struct table wanted; ///< uint: 1 + log2 of the texels that rays want per unit of uv
    uint32_t material_count;
    struct wanted_picture *pictures; ///< owned; of the last call of surfaces_realize
    uint32_t picture_count, picture_room;
    uint32_t opened_count; ///< of the pictures: those that flights need not look at again
    bool says_what_it_makes;
    uint64_t material_realized_count, alpha_realized_count; ///< since the beginning
};

/** Says on stderr why it failed. */
bool surfaces_create(const struct gpu *gpu, const struct scene *scene, struct surfaces *surfaces);
void surfaces_finish(const struct gpu *gpu, struct surfaces *surfaces);

/** The surface of a texture as alpha. */
uint32_t surfaces_alpha(const struct surfaces *surfaces, uint32_t texture);

/** Forgets the pictures of earlier calls of surfaces_realize. */
void surfaces_begin(struct surfaces *surfaces);
/** Makes a surface, and lists its pictures. No launch is under way. Says on stderr why it failed.
 */
bool surfaces_realize(const struct gpu *gpu, const struct scene *scene, struct textures *textures,
                      struct surfaces *surfaces, uint32_t index);
/** After the listed pictures are open: tells programs what the formats mean. */
void surfaces_finish_pictures(struct surfaces *surfaces);

#endif /* DEMAND_PBRT_SURFACES_H */
