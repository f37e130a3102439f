/* What the stages of the ray-tracing pipeline tell each other. */
#ifndef TRACER_RAYS_GLSL
#define TRACER_RAYS_GLSL

#include "textures.glsl"
#include "scene.glsl"

struct Payload {
    Surface surface;    /* `complete` also says so of holes on the way */
    SluiceRayCone cone; /* of the ray */
    bool noting;        /* see notes.glsl */
};

#endif
