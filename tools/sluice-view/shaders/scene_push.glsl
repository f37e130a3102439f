// Push constants of a draw: values of the frame, and the material. 112 bytes; same struct as in stage_draw.c.
layout(push_constant) uniform Push
{
    mat4 viewProjection;
    vec3 eye;
    uint material;
    uint view; // settings.h
    uint seed;
    float probability; // 0: no feedback
    float lodBias, anisotropy, tint;
    uint flags; // below
} push;

const uint FLAG_BORDERS = 1, FLAG_NUMBERS = 2, FLAG_NEAREST = 4, FLAG_NO_ALPHA_TEST = 8, FLAG_NO_SETS = 16;
// Pixels that write feedback: settings.h, enum view_feedback_by.
const uint FEEDBACK_BY_SHIFT = 8, FEEDBACK_BY_MASK = 3;
const uint BY_QUADS = 0, BY_LATTICE = 1, BY_EVERY_PIXEL = 2, BY_TURNS = 3;

// The finest level that may be sampled or requested.
const uint FINEST_SHIFT = 12, FINEST_MASK = 15;

uint feedbackBy()
{
    return push.flags >> FEEDBACK_BY_SHIFT & FEEDBACK_BY_MASK;
}
