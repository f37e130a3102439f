/* Forward and backward pass of the network over tiles of 32 samples.
 *
 * A workgroup keeps the values of one tile in shared memory, [row][sample], and the gradients of
 * all weights in registers, over all of its tiles; with TRAIN_SUMS_IN_MEMORY, in its partial sum. Rows have a stride of 36 floats, so that eight
 * threads that read vec4s of eight rows touch all banks once. Products are tiles of registers:
 * forward, a thread has four samples of every 16th row. */
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "train_layout.glsl"

layout(local_size_x = 128) in;

layout(set = 0, binding = 0) readonly buffer Network { vec4 network[]; };
layout(set = 0, binding = 1) buffer Partials { float partials[]; };
layout(set = 0, binding = 2) readonly buffer Latents { uint latents[]; };
layout(set = 0, binding = 4) buffer Gradients { int latent_gradients[]; };
layout(set = 0, binding = 5) readonly buffer References { uint references[]; };
layout(set = 0, binding = 6) readonly buffer Table { uint table[]; };

/* Loops whose turns need no registers of their own: unrolled, they take lavapipe a minute to compile. */
#define ROLLED [[dont_unroll]]

const uint STRIDE = 9u; /* vec4s of a row */
const uint ROW_X = 0u, ROW_1 = 48u, ROW_2 = 112u, ROW_3 = 160u, ROW_OUT = 192u;

shared vec4 act[208 * 9];
shared uint sample_texel[32];
shared uvec4 sample_corner[64]; /* per image: word of a corner, steps in x and y, fractions */

uint mip_of_tile(uint tile)
{
    uint mip = 0u;
    for (uint m = 1u; m < push.mipCount; m++)
        if (table[m * TRAIN_MIP_WORDS + TRAIN_MIP_FIRST_TILE] <= tile)
            mip = m;
    return mip;
}

/* One texel of each stratum, a run of texels. Strata begin elsewhere in each step. */
uvec2 texel_of_sample(uint base, uint tile, uint k)
{
    uint width = table[base + TRAIN_MIP_WIDTH], height = table[base + TRAIN_MIP_HEIGHT];
    uint count = width * height, stratum = table[base + TRAIN_MIP_STRATUM];
    uint number = (tile - table[base + TRAIN_MIP_FIRST_TILE]) * TRAIN_TILE + k;
    uint start = hash3(push.step, push.seed, base) % count;
    uint within = hash3(number, push.step, push.seed + base) % stratum;
    uint texel = (start + number * stratum + within) % count;
    return uvec2(texel % width, texel / width);
}

/* Texel and fraction of 256 where a texel's center lies in a grid, as integers: the decoder's
 * rule. */
ivec2 place(uint x, uint grid, uint width)
{
    uint a = (2u * x + 1u) * grid, d = 2u * width;
    int at = int((a / d) * 256u + ((a % d) * 256u) / d) - 128;
    int cell = at >> 8;
    return ivec2(cell < 0 ? int(grid) - 1 : cell, at & 255);
}

/* Two features of a sample, 0 if the set has fewer. */
void load_features(uint k, uint image, uint pair, uvec4 corner)
{
    uint row = ROW_X + image * 16u + 2u * pair;
    if (pair >= FEATURE_COUNT / 2u) {
        act[row * STRIDE + (k >> 2)][k & 3u] = 0.0;
        act[(row + 1u) * STRIDE + (k >> 2)][k & 3u] = 0.0;
        return;
    }
    vec2 f = vec2(corner.w & 0xffffu, corner.w >> 16);
    vec2 g = 256.0 - f;
    uint at = corner.x + pair;
    /* times 65536 */
    vec2 sum = unpackHalf2x16(latents[at]) * (g.x * g.y) +
               unpackHalf2x16(latents[at + corner.y]) * (f.x * g.y) +
               unpackHalf2x16(latents[at + corner.z]) * (g.x * f.y) +
               unpackHalf2x16(latents[at + corner.y + corner.z]) * (f.x * f.y);
    vec2 code = sum * (17.0 / 65536.0) - 128.0;
    vec2 x;
    if (has_flag(TRAIN_FP8)) {
        x = code * (1.0 / 127.5) + vec2(0.5 / 127.5); /* 2 S - 1 */
        x = round_to_e4m3(x.xyxy).xy;
    } else {
        x = (has_flag(TRAIN_QUANTIZE_INPUTS) ? floor(code) : code - 0.5) * (1.0 / 127.5);
    }
    act[row * STRIDE + (k >> 2)][k & 3u] = x.x;
    act[(row + 1u) * STRIDE + (k >> 2)][k & 3u] = x.y;
}

