/**
 * Neural sets in the gallery. Shows the textures of a .ntc file in each requested mode, beside
 * their originals.
 */
#ifndef SAMPLES_STREAMING_NEURAL_FILES_H
#define SAMPLES_STREAMING_NEURAL_FILES_H

#include <sluice/neural.h>

#include <stdatomic.h>

#include "pictures.h"

/** A file whose reads are counted. */
struct neural_file {
    int descriptor; ///< -1: none
    SluiceInput input;
    atomic_uint_least64_t *bytes_read; ///< counter of all files of a gallery; borrowed
};

struct neural_files {
    struct neural_file file;
    SluiceNeuralSet *set; ///< owned; NULL: no set
    SluiceNeuralSetInfo info;
    struct neural_file *stores; ///< owned
    uint32_t store_count;
    atomic_uint_least64_t bytes_read;   ///< bytes of the streamed files
    atomic_uint_least64_t bytes_beside; ///< bytes of the files for comparison
};

/** Neural part of a picture, beside its color source. */
struct neural_picture {
    SluiceNeuralTexture texture;
    SluiceImageSource *original; ///< owned; the texels before compression
    enum neural_mode mode;       ///< how the texture is streamed
    SluiceFormat format;         ///< format for NEURAL_FEEDBACK
    bool hdr;                    ///< values may be above 1
    SluiceNeuralColorSpace from[4],
        to[4]; ///< color spaces by channel: of the network, and as stored
};

/**
 * Opens settings.neural, and hangs each of its textures once per mode in settings.neural_modes.
 * Originals are files beside the set, named like its textures; they are baked. Reports errors on
 * stderr.
 */
bool neural_files_open(const struct settings *settings, const struct picture_limits *limits,
                       struct picture_list *list);
/** Accepts the files of an empty list. Destroy the list's sources before. */
void neural_files_close(struct neural_files *files);

#endif /* SAMPLES_STREAMING_NEURAL_FILES_H */
