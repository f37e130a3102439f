/*
 * Byte pages of demand loading: finds the bytes of a page, or requests it. C interface:
 * SluiceDemandResourceCreateInfo.pageSize in sluice/demand.h.
 *
 *     SluiceDemandBytes bytes;
 *     if (sluiceMapBytesOrRequest(firstPage + i, bytes))
 *         vec3 position = vec3(sluiceDemandFloat(bytes, 0u), ...);
 *
 * The place of a page is an offset in one of SLUICE_DEMAND_BYTE_CHUNKS storage buffers. It is valid
 * within the launch. With bufferDeviceAddress of SluiceDemandLoaderCreateInfo, and without byteOffsets
 * of the resource, this file is not needed: the value of a page is its address. Use
 * GL_EXT_buffer_reference_uvec2:
 *
 *     uvec2 value;
 *     if (sluiceMapOrRequest(firstPage + i, value))
 *         vec4 position = Vertices(value).positions[j]; // buffer_reference, buffer_reference_align = 16
 *
 * Macro to define before you include it, in addition to those of demand_pages.glsl.
 * demand_bindings.glsl defines it for the descriptor set of a launch:
 *
 *     #define SLUICE_DEMAND_BYTE_WORD(chunk, i) chunks[nonuniformEXT(chunk)].words[i] // uint, read
 *
 * Define SLUICE_PAGE_LOOP, with any value, if arrays cannot have non-uniform indices
 * (demand_bindings.glsl).
 * Any stage. Pages may differ between invocations.
 */
#ifndef SLUICE_DEMAND_BYTES_GLSL
#define SLUICE_DEMAND_BYTES_GLSL

#include "demand_pages.glsl"
#include "shared/bindings.h"

/** Position of a page's bytes. */
struct SluiceDemandBytes {
    uint chunk;  /* index of the storage buffer */
    uint offset; /* bytes; a multiple of 16 */
};

/** Finds the bytes of a page. Returns false if it is not resident; it is then requested. */
bool sluiceMapBytesOrRequest(uint page, out SluiceDemandBytes bytes)
{
    uvec2 value;
    bool resident = sluiceMapOrRequest(page, value);
    bytes.offset = value.x;
    bytes.chunk = value.y;
    return resident;
}

/** Returns 32-bit word `index` of a page: bytes 4 * index to 4 * index + 3, the first one lowest. */
uint sluiceDemandWord(SluiceDemandBytes bytes, uint index)
{
    uint at = bytes.offset / 4u + index;
#ifdef SLUICE_PAGE_LOOP
    uint word = 0u;
    for (uint c = 0u; c < SLUICE_DEMAND_BYTE_CHUNKS; c++)
        if (c == bytes.chunk)
            word = SLUICE_DEMAND_BYTE_WORD(c, at);
    return word;
#else
    return SLUICE_DEMAND_BYTE_WORD(bytes.chunk, at);
#endif
}

/** Returns word `index` of a page as a float. */
float sluiceDemandFloat(SluiceDemandBytes bytes, uint index)
{
    return uintBitsToFloat(sluiceDemandWord(bytes, index));
}

/** Returns byte `index` of a page, 0 to 255. */
uint sluiceDemandByte(SluiceDemandBytes bytes, uint index)
{
    return bitfieldExtract(sluiceDemandWord(bytes, index / 4u), int(index % 4u) * 8, 8);
}

#endif
