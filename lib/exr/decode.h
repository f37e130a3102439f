/** Decoder of chunks: writes the texels of a region in the requested format. */
#ifndef SLC_EXR_DECODE_H
#define SLC_EXR_DECODE_H

#include "exr/chunk.h"

/** Decoder with buffers, reused for every chunk. One thread at a time. */
struct slc_exr_decoder {
    struct slc_exr_file *file;
    exr_decode_pipeline_t pipeline;
    exr_result_t (*decompress)(exr_decode_pipeline_t *); ///< the library's for this file
    bool is_open;
};

/** Target of texels: a rectangle of a level, rows `pitch` bytes apart. */
struct slc_exr_target {
    SluiceFormat format;
    SluiceImageRegion region;
    char *texels;
    size_t pitch;
};

void slc_exr_decoder_init(struct slc_exr_decoder *decoder, struct slc_exr_file *file);
void slc_exr_decoder_finish(struct slc_exr_decoder *decoder);

/** Writes the texels that chunk and target share. Errors: IO, CORRUPT_DATA, UNSUPPORTED,
 *  OUT_OF_HOST_MEMORY; logged. */
SluiceResult slc_exr_decode_chunk(struct slc_exr_decoder *decoder,
                                  const struct slc_exr_chunk *chunk,
                                  const struct slc_exr_target *target);

/** Returns the default format for a file. */
SluiceFormat slc_exr_natural_format(const struct slc_exr_file *file);

#endif /* SLC_EXR_DECODE_H */
