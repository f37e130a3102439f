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
    uint32_t op; ///< that samples it; PBRT_NONE: its surface has left
    SluicePbrtEncoding encoding;
    float width;               ///< texels that rays want of it
    SluiceDemandTicket ticket; ///< of what was last loaded of it
};

/** A surface that is made. */
struct made_surface {
    uint32_t index;
    uint32_t first_op, op_count;
    uint32_t made_at; ///< launch
    uint32_t used_at; ///< last launch that made it or hit it, as far as it was looked up
    bool leaves;      ///< is being evicted
};

/** Surfaces are numbered: materials first, then textures as alpha. Zeroed is empty. */
struct surfaces {
    struct table table;  ///< struct PbrtSurface
    struct table ops;    ///< struct PbrtOp
    struct table wanted; ///< uint: 1 + log2 of the texels that rays want per unit of uv
    uint32_t material_count;
    struct made_surface *made; ///< owned; in the order of their ops, which have no gaps
    uint32_t made_count;
    uint64_t budget;                 ///< bytes of ops; 0: no limit
    struct wanted_picture *pictures; ///< owned; of the last call of surfaces_realize
    uint32_t picture_count, picture_room;
    uint32_t opened_count; ///< of the pictures: those that flights need not look at again
    bool says_what_it_makes;
    uint64_t material_realized_count, alpha_realized_count; ///< since the beginning
    uint64_t evicted_count;                                 ///< ... of both
};

/** Says on stderr why it failed. */
bool surfaces_create(const struct gpu *gpu, const struct scene *scene, struct surfaces *surfaces);
void surfaces_finish(const struct gpu *gpu, struct surfaces *surfaces);

/** The surface of a texture as alpha. */
uint32_t surfaces_alpha(const struct surfaces *surfaces, uint32_t texture);

/** Forgets the pictures of earlier calls of surfaces_realize. */
void surfaces_begin(struct surfaces *surfaces);
/** Makes a surface for a launch, and lists its pictures. No launch is under way. Says on stderr why
 *  it failed. */
bool surfaces_realize(const struct gpu *gpu, const struct scene *scene, struct textures *textures,
                      struct surfaces *surfaces, uint32_t index, uint32_t launch);
/** Device memory of all surfaces that are made. */
uint64_t surfaces_size(const struct surfaces *surfaces);
/** Evicts those that are marked to leave, and closes the gaps between the ops of the others. No
 *  launch is under way. */
void surfaces_evict(struct surfaces *surfaces);
/** After the listed pictures are open: tells programs what the formats mean. */
void surfaces_finish_pictures(struct surfaces *surfaces);

#endif /* DEMAND_PBRT_SURFACES_H */
