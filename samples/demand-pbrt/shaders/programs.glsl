/* Programs that compute trees of textures: see PbrtOp. Include demand.glsl before. */
#ifndef PBRT_PROGRAMS_GLSL
#define PBRT_PROGRAMS_GLSL

#define PI 3.14159265358979

vec3 applyRows(float m[12], vec3 p, float w)
{
    return vec3(dot(vec4(m[0], m[1], m[2], m[3]), vec4(p, w)),
                dot(vec4(m[4], m[5], m[6], m[7]), vec4(p, w)),
                dot(vec4(m[8], m[9], m[10], m[11]), vec4(p, w)));
}

/** Returns texture coordinates of a point, for mappings that depend on its position. */
vec2 mapPoint(uint at, uint mapping, vec3 world)
{
    vec2 delta = vec2(ops[at].delta[0], ops[at].delta[1]);
    vec3 p = applyRows(ops[at].worldToTexture, world, 1.0);
    if (mapping == 1u) /* planar */
        return vec2(dot(p, vec3(ops[at].axes[0], ops[at].axes[1], ops[at].axes[2])),
                    dot(p, vec3(ops[at].axes[3], ops[at].axes[4], ops[at].axes[5]))) + delta;
    float turn = atan(p.y, p.x);
    turn = (turn < 0.0 ? turn + 2.0 * PI : turn) / (2.0 * PI);
    if (mapping == 2u) { /* spherical */
        float height = clamp(p.z / max(length(p), 1.0e-30), -1.0, 1.0);
        return vec2(acos(height) / PI, turn);
    }
    return vec2(turn, p.z); /* cylindrical */
}

/** Wraps a step around the texture to the shorter way. */
vec2 unwrap(vec2 step)
{
    return step - vec2(step.x > 0.5 ? 1.0 : step.x < -0.5 ? -1.0 : 0.0,
                       step.y > 0.5 ? 1.0 : step.y < -0.5 ? -1.0 : 0.0);
}

/** Returns texture coordinates, and the steps in them to the neighboring pixels. */
vec2 mapHit(uint at, Hit hit, out vec2 dx, out vec2 dy)
{
    uint mapping = ops[at].flags >> PBRT_OP_MAPPING_SHIFT;
    if (mapping == 0u) {
        vec2 scale = vec2(ops[at].scale[0], ops[at].scale[1]);
        dx = scale * hit.dx;
        dy = scale * hit.dy;
        return scale * hit.uv + vec2(ops[at].delta[0], ops[at].delta[1]);
    }
    vec2 st = mapPoint(at, mapping, hit.position);
    dx = mapPoint(at, mapping, hit.position + hit.px) - st;
    dy = mapPoint(at, mapping, hit.position + hit.py) - st;
    if (mapping != 1u) {
        dx = unwrap(dx);
        dy = unwrap(dy);
    }
    return st;
}

vec3 decodeSrgb(vec3 x)
{
    return mix(x / 12.92, pow((max(x, vec3(0.0)) + 0.055) / 1.055, vec3(2.4)),
               greaterThan(x, vec3(0.04045)));
}

vec3 encodeSrgb(vec3 x)
{
    return mix(x * 12.92, 1.055 * pow(max(x, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055,
               greaterThan(x, vec3(0.0031308)));
}

/** Converts a texel's color as the op wants it. */
vec4 readTexel(uint at, vec4 color)
{
    uint flags = ops[at].flags;
    uint components = bitfieldExtract(SLUICE_DEMAND_TEXTURE(ops[at].texture).shape,
                                      SLUICE_DEMAND_COMPONENTS_SHIFT, 3);
    if (components == 1u)
        color = vec4(color.rrr, 1.0);
    if (any(isnan(color)) || any(isinf(color)))
        color = vec4(0.0, 0.0, 0.0, 1.0); /* files may contain NaN and infinity */
    if ((flags & PBRT_OP_DECODE) != 0u)
        color.rgb = decodeSrgb(color.rgb);
    if ((flags & PBRT_OP_ENCODE) != 0u)
        color.rgb = encodeSrgb(color.rgb);
    if (ops[at].gamma > 0.0)
        color.rgb = pow(max(color.rgb, vec3(0.0)), vec3(ops[at].gamma));
    if ((flags & PBRT_OP_INVERT) != 0u)
        color.rgb = 1.0 - color.rgb;
    color.rgb *= ops[at].factor;
    if ((flags & PBRT_OP_FLOAT) != 0u) {
        /* pbrt-v4 uses alpha if the picture has it, else the mean of the channels. */
        float value = dot(color.rgb, vec3(0.212671, 0.715160, 0.072169));
        if ((launch.flags & PBRT_LAUNCH_VERSION_4) != 0u)
            value = (flags & PBRT_OP_HAS_ALPHA) != 0u ? color.a * ops[at].factor
                                                      : (color.r + color.g + color.b) / 3.0;
        color.rgb = vec3(value);
    }
    return color;
}

/** Pixel whose probe the next sampled picture writes, or PBRT_NONE. */
uint probedPixel = PBRT_NONE;

void writeProbe(uint texture, vec2 uv, vec2 dx, vec2 dy)
{
    if (!preview || probedPixel == PBRT_NONE)
        return;
    probes[probedPixel].texture = texture;
    for (int i = 0; i < 2; i++) {
        probes[probedPixel].uv[i] = uv[i];
        probes[probedPixel].dx[i] = dx[i];
        probes[probedPixel].dy[i] = dy[i];
    }
    probedPixel = PBRT_NONE;
}

/** Runs a program. Sets `resident` to false if texels of a picture are missing. */
vec3 runProgram(uint at, Hit hit, inout bool resident)
{
    vec3 stack[PBRT_STACK];
    uint height = 0u;
    if (at == PBRT_NONE)
        return vec3(0.0);
    for (uint op = ops[at].op; op != PBRT_OP_END; op = ops[at].op) {
        uint next = at + 1u;
        if (op == PBRT_OP_CONSTANT) {
            stack[height++] = vec3(ops[at].value[0], ops[at].value[1], ops[at].value[2]);
        } else if (op == PBRT_OP_IMAGE) {
            vec2 dx, dy, st = mapHit(at, hit, dx, dy);
            bool here;
            st.y = 1.0 - st.y; /* row 0 of a picture is on top */
            dx *= exp2(launch.lodBias) * vec2(1.0, -1.0);
            dy *= exp2(launch.lodBias) * vec2(1.0, -1.0);
            writeProbe(ops[at].texture, st, dx, dy);
            vec4 color = sluiceDemandGrad(ops[at].texture, st, dx, dy, here);
            resident = resident && here;
            if (preview && !here && color == vec4(0.0))
                color = vec4(vec3(0.5), 1.0); /* the picture is not open */
            stack[height++] = readTexel(at, color).rgb;
        } else if (op == PBRT_OP_SCALE) {
            height--;
            stack[height - 1u] *= stack[height];
        } else if (op == PBRT_OP_MIX) {
            height -= 2u;
            stack[height - 1u] = mix(stack[height - 1u], stack[height], stack[height + 1u]);
        } else if (op == PBRT_OP_CHECKER) {
            vec2 dx, dy, field = floor(mapHit(at, hit, dx, dy));
            if (mod(field.x + field.y, 2.0) >= 1.0)
                next = ops[at].target;
        } else { /* PBRT_OP_JUMP */
            next = ops[at].target;
        }
        at = next;
    }
    return stack[0];
}

#endif
