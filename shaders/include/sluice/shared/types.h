/*
 * Types that let C and GLSL read the same headers: only 32-bit scalars and arrays of them.
 * SLUICE_SHARED_SIZE includes its semicolon, because GLSL before 4.60 accepts none on its own.
 */
#ifndef SLUICE_SHARED_TYPES_H
#define SLUICE_SHARED_TYPES_H

#if defined(__STDC_VERSION__) || defined(__cplusplus)
#include <assert.h>
#include <stdint.h>
typedef uint32_t uint;
#define SLUICE_SHARED_SIZE(type, size) static_assert(sizeof(type) == (size), #type);
#else
#define SLUICE_SHARED_SIZE(type, size)
#endif

#endif
