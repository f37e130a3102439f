/* Runs if the ray hits no box. */
#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_GOOGLE_include_directive : require

#include "proxy_rays.glsl"

layout(location = 0) rayPayloadInEXT ProxyHit payload;

void main()
{
    payload.proxy = PROXY_RAY_MISS;
}
