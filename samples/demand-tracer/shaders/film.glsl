/* Pixels of the film: which one to trace, and where to add its light. */
#ifndef TRACER_FILM_GLSL
#define TRACER_FILM_GLSL

layout(std430, set = 1, binding = TRACER_BINDING_FILM) buffer Film
{
    vec4 film[]; /* sum of a pixel's complete samples; w: their count */
};
layout(std430, set = 1, binding = TRACER_BINDING_LATEST) buffer Latest
{
    vec4 latest[]; /* last sample; w: 1 if incomplete */
};
layout(std430, set = 1, binding = TRACER_BINDING_LISTS) buffer Lists
{
    uint lists[]; /* two lists of width * height pixels: to trace, and to trace again */
};
layout(std430, set = 1, binding = TRACER_BINDING_COUNTERS) buffer Counters
{
    uint counters[2]; /* entries of the lists */
};

layout(push_constant) uniform Launch
{
    TracerLaunch launch;
};

bool isTraced(uint place)
{
    return place < launch.count;
}

uint pixelAt(uint place)
{
    return lists[launch.listIndex * launch.width * launch.height + place];
}

/** Starts a path at the camera, through a point of the pixel that differs per sample. */
Path startPixel(uint pixel)
{
    Random random = Random(pixel ^ launch.seed * 0x85ebca77u, launch.sampleIndex, 0u);
    vec2 at = vec2(pixel % launch.width, pixel / launch.width) + random2(random);
    at = at / vec2(launch.width, launch.height) * 2.0 - 1.0;
    vec3 right = vec3(launch.right[0], launch.right[1], launch.right[2]);
    vec3 up = vec3(launch.up[0], launch.up[1], launch.up[2]);
    vec3 forward = vec3(launch.forward[0], launch.forward[1], launch.forward[2]);
    return startPath(vec3(launch.eye[0], launch.eye[1], launch.eye[2]),
                     normalize(forward + at.x * right - at.y * up), launch.spread, random);
}

/** Adds a complete sample to the film. An incomplete pixel is traced again in the next launch. */
void endPixel(uint pixel, Path path)
{
    latest[pixel] = vec4(path.light, path.complete ? 0.0 : 1.0);
    if (path.complete) {
        film[pixel] += vec4(path.light, 1.0);
    } else {
        uint other = 1u - launch.listIndex;
        lists[other * launch.width * launch.height + atomicAdd(counters[other], 1u)] = pixel;
    }
}

#endif
