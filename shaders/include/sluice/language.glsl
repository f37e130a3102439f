/*
 * Lets one source be GLSL and HLSL. Every file of the library that HLSL can include begins with it.
 *
 * GLSL: defines only macros that begin with SLUICE_. HLSL: also defines GLSL's names, as types (vec2),
 * functions (bitfieldExtract) and macros with arguments (fract); docs/hlsl.md lists the files that
 * compile, and what to define. Functions with inout or out parameters are never called behind && or ||:
 * HLSL before 2021, and glslang's, evaluate both sides.
 *
 *     macro                   is
 *     SLUICE_SPLAT(type, x)   a vector or matrix whose elements are all the number x (a matrix: 0 only)
 *     SLUICE_ATOMIC_*         an atomic operation on an element of a buffer
 *     SLUICE_NON_UNIFORM(i)   an index of an array of descriptors that differs between invocations
 *     SLUICE_BUFFER           declares a storage buffer: set, binding, name of the block, type and name
 *     SLUICE_SAMPLER_2D(tex)  a parameter: a sampler2D, or a Texture2D and a SamplerState
 *     SLUICE_SAMPLER_2D_ARRAY, SLUICE_USAMPLER_2D, SLUICE_ISAMPLER_2D  other kinds of samplers
 *     SLUICE_TEXTURE_*, _ARRAY_*  samples and fetches; GLSL ignores the second argument, a SamplerState
 */
#ifndef SLUICE_LANGUAGE_GLSL
#define SLUICE_LANGUAGE_GLSL

/* glslang's HLSL has GLSL's macros and a version above all of GLSL's. */
#if defined(__HLSL_VERSION) || defined(__hlsl_dx_compiler) || defined(__SLANG__) || !defined(GL_core_profile)
#define SLUICE_HLSL
#elif __VERSION__ >= 500
#define SLUICE_HLSL
#endif

#ifndef SLUICE_HLSL

#ifdef GL_FRAGMENT_SHADER
#define SLUICE_FRAGMENT_SHADER
#endif
#define SLUICE_DONT_UNROLL [[dont_unroll]]
#define SLUICE_SPLAT(type, x) type(x)
#define SLUICE_ATOMIC_MIN(word, value) atomicMin(word, value)
#define SLUICE_ATOMIC_OR(word, value) atomicOr(word, value)
#define SLUICE_ATOMIC_OR_READ(word, value, before) before = atomicOr(word, value)

#define SLUICE_NON_UNIFORM(i) nonuniformEXT(i)

#define SLUICE_BUFFER(set_, binding_, block, type, name) \
    layout(std430, set = set_, binding = binding_) readonly buffer block { type name[]; };
#define SLUICE_WRITTEN_BUFFER(set_, binding_, block, type, name) \
    layout(std430, set = set_, binding = binding_) buffer block { type name[]; };

#define SLUICE_SAMPLER_2D(tex) sampler2D tex
#define SLUICE_SAMPLER_2D_ARRAY(tex) sampler2DArray tex
#define SLUICE_USAMPLER_2D(tex) usampler2D tex
#define SLUICE_ISAMPLER_2D(tex) isampler2D tex
#define SLUICE_PASS_SAMPLER(tex) tex
#define SLUICE_SAMPLER_OF(tex)
#define SLUICE_TEXTURE_GRAD(tex, state, uv, dx, dy) textureGrad(tex, uv, dx, dy)
#define SLUICE_TEXTURE_GRAD_CLAMP(tex, state, uv, dx, dy, minLod) textureGradClampARB(tex, uv, dx, dy, minLod)
#define SLUICE_TEXTURE_LOD(tex, state, uv, lod) textureLod(tex, uv, lod)
#define SLUICE_TEXTURE_BIAS(tex, state, uv, bias) texture(tex, uv, bias)
#define SLUICE_TEXTURE_FETCH(tex, texel, level) texelFetch(tex, texel, level)
#define SLUICE_QUERY_LOD(tex, state, uv) textureQueryLod(tex, uv).y
#define SLUICE_ARRAY_SAMPLE(tex, state, at) textureLod(tex, at, 0.0)
#define SLUICE_ARRAY_FETCH(tex, at) texelFetch(tex, at, 0)