float input_code(float e)
{
    if (has_flag(TRAIN_FP8))
        return round_to_e4m3(vec4(e)).x;
    return has_flag(TRAIN_QUANTIZE_INPUTS) ? trunc(e * 127.5) * (1.0 / 127.5) : e;
}

/* Warp `part` of four: half of the features of one image, a quarter of the positions. */
void load_inputs(uint tile)
{
    uint k = gl_LocalInvocationIndex & 31u, part = gl_LocalInvocationIndex >> 5;
    uint base = mip_of_tile(tile) * TRAIN_MIP_WORDS;
    uvec2 texel = texel_of_sample(base, tile, k);
    uint width = table[base + TRAIN_MIP_WIDTH], height = table[base + TRAIN_MIP_HEIGHT];
    uint image = part >> 1;
    uint at = base + (image == 0u ? TRAIN_MIP_FINE : TRAIN_MIP_COARSE);
    uint grid_width = table[at + 1u], grid_height = table[at + 2u];
    const uint words = FEATURE_COUNT / 2u;
    ivec2 px = place(texel.x, grid_width, width), py = place(texel.y, grid_height, height);
    /* steps modulo 2^32, for the last column wraps to the first */
    uint step_x = uint(px.x) + 1u == grid_width ? uint(-px.x) : 1u;
    uint step_y = uint(py.x) + 1u == grid_height ? uint(-py.x) * grid_width : grid_width;
    uvec4 corner = uvec4(table[at] + (uint(py.x) * grid_width + uint(px.x)) * words,
                         step_x * words, step_y * words, uint(px.y) | uint(py.y) << 16);
    if ((part & 1u) == 0u)
        sample_corner[image * 32u + k] = corner;
    if (part == 0u)
        sample_texel[k] = table[base + TRAIN_MIP_FIRST_TEXEL] + texel.y * width + texel.x;
    ROLLED for (uint pair = (part & 1u); pair < 8u; pair += 2u)
        load_features(k, image, pair, corner);
    float scale = uintBitsToFloat(table[base + TRAIN_MIP_POSITION_SCALE]);
    float t = float((part & 1u) == 0u ? texel.x : texel.y) * scale;
    ROLLED for (uint wave = 0u; wave < 3u; wave++) {
        float e = 2.0 * fract(t + (part >= 2u ? 0.25 : 0.0)) - 1.0;
        act[(32u + wave * 4u + part) * STRIDE + (k >> 2)][k & 3u] = input_code(e);
        t *= 2.0;
    }
    float lod = part < 2u ? uintBitsToFloat(table[base + TRAIN_MIP_LOD]) : 0.0;
    act[(44u + part) * STRIDE + (k >> 2)][k & 3u] = input_code(lod);
}

/* HGELUClamp, rounded as the decoder does. Layer 3 reads codes of int8 in both networks. */
vec4 activate(vec4 r, bool to_code, out vec4 derivative)
{
    vec4 t = clamp(r * 0.333333 + 0.5, 0.0, 1.0);
    vec4 y = min(r, vec4(3.0)) * t;
    vec4 middle = r * 0.666667 + 0.5;
    derivative = mix(mix(middle, vec4(1.0), greaterThan(r, vec4(1.5))), vec4(0.0),
                     lessThan(r, vec4(-1.5)));
    derivative = mix(derivative, vec4(0.0), greaterThan(r, vec4(3.0)));
    if (has_flag(TRAIN_QUANTIZE_NETWORK)) {
        if (to_code || !has_flag(TRAIN_FP8))
            y = roundEven(y * 80.0) * (1.0 / 80.0);
        else
            y = round_to_e4m3(y);
    }
    return y;
}

float bias_of(uint row)
{
    uint at = TRAIN_EFFECTIVE + TRAIN_BIASES + row;
    return network[at >> 2][at & 3u];
}

