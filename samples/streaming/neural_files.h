/**
 * Neural sets that hang in the gallery: the textures of a .ntc file, each in the ways in which it
 * can be streamed, beside the pictures that it was made of.
 */
#ifndef SAMPLES_STREAMING_NEURAL_FILES_H
#define SAMPLES_STREAMING_NEURAL_FILES_H

#include <sluice/neural.h>

#include <stdatomic.h>

#include "pictures.h"

/** A file that is read through a function that counts. */
struct neural_file {
    int descriptor; ///< -1: none
    SluiceInput input;
    atomic_uint_least64_t *bytes_read; ///< of all files of a gallery; borrowed
};

struct neural_files {
    struct neural_file file;
    SluiceNeuralSet *set; ///< owned; NULL: no set hangs
    SluiceNeuralSetInfo info;
    struct neural_file *stores; ///< owned
    uint32_t store_count;
    atomic_uint_least64_t bytes_read;   ///< from all files, for what is streamed
    atomic_uint_least64_t bytes_beside; ///< for what it is compared with
};

/** What a picture of a set is, beside its color source. */
struct neural_picture {
    SluiceNeuralTexture texture;
    SluiceImageSource *original;           ///< owned; the texels before compression
    enum neural_mode mode;                 ///< how it is streamed
    SluiceFormat format;                   ///< of NEURAL_FEEDBACK
    bool hdr;                              ///< values may be above 1
    SluiceNeuralColorSpace from[4], to[4]; ///< of its channels: the network's, and those stored
};

/**
 * Opens settings.neural and hangs each of its textures once for each of settings.neural_modes.
 * Originals are the files beside it that have the names of the textures; they are baked. Says on
 * stderr what is wrong.
 */
bool neural_files_open(const struct settings *settings, const struct picture_limits *limits,
                       struct picture_list *list);
/** Of a list that may be empty; its sources are destroyed before. */
void neural_files_close(struct neural_files *files);

#endif /* SAMPLES_STREAMING_NEURAL_FILES_H */
