/* Payload that the stages of the ray-tracing pipeline exchange. */
#ifndef TRACER_RAYS_GLSL
#define TRACER_RAYS_GLSL

#include "textures.glsl"
#include "scene.glsl"

struct Payload {
    Surface surface;    /* `complete` also covers holes on the ray's way */
    SluiceRayCone cone; /* cone of the ray */
    bool noting;        /* see notes.glsl */
};

#endif
