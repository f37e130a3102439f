/* Which pixel is traced, and where its light goes. */
#ifndef TRACER_FILM_GLSL
#define TRACER_FILM_GLSL

layout(std430, set = 1, binding = TRACER_BINDING_FILM) buffer Film
{
    vec4 film[]; /* the sum of a pixel's complete samples, and how many they are */
};
layout(std430, set = 1, binding = TRACER_BINDING_LATEST) buffer Latest
{
    vec4 latest[]; /* the last sample, complete or not; w: 1 if it is not */
};
layout(std430, set = 1, binding = TRACER_BINDING_LISTS) buffer Lists
{
    uint lists[]; /* two of width * height pixels each: those to trace, those to trace again */
};
layout(std430, set = 1, binding = TRACER_BINDING_COUNTERS) buffer Counters
{
    uint counters[2]; /* entries of the lists */
};

layout(push_constant) uniform Launch
{
    TracerLaunch launch;
};

void tracePixel(uint place)
{
    if (place >= launch.count)
        return;
    uint pixelCount = launch.width * launch.height;
    uint pixel = lists[launch.listIndex * pixelCount + place];
    Random random = Random(pixel ^ launch.seed * 0x85ebca77u, launch.sampleIndex, 0u);
    vec2 at = vec2(pixel % launch.width, pixel / launch.width) + random2(random);
    at = at / vec2(launch.width, launch.height) * 2.0 - 1.0;
    vec3 right = vec3(launch.right[0], launch.right[1], launch.right[2]);
    vec3 up = vec3(launch.up[0], launch.up[1], launch.up[2]);
    vec3 forward = vec3(launch.forward[0], launch.forward[1], launch.forward[2]);
    vec3 direction = normalize(forward + at.x * right - at.y * up);

    bool complete = true;
    vec3 light = tracePath(vec3(launch.eye[0], launch.eye[1], launch.eye[2]), direction,
                           Cone(0.0, launch.spread), launch.bounces, random, complete);
    latest[pixel] = vec4(light, complete ? 0.0 : 1.0);
    if (complete) {
        film[pixel] += vec4(light, 1.0);
    } else {
        uint other = 1u - launch.listIndex;
        lists[other * pixelCount + atomicAdd(counters[other], 1u)] = pixel;
    }
}

#endif
