/** Decodes chunks and delivers the texels of a region in the format that is asked for. */
#ifndef SLC_EXR_DECODE_H
#define SLC_EXR_DECODE_H

#include "exr/chunk.h"

/** Buffers that are used again from chunk to chunk. One thread at a time. */
struct slc_exr_decoder {
    struct slc_exr_file *file;
    exr_decode_pipeline_t pipeline;
    exr_result_t (*decompress)(exr_decode_pipeline_t *); ///< the library's for this file
    bool is_open;
};

/** Where texels go: a rectangle of a level, rows `pitch` bytes apart. */
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

/** The format that fits the file, where none is asked for. */
SluiceFormat slc_exr_natural_format(const struct slc_exr_file *file);

#endif /* SLC_EXR_DECODE_H */
