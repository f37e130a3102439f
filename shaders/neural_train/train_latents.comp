/* A step of Adam for all latents, and the latents that the next step samples. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "train_layout.glsl"

layout(local_size_x = 128) in;

layout(set = 0, binding = 2) writeonly buffer Latents { uint latents[]; };
layout(set = 0, binding = 3) buffer State { vec2 state[]; }; /* values, then both moments */
layout(set = 0, binding = 4) buffer Gradients { ivec2 gradients[]; };

/* In codes of 0 to 15. */
float effective(float value, uint at)
{
    float code = value * 15.0;
    if ((push.nextFlags & TRAIN_EXACT_LATENTS) != 0u)
        return code;
    if ((push.nextFlags & TRAIN_ROUND_LATENTS) != 0u)
        return roundEven(code);
    /* Noise of one code stands for rounding. */
    return clamp(code + unit_float(hash3(at, push.step, push.seed)) - 0.5, 0.0, 15.0);
}

void main()
{
    uint pairs = push.latentCount / 2u;
    uint at = gl_WorkGroupID.y * 65535u * 128u + gl_GlobalInvocationID.x;
    if (at >= pairs)
        return;
    vec2 value = state[at];
    if (has_flag(TRAIN_UPDATE)) {
        vec2 gradient = vec2(gradients[at]) / push.latentUnit;
        vec2 m = mix(gradient, state[pairs + at], push.decay1);
        vec2 v = mix(gradient * gradient, state[2u * pairs + at], push.decay2);
        value = clamp(value - push.latentRate * m / (sqrt(v) + 1e-8), 0.0, 1.0);
        state[at] = value;
        state[pairs + at] = m;
        state[2u * pairs + at] = v;
        gradients[at] = ivec2(0);
    }
    latents[at] = packHalf2x16(vec2(effective(value.x, 2u * at), effective(value.y, 2u * at + 1u)));
}