#else

#define SLUICE_DONT_UNROLL [loop]
#define SLUICE_SPLAT(type, x) ((type)(x))
#define SLUICE_ATOMIC_MIN(word, value) InterlockedMin(word, value)
#define SLUICE_ATOMIC_OR(word, value) InterlockedOr(word, value)
#define SLUICE_ATOMIC_OR_READ(word, value, before) InterlockedOr(word, value, before)

#ifndef SLUICE_NON_UNIFORM
#define SLUICE_NON_UNIFORM(i) NonUniformResourceIndex(i)
#endif

#define SLUICE_BUFFER(set, at, block, type, name) [[vk::binding(at, set)]] StructuredBuffer<type> name;
#define SLUICE_WRITTEN_BUFFER(set, at, block, type, name) [[vk::binding(at, set)]] RWStructuredBuffer<type> name;

#define SLUICE_SAMPLER_2D(tex) Texture2D tex, SamplerState tex##Sampler
#define SLUICE_SAMPLER_2D_ARRAY(tex) Texture2DArray tex, SamplerState tex##Sampler
#define SLUICE_USAMPLER_2D(tex) Texture2D<uint4> tex, SamplerState tex##Sampler
#define SLUICE_ISAMPLER_2D(tex) Texture2D<int4> tex, SamplerState tex##Sampler
#define SLUICE_PASS_SAMPLER(tex) tex, tex##Sampler
#define SLUICE_SAMPLER_OF(tex) tex##Sampler
#define SLUICE_TEXTURE_GRAD(tex, state, uv, dx, dy) tex.SampleGrad(state, uv, dx, dy)
#define SLUICE_TEXTURE_GRAD_CLAMP(tex, state, uv, dx, dy, minLod) tex.SampleGrad(state, uv, dx, dy, int2(0, 0), minLod)
#define SLUICE_TEXTURE_LOD(tex, state, uv, lod) tex.SampleLevel(state, uv, lod)
#define SLUICE_TEXTURE_BIAS(tex, state, uv, bias) tex.SampleBias(state, uv, bias)
#define SLUICE_TEXTURE_FETCH(tex, texel, level) tex.Load(int3(texel, level))
#define SLUICE_QUERY_LOD(tex, state, uv) tex.CalculateLevelOfDetailUnclamped(state, uv)
#define SLUICE_ARRAY_SAMPLE(tex, state, at) tex.SampleLevel(state, at, 0.0)
#define SLUICE_ARRAY_FETCH(tex, at) tex.Load(int4(at, 0))

typedef bool2 bvec2;
typedef float2 vec2;
typedef float3 vec3;
typedef float4 vec4;
typedef float3x4 mat3x4; /* three vectors of four in both languages: m[0] is a vec4 */
typedef int2 ivec2;
typedef int3 ivec3;
typedef int4 ivec4;
typedef uint2 uvec2;
typedef uint3 uvec3;
typedef uint4 uvec4;

#define dFdx(x) ddx(x)
#define dFdy(x) ddy(x)
#define dFdxFine(x) ddx_fine(x)
#define dFdyFine(x) ddy_fine(x)
#define equal(a, b) ((a) == (b))
#define floatBitsToUint(x) asuint(x)
#define findMSB(x) int(firstbithigh(x))
#define fract(x) frac(x)
#define greaterThanEqual(a, b) ((a) >= (b))
#define lessThan(a, b) ((a) < (b))
#define lessThanEqual(a, b) ((a) <= (b))
#define mix(a, b, t) lerp(a, b, t)
#define notEqual(a, b) ((a) != (b))
#define roundEven(x) round(x)
#define uintBitsToFloat(x) asfloat(x)

uint bitfieldExtract(uint value, int offset, int count)
{
    return (value >> uint(offset)) & ((1u << uint(count)) - 1u);
}

int bitfieldExtract(int value, int offset, int count)
{
    return (value << uint(32 - offset - count)) >> uint(32 - count);
}

uint bitfieldInsert(uint value, uint field, int offset, int count)
{
    uint mask = ((1u << uint(count)) - 1u) << uint(offset);
    return (value & ~mask) | ((field << uint(offset)) & mask);
}

#endif

#endif
