/* Which box a hit shader or an intersection shader runs for. */
#ifndef PBRT_BOXES_GLSL
#define PBRT_BOXES_GLSL

/** Boxes are in structures of PBRT_PART_BOXES each. */
uint boxIndex()
{
    return uint(gl_InstanceCustomIndexEXT) * PBRT_PART_BOXES + uint(gl_PrimitiveID);
}

#endif
