/* Traces a path for each pixel of the list, without the device's ray tracing. */
#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "textures.glsl"
#include "scene.glsl"
#include "bvh.glsl"
#include "path.glsl"
#include "film.glsl"

layout(local_size_x = TRACER_GROUP_SIZE) in;
layout(constant_id = TRACER_CONSTANT_SCENE_ROOT) const uint sceneRoot = 0u;

#define FAR 1.0e4

Walk startRay(Path path)
{
    return startWalk(path.origin, path.direction, FAR, path.toSun, sceneRoot);
}

/** Returns whether the ray continues. A texel that is missing counts as opaque, except in a
 * preview. */
bool passHole(inout Walk walk, inout Path path, Hit hit, Surface s)
{
    path.complete = path.complete && s.complete;
    if (s.alpha < 0.5 && (s.complete || preview))
        return true;
    takeHit(walk, hit);
    return !isOver(walk);
}

void endRay(inout Path path, Walk walk, Surface s)
{
    if (path.toSun) {
        endSunRay(path, walk.best.distance < 0.0, launch.bounces);
        return;
    }
    if (walk.best.distance < 0.0)
        s.distance = -1.0;
    else
        path.complete = path.complete && s.complete;
    meetSurface(path, s, launch.bounces);
}

void main()
{
    uint place = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * TRACER_GROUP_SIZE +
                 gl_LocalInvocationID.x;
    if (!isTraced(place))
        return;
    uint pixel = pixelAt(place);
    Path path = startPixel(pixel);
    noting = true;
    Walk walk = startRay(path);
    while (!path.done) {
        Hit hit;
        Surface s;
        bool perhaps = walkOn(walk, hit);
        if (!perhaps)
            hit = walk.best;
        if (perhaps || (hit.distance >= 0.0 && !path.toSun))
            s = surfaceAt(hit.instance, hit.triangle, hit.weights, path.direction, hit.distance,
                          path.cone);
        if (perhaps && passHole(walk, path, hit, s))
            continue;
        endRay(path, walk, s);
        walk = startRay(path);
    }
    endPixel(pixel, path);
}
