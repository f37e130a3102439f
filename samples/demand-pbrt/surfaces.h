/** Materials and alpha textures. Their shader data is made when a ray requests it. */
#ifndef DEMAND_PBRT_SURFACES_H
#define DEMAND_PBRT_SURFACES_H

#include "pbrt_shared.h"
#include "scene.h"
#include "table.h"
#include "textures.h"

/** A picture of a surface. */
struct wanted_picture {
    const struct picture_use *use;
    uint32_t op; ///< index of the op that samples it; PBRT_NONE: its surface was evicted
    SluicePbrtEncoding encoding;
    float width;               ///< texels per unit of uv that rays request
    SluiceDemandTicket ticket; ///< ticket of the picture's last load
};

/** A surface that is made. */
struct made_surface {
    uint32_t index;
    uint32_t first_op, op_count;
    uint32_t made_at; ///< launch that made it
    uint32_t used_at; ///< last launch known to have made or hit it
    bool leaves;      ///< true: being evicted
};

/** Surfaces are numbered: materials first, then alpha textures. A zeroed struct is empty. */
struct surfaces {
    struct table table;  ///< struct PbrtSurface
    struct table ops;    ///< struct PbrtOp
    struct table wanted; ///< uint: 1 + log2 of the requested texels per unit of uv
    uint32_t material_count;
    struct made_surface *made; ///< owned; in the order of their ops, which have no gaps
    uint32_t made_count;
    uint64_t budget;                 ///< bytes of ops; 0: no limit
    struct wanted_picture *pictures; ///< owned; pictures since surfaces_begin
    uint32_t picture_count, picture_room;
    uint32_t opened_count; ///< number of leading `pictures` that are open, which flights skip
    bool says_what_it_makes;
    uint64_t material_realized_count, alpha_realized_count; ///< since the beginning
    uint64_t evicted_count; ///< evicted materials and alpha textures
};

/** Reports errors on stderr. */
bool surfaces_create(const struct gpu *gpu, const struct scene *scene, struct surfaces *surfaces);
void surfaces_finish(const struct gpu *gpu, struct surfaces *surfaces);

/** Returns the surface of an alpha texture. */
uint32_t surfaces_alpha(const struct surfaces *surfaces, uint32_t texture);

/** Clears the list of pictures. */
void surfaces_begin(struct surfaces *surfaces);
/** Makes a surface for a launch, and lists its pictures. Call only while no launch is running.
 * Reports errors on stderr. */
bool surfaces_realize(const struct gpu *gpu, const struct scene *scene, struct textures *textures,
                      struct surfaces *surfaces, uint32_t index, uint32_t launch);
/** Device memory of all made surfaces in bytes. */
uint64_t surfaces_size(const struct surfaces *surfaces);
/** Evicts surfaces marked for eviction, and closes the gaps between the remaining ops. Call only
 * while no launch is running. */
void surfaces_evict(struct surfaces *surfaces);
/** Call after the listed pictures are open. Applies their formats to the ops. */
void surfaces_finish_pictures(struct surfaces *surfaces);

#endif /* DEMAND_PBRT_SURFACES_H */
