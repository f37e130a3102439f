/** Programs with which shaders compute trees of textures: see PbrtOp. */
#ifndef DEMAND_PBRT_PROGRAMS_H
#define DEMAND_PBRT_PROGRAMS_H

#include "surfaces.h"

/** Zeroed, except the pointers, is an empty program. */
struct program {
    const struct gpu *gpu;
    const struct scene *scene;
    struct textures *textures;
    struct surfaces *surfaces;
    float wanted; ///< texels per unit of uv
    uint32_t first;
    uint32_t depth, count;
    bool failed; ///< too large, or out of memory
};

/** Appends the program of a value. Returns its first op. Replaces trees that are too large by their
 * mean. Reports on stderr when out of memory and returns PBRT_NONE. */
uint32_t program_of_value(const struct program *setting, const SluicePbrtValue *value);
/** Appends the program of a material: of one of its members, or of a mixture. */
uint32_t program_of_material(const struct program *setting, uint32_t material, size_t member);

#endif /* DEMAND_PBRT_PROGRAMS_H */
