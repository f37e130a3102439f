/** Description in a .ntc file, as parsed. Only kinds of values and lengths of arrays are checked.
 */
#ifndef SLC_NEURAL_DOCUMENT_H
#define SLC_NEURAL_DOCUMENT_H

#include <sluice/neural.h>

#include "base/none.h"
#include "neural/json_reader.h"

#define SLC_NEURAL_MAX_NETWORKS 8
#define SLC_NEURAL_MAX_LAYER_VIEWS 4
#define SLC_NEURAL_MAX_VIEWS 4096 ///< files have about 100

/** Type of the numbers in a view. */
enum slc_neural_type {
    SLC_NEURAL_TYPE_NONE, ///< missing in the text
    SLC_NEURAL_INT8,
    SLC_NEURAL_INT32,
    SLC_NEURAL_E4M3,
    SLC_NEURAL_E5M2,
    SLC_NEURAL_HALF,
    SLC_NEURAL_FLOAT
};

/** Byte range of the file. */
struct slc_neural_view {
    uint64_t offset; ///< from the start of the data chunk
    uint64_t stored_size;
    uint64_t size; ///< uncompressed bytes; 0: missing
    uint32_t crc;  ///< 0: no checksum
    uint32_t is_compressed;
};

/** Views are indices, or SLC_NONE. */
struct slc_neural_layer {
    uint32_t inputs, outputs;
    uint32_t weight_view, scale_view, bias_view;
    uint32_t weight_type, scale_type, bias_type; ///< enum slc_neural_type
    uint32_t scale_bias_type;                    ///< type of scales and biases in version 0.5
};

struct slc_neural_mlp {
    struct slc_neural_layer layers[SLUICE_NEURAL_LAYERS];
    uint32_t layer_count;
    uint32_t is_activation_known, is_row_major;
    uint32_t weight_type, scale_bias_type; ///< defaults of the layers, in files of version 0.5
};

struct slc_neural_document_texture {
    const char *name; ///< in the text
    uint32_t first_channel, channel_count;
    uint32_t format, rgb_color_space, alpha_color_space, bc_format; ///< values of neural.h
};

/** Schema 1: both grids. Schema 3: one in `width` and `height`. */
struct slc_neural_document_latents {
    uint32_t width, height, high_bits_per_texel, high_view;
    uint32_t low_width, low_height, low_bits_per_texel, low_view;
    uint32_t layer_views[SLC_NEURAL_MAX_LAYER_VIEWS];
    uint32_t layer_view_count;
};

struct slc_neural_document_mip {
    uint32_t width, height; ///< 0: missing
    uint32_t latent_mip;    ///< SLC_NONE: missing
    double position_lod, position_scale;
    uint32_t has_position; ///< bit 0: lod, bit 1: scale
};

struct slc_neural_document {
    uint32_t schema, width, height, channel_count, mip_count;
    uint32_t features;                 ///< schema 3
    uint32_t high_features, high_bits; ///< schema 1
    uint32_t low_features, low_bits;   ///< schema 1
    struct slc_neural_mlp mlp;         ///< layer_count 0: no network
    struct slc_neural_mlp mlps[SLC_NEURAL_MAX_NETWORKS];
    uint32_t mlp_count;
    struct slc_neural_document_texture textures[SLUICE_NEURAL_MAX_CHANNELS];
    uint32_t texture_count;
    uint32_t color_spaces[SLUICE_NEURAL_MAX_CHANNELS];
    uint32_t color_space_count;
    struct slc_neural_document_latents latents[SLUICE_NEURAL_MAX_LATENT_IMAGES];
    uint32_t latent_count;
    struct slc_neural_document_mip mips[SLUICE_NEURAL_MAX_MIPS];
    uint32_t color_mip_count;
    struct slc_neural_view *views; ///< owned
    uint32_t view_count, view_capacity;
    SluiceAllocationCallbacks allocator;
    bool is_out_of_memory;
};

/**
 * Parses the text. Names point into the text. `document` must be zero except its allocator; finish
 * `document` in any case. False: error, see `json->trouble` and `is_out_of_memory`.
 */
bool slc_neural_document_parse(struct slc_neural_document *document, struct slc_json *json);

/** Frees the document's memory. A zeroed struct is allowed. */
void slc_neural_document_finish(struct slc_neural_document *document);

#endif /* SLC_NEURAL_DOCUMENT_H */