/* sums[j] += W[first + 16 j][all inputs] * rows of `from`. */
#define PRODUCT(sums, COUNT, weights, INPUTS, from)                                                \
    ROLLED for (uint i = 0u; i < INPUTS / 4u; i++) {                                               \
        uint at = (from + 4u * i) * STRIDE + kg;                                                   \
        vec4 x0 = act[at], x1 = act[at + STRIDE], x2 = act[at + 2u * STRIDE],                      \
             x3 = act[at + 3u * STRIDE];                                                           \
        for (uint j = 0u; j < COUNT; j++) {                                                        \
            vec4 w = network[(weights) / 4u + (og + 16u * j) * (INPUTS / 4u) + i];                 \
            sums[j] += w.x * x0 + w.y * x1 + w.z * x2 + w.w * x3;                                  \
        }                                                                                          \
    }

/* sums += delta of outputs first_o + step_o a, times values of inputs first_i + step_i b. */
#ifdef TRAIN_SUMS_IN_MEMORY
#define OUTER(sums, COUNT_O, COUNT_I, delta_row, first_o, step_o, value_row, first_i, step_i,      \
              weights, INPUTS)                                                                     \
    ROLLED for (uint o = first_o; o < first_o + step_o * COUNT_O; o += step_o) {                   \
        ROLLED for (uint i = first_i; i < first_i + step_i * COUNT_I; i += step_i) {               \
            vec4 sum = vec4(0.0);                                                                  \
            ROLLED for (uint k = 0u; k < 8u; k++) {                                                \
                sum += act[(delta_row + o) * STRIDE + k] * act[(value_row + i) * STRIDE + k];      \
            }                                                                                      \
            uint at = to + weights + o * INPUTS + i;                                               \
            partials[at] = (turn == 0u ? 0.0 : partials[at]) + dot(sum, vec4(1.0));                \
        }                                                                                          \
    }
#define STORE(sums, COUNT_O, COUNT_I, first_o, step_o, first_i, step_i, weights, INPUTS)
#else
#define OUTER(sums, COUNT_O, COUNT_I, delta_row, first_o, step_o, value_row, first_i, step_i,      \
              weights, INPUTS)                                                                     \
    ROLLED for (uint k = 0u; k < 8u; k++) {                                                        \
        vec4 v[COUNT_I];                                                                           \
        for (uint b = 0u; b < COUNT_I; b++)                                                        \
            v[b] = act[(value_row + first_i + step_i * b) * STRIDE + k];                           \
        for (uint a = 0u; a < COUNT_O; a++) {                                                      \
            vec4 d = act[(delta_row + first_o + step_o * a) * STRIDE + k];                         \
            for (uint b = 0u; b < COUNT_I; b++)                                                    \
                sums[a * COUNT_I + b] += dot(d, v[b]);                                             \
        }                                                                                          \
    }
#define STORE(sums, COUNT_O, COUNT_I, first_o, step_o, first_i, step_i, weights, INPUTS)           \
    for (uint a = 0u; a < COUNT_O; a++)                                                            \
        for (uint b = 0u; b < COUNT_I; b++)                                                        \
            partials[to + weights + (first_o + step_o * a) * INPUTS + first_i + step_i * b] =      \
                sums[a * COUNT_I + b];
#endif

#define WRITE_ROWS(values, COUNT, row)                                                             \
    for (uint j = 0u; j < COUNT; j++)                                                              \
        act[(row + og + 16u * j) * STRIDE + kg] = values[j];

float error_of(float value, uint channel, uint texel)
{
    uint at = TRAIN_CHANNELS + channel * TRAIN_CHANNEL_WORDS;
    vec2 both = unpackHalf2x16(references[texel * REFERENCE_WORDS + (channel >> 1)]);
    float wanted = (channel & 1u) == 0u ? both.x : both.y;
    float margin = uintBitsToFloat(table[at + TRAIN_CHANNEL_MARGIN]);
    float error = value - wanted;
    /* Beyond 0 and 1 the decoder clamps. */
    if (table[at + TRAIN_CHANNEL_CLAMPED] != 0u) {
        if (wanted <= 0.0)
            error = max(error + margin, 0.0);
        if (wanted >= 1.0)
            error = min(error - margin, 0.0);
        /* A mask counts as wrong by some steps wherever it is wrong: squares of small errors alone
         * would not outweigh those of other channels. */
        if (margin > 0.0 && error != 0.0 && (wanted <= 0.0 || wanted >= 1.0))
            error = sign(error) * max(abs(error), TRAIN_MASK_ERROR);
    }
    return error;
}

