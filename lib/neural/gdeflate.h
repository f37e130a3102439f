/** GDeflate: DEFLATE64 whose bits are spread over 32 lanes, in tiles of 64 KiB (docs/neural.md). */
#ifndef SLC_NEURAL_GDEFLATE_H
#define SLC_NEURAL_GDEFLATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define SLC_GDEFLATE_TILE 65536u
#define SLC_GDEFLATE_HEADER 8u

/** Header of a stream. */
struct slc_gdeflate_header {
    uint32_t tile_count;
    uint64_t size; ///< Bytes once inflated.
};

/** False if the bytes are no header. */
bool slc_gdeflate_read_header(const uint8_t bytes[SLC_GDEFLATE_HEADER],
                              struct slc_gdeflate_header *header);

/** Inflates one tile. True if it has exactly `out_size` bytes. */
bool slc_gdeflate_inflate(const uint8_t *in, size_t in_size, uint8_t *out, size_t out_size);

#endif /* SLC_NEURAL_GDEFLATE_H */
