/* A path for each pixel of the list, without ray tracing of the device. */
#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_GOOGLE_include_directive : require

#include "textures.glsl"
#include "scene.glsl"
#include "bvh.glsl"

layout(local_size_x = TRACER_GROUP_SIZE) in;
layout(constant_id = TRACER_CONSTANT_SCENE_ROOT) const uint sceneRoot = 0u;

#define FAR 1.0e4

Ray rayFrom(vec3 origin, vec3 direction, Cone cone, bool any)
{
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.cone = cone;
    ray.far = FAR;
    ray.any = any;
    ray.hit = false;
    ray.complete = true;
    return ray;
}

Surface traceNearest(vec3 origin, vec3 direction, Cone cone)
{
    Ray ray = rayFrom(origin, direction, cone, false);
    hitScene(ray, sceneRoot);
    Surface s;
    s.distance = -1.0;
    if (ray.hit)
        s = surfaceAt(ray.instance, ray.triangle, ray.weights, direction, ray.far, cone);
    s.complete = ray.complete && (!ray.hit || s.complete);
    return s;
}

bool traceSun(vec3 origin, vec3 direction, Cone cone, inout bool complete)
{
    Ray ray = rayFrom(origin, direction, cone, true);
    hitScene(ray, sceneRoot);
    complete = complete && ray.complete;
    return !ray.hit;
}

#include "path.glsl"
#include "film.glsl"

void main()
{
    tracePixel((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * TRACER_GROUP_SIZE +
               gl_LocalInvocationID.x);
}