void main()
{
    uint thread = gl_LocalInvocationIndex;
    uint og = thread >> 3, kg = thread & 7u; /* rows and samples of products */
    uint o8 = thread >> 4, i16 = thread & 15u; /* rows of outer products */
    uint to = gl_WorkGroupID.x * TRAIN_PARTIAL;
#ifndef TRAIN_SUMS_IN_MEMORY
    float dw0[24], dw1[24], dw2[12], dw3[4];
    for (uint i = 0u; i < 24u; i++)
        dw0[i] = dw1[i] = 0.0;
    for (uint i = 0u; i < 12u; i++)
        dw2[i] = 0.0;
    for (uint i = 0u; i < 4u; i++)
        dw3[i] = 0.0;
#endif
    float db0 = 0.0, db1 = 0.0, loss = 0.0;
    uint weight_at = TRAIN_CHANNELS + og * TRAIN_CHANNEL_WORDS + TRAIN_CHANNEL_WEIGHT;
    float weight = og < push.channelCount ? uintBitsToFloat(table[weight_at]) : 0.0;

    ROLLED for (uint turn = 0u; turn < push.tilesPerGroup; turn++) {
        uint tile = gl_WorkGroupID.x + turn * push.groupCount;
        if (tile >= push.tileCount)
            break;
        load_inputs(tile);
        barrier();

        vec4 s1[4], d1[4];
        for (uint j = 0u; j < 4u; j++)
            s1[j] = vec4(bias_of(og + 16u * j));
        PRODUCT(s1, 4u, TRAIN_EFFECTIVE + TRAIN_WEIGHTS0, 48u, ROW_X)
        for (uint j = 0u; j < 4u; j++)
            s1[j] = activate(s1[j], false, d1[j]);
        WRITE_ROWS(s1, 4u, ROW_1)
        barrier();

        vec4 s2[3], d2[3];
        for (uint j = 0u; j < 3u; j++)
            s2[j] = vec4(bias_of(64u + og + 16u * j));
        PRODUCT(s2, 3u, TRAIN_EFFECTIVE + TRAIN_WEIGHTS1, 64u, ROW_1)
        for (uint j = 0u; j < 3u; j++)
            s2[j] = activate(s2[j], false, d2[j]);
        WRITE_ROWS(s2, 3u, ROW_2)
        barrier();

        vec4 s3[2], d3[2];
        for (uint j = 0u; j < 2u; j++)
            s3[j] = vec4(bias_of(112u + og + 16u * j));
        PRODUCT(s3, 2u, TRAIN_EFFECTIVE + TRAIN_WEIGHTS2, 48u, ROW_2)
        for (uint j = 0u; j < 2u; j++)
            s3[j] = activate(s3[j], true, d3[j]);
        WRITE_ROWS(s3, 2u, ROW_3)
        barrier();

        vec4 s4[1];
        s4[0] = vec4(bias_of(144u + og));
        PRODUCT(s4, 1u, TRAIN_EFFECTIVE + TRAIN_WEIGHTS3, 32u, ROW_3)
        vec4 error = vec4(0.0);
        if (weight != 0.0)
            for (uint k = 0u; k < 4u; k++)
                error[k] = error_of(s4[0][k], og, sample_texel[kg * 4u + k]);
        loss += dot(error, error);
        s4[0] = error * weight;
        WRITE_ROWS(s4, 1u, ROW_OUT)
        barrier();

        OUTER(dw3, 2u, 2u, ROW_OUT, o8, 8u, ROW_3, i16, 16u, TRAIN_WEIGHTS3, 32u)
        for (uint j = 0u; j < 2u; j++)
            s3[j] = vec4(0.0);
        PRODUCT(s3, 2u, TRAIN_TRANSPOSED + TRAIN_WEIGHTS3, 16u, ROW_OUT)
        barrier();
        for (uint j = 0u; j < 2u; j++)
            s3[j] *= d3[j];
        WRITE_ROWS(s3, 2u, ROW_3)
        barrier();

        OUTER(dw2, 4u, 3u, ROW_3, o8, 8u, ROW_2, i16, 16u, TRAIN_WEIGHTS2, 48u)
        for (uint j = 0u; j < 3u; j++)
            s2[j] = vec4(0.0);
        PRODUCT(s2, 3u, TRAIN_TRANSPOSED + TRAIN_WEIGHTS2, 32u, ROW_3)
        barrier();
        for (uint j = 0u; j < 3u; j++)
            s2[j] *= d2[j];
        WRITE_ROWS(s2, 3u, ROW_2)
        barrier();

        OUTER(dw1, 6u, 4u, ROW_2, o8, 8u, ROW_1, i16, 16u, TRAIN_WEIGHTS1, 64u)
        for (uint j = 0u; j < 4u; j++)
            s1[j] = vec4(0.0);
        PRODUCT(s1, 4u, TRAIN_TRANSPOSED + TRAIN_WEIGHTS1, 48u, ROW_2)
        barrier();
        for (uint j = 0u; j < 4u; j++)
            s1[j] *= d1[j];
        WRITE_ROWS(s1, 4u, ROW_1)
        barrier();

        OUTER(dw0, 4u, 6u, ROW_1, og, 16u, ROW_X, kg, 8u, TRAIN_WEIGHTS0, 48u)
        ROLLED for (uint k = 0u; k < 8u; k++) {
            if (thread < 112u)
                db0 += dot(act[(ROW_1 + thread) * STRIDE + k], vec4(1.0));
            if (thread < 48u)
                db1 += dot(act[(ROW_3 + thread) * STRIDE + k], vec4(1.0));
        }
        if (has_flag(TRAIN_LATENTS)) {
            vec4 sx[2];
            sx[0] = sx[1] = vec4(0.0);
            PRODUCT(sx, 2u, TRAIN_TRANSPOSED + TRAIN_WEIGHTS0, 64u, ROW_1)
            barrier();
            WRITE_ROWS(sx, 2u, ROW_X)
            barrier();
            /* Neighboring threads add to neighboring features. Integers, so that the order in which
             * threads add does not matter. */
            const uint per_turn = 128u / FEATURE_COUNT;
            uint feature = thread % FEATURE_COUNT;
            ROLLED for (uint s = thread / FEATURE_COUNT; s < 64u && thread < per_turn * FEATURE_COUNT;
                 s += per_turn) {
                uvec4 corner = sample_corner[s];
                uint k = s & 31u;
                float g = act[((s >> 5) * 16u + feature) * STRIDE + (k >> 2)][k & 3u];
                /* gradient of a latent in 0..1; the input is 2 * latent - 1 */
                g = clamp(2.0 * g, -8.0, 8.0) * push.latentUnit * (1.0 / 65536.0);
                vec2 f = vec2(corner.w & 0xffffu, corner.w >> 16);
                vec2 h = 256.0 - f;
                uint at = corner.x * 2u + feature;
                atomicAdd(latent_gradients[at], int(roundEven(g * h.x * h.y)));
                atomicAdd(latent_gradients[at + corner.y * 2u], int(roundEven(g * f.x * h.y)));
                atomicAdd(latent_gradients[at + corner.z * 2u], int(roundEven(g * h.x * f.y)));
                atomicAdd(latent_gradients[at + (corner.y + corner.z) * 2u],
                          int(roundEven(g * f.x * f.y)));
            }
        }
        barrier();
    }

    STORE(dw0, 4u, 6u, og, 16u, kg, 8u, TRAIN_WEIGHTS0, 48u)
    STORE(dw1, 6u, 4u, o8, 8u, i16, 16u, TRAIN_WEIGHTS1, 64u)
    STORE(dw2, 4u, 3u, o8, 8u, i16, 16u, TRAIN_WEIGHTS2, 48u)
    STORE(dw3, 2u, 2u, o8, 8u, i16, 16u, TRAIN_WEIGHTS3, 32u)
    if (thread < 112u)
        partials[to + TRAIN_BIASES + thread] = db0;
    if (thread < 48u)
        partials[to + TRAIN_BIASES + 112u + thread] = db1;
    act[og * STRIDE + (kg >> 2)][kg & 3u] = loss;
    barrier();
    if (thread < 16u)
        partials[to + TRAIN_PARAMETERS + thread] =
            dot(act[thread * STRIDE] + act[thread * STRIDE + 1u], vec4(1.0));
}
