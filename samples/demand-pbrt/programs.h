/** Programs for shaders that compute trees of textures: see PbrtOp. */
#ifndef DEMAND_PBRT_PROGRAMS_H
#define DEMAND_PBRT_PROGRAMS_H

#include "surfaces.h"

/** Zeroed but for the pointers begins a program. */
struct program {
    const struct gpu *gpu;
    const struct scene *scene;
    struct textures *textures;
    struct surfaces *surfaces;
    float wanted; ///< texels per unit of uv
    uint32_t first;
    uint32_t depth, count;
    bool failed; ///< too large, or memory is short
};

/** Appends the program of a value. Returns its first op. Trees that are too large become their
 *  mean. PBRT_NONE: memory is short, which stderr says. */
uint32_t program_of_value(const struct program *setting, const SluicePbrtValue *value);
/** Appends a program of a material: one of its members, or that of a mixture. */
uint32_t program_of_material(const struct program *setting, uint32_t material, size_t member);

#endif /* DEMAND_PBRT_PROGRAMS_H */
