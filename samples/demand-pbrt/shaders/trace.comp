/* Traces a ray or path for each pixel of the list, without the device's ray tracing. */
#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_GOOGLE_include_directive : require

bool quiet;
#define SLUICE_DEMAND_QUIET quiet

#include "demand.glsl"
#include "scene.glsl"
#include "hit.glsl"
#include "programs.glsl"
#include "alpha.glsl"
#include "sky.glsl"
#include "film.glsl"
#include "lamps.glsl"
#include "path.glsl"
#include "box.glsl"
#include "walk.glsl"

layout(local_size_x = PBRT_GROUP_SIZE) in;

Payload payload;

#include "surface.glsl"
#include "pixel.glsl"

bool isQuietLaunch()
{
    return (launch.flags & PBRT_LAUNCH_QUIET) != 0u;
}

mat4x3 columns(float m[12])
{
    return mat4x3(m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10], m[3], m[7], m[11]);
}

/** Builds the meeting of a spot. The inverse is right for directions only. */
Meeting meetingAt(Walk walk, Spot spot)
{
    float n[9] = instances[spot.place].toObject;
    return Meeting(spot.place, spot.triangle, spot.weights, spot.distance, walk.worldOrigin,
                   walk.worldDirection, columns(instances[spot.place].toWorld),
                   mat4x3(n[0], n[3], n[6], n[1], n[4], n[7], n[2], n[5], n[8], 0.0, 0.0, 0.0));
}

/** Evaluates candidates that may be holes on the way, then the nearest hit. */
void trace(Path path)
{
    Walk walk = startWalk(path.origin, path.direction, path.far);
    payload.distance = -1.0;
    for (bool goesOn = true; goesOn;) {
        Spot spot;
        goesOn = walkOn(walk, spot);
        if (spot.place == PBRT_NONE)
            continue;
        if (spot.triangle == PBRT_NONE) {
            meetBox(payload, spot.place, spot.distance, spot.face);
            continue;
        }
        quiet = goesOn || isQuietLaunch();
        bool isHole = meetTriangle(meetingAt(walk, spot), goesOn);
        quiet = isQuietLaunch();
        if (!goesOn)
            payload.triangle = triangleInFile(spot);
        else if (!isHole)
            walk.best = spot;
    }
}

void main()
{
    uint place = gl_WorkGroupID.y * PBRT_ROW_WIDTH + gl_WorkGroupID.x * PBRT_GROUP_SIZE +
                 gl_LocalInvocationID.x;
    quiet = isQuietLaunch();
    if (place < launch.count)
        tracePixel(place);
}
