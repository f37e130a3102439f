/* Pixels of the film: which one to trace, and where to add its light. */
#ifndef PBRT_FILM_GLSL
#define PBRT_FILM_GLSL

layout(std430, set = 1, binding = PBRT_BINDING_FILM) buffer Film
{
    vec4 film[]; /* sum of a pixel's complete samples; w: their count */
};
layout(std430, set = 1, binding = PBRT_BINDING_LATEST) buffer Latest
{
    vec4 latest[]; /* last sample; w: 1 if incomplete */
};
layout(std430, set = 1, binding = PBRT_BINDING_LISTS) buffer Lists
{
    uint lists[]; /* two lists of width * height pixels: to trace, and to trace again */
};
layout(std430, set = 1, binding = PBRT_BINDING_COUNTERS) buffer Counters
{
    uint counters[2]; /* entries of the lists */
};

uint readList()
{
    return (launch.flags & PBRT_LAUNCH_LIST_ONE) != 0u ? 1u : 0u;
}

uint pixelAt(uint place)
{
    return lists[readList() * launch.width * launch.height + place];
}

/** Adds a complete sample to the film. An incomplete pixel is traced again in the next launch. */
void endPixel(uint pixel, vec3 light, bool complete)
{
    latest[pixel] = vec4(light, complete ? 0.0 : 1.0);
    if (complete) {
        film[pixel] += vec4(light, 1.0);
    } else {
        uint other = 1u - readList();
        lists[other * launch.width * launch.height + atomicAdd(counters[other], 1u)] = pixel;
    }
}

/** Sets the ray of a pixel. The first sample is the pixel's center. */
void startPixel(uint pixel, out vec3 origin, out vec3 direction)
{
    vec2 offset = fract(vec2(0.5) + float(launch.sampleIndex) * vec2(0.7548776662, 0.5698402910));
    vec2 at = (vec2(pixel % launch.width, pixel / launch.width) + offset) /
              vec2(launch.width, launch.height);
    vec3 place = toVector(launch.corner) + at.x * toVector(launch.right) + at.y * toVector(launch.down);
    origin = toVector(launch.eye);
    if ((launch.flags & PBRT_LAUNCH_ORTHOGRAPHIC) != 0u) {
        origin += place;
        direction = normalize(toVector(launch.forward));
    } else {
        direction = normalize(place);
    }
}

#endif
