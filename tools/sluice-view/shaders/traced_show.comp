/* Develops the film of a traced scene as demand-pbrt writes its PNG files. */
#version 460

layout(local_size_x = 8, local_size_y = 8) in;

layout(std430, set = 0, binding = 0) readonly buffer Sums
{
    vec4 sums[]; /* of complete samples, and how many they are */
};
layout(std430, set = 0, binding = 1) readonly buffer Latest
{
    vec4 latest[]; /* the last sample; w: 1 if something was missing */
};
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D picture;

layout(push_constant) uniform Push
{
    uint width, height;
    float scale, tint;
    uint marks; /* 1: view 3 */
}
push;

vec3 encode(vec3 x)
{
    return mix(12.92 * x, 1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
}

/* Infinite and undefined numbers would spread in the window's filter. */
float clean(float x)
{
    return isnan(x) ? 0.0 : clamp(x, 0.0, 1.0);
}

void main()
{
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= push.width || at.y >= push.height)
        return;
    uint pixel = at.y * push.width + at.x;
    vec3 light = sums[pixel].w > 0.0 ? sums[pixel].rgb / sums[pixel].w : latest[pixel].rgb;
    light *= push.scale;
    vec3 color = encode(vec3(clean(light.r), clean(light.g), clean(light.b)));
    if (push.marks != 0u) {
        float gray = dot(color, vec3(0.299, 0.587, 0.114));
        color = mix(color, vec3(gray), push.tint);
        if (latest[pixel].w > 0.0)
            color = mix(color, vec3(240.0, 228.0, 66.0) / 255.0, push.tint);
    }
    imageStore(picture, ivec2(at), vec4(color, 1.0));
}
