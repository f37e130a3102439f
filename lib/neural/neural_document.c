#include "neural/neural_document.h"

#include "base/alloc.h"

#include <string.h>

/* Reads a value to `to`. */
typedef bool (*read_function)(struct slc_json *json, struct slc_neural_document *document,
                              void *to);

struct field {
    const char *key;
    read_function read;
    size_t offset; ///< offset of the field in the struct
};

/* Reads an object. Skips unknown keys. */
static bool read_fields(struct slc_json *json, struct slc_neural_document *document,
                        const struct field *fields, size_t count, void *to)
{
    const char *key;
    if (!slc_json_enter_object(json))
        return false;
    while (slc_json_next_member(json, &key)) {
        size_t i = 0;
        while (i < count && strcmp(fields[i].key, key) != 0)
            i++;
        if (i < count)
            fields[i].read(json, document, (char *)to + fields[i].offset);
        else
            slc_json_skip(json);
    }
    return !json->trouble;
}

#define READ_FIELDS(json, document, fields, to)                                                    \
    read_fields(json, document, fields, sizeof(fields) / sizeof *(fields), to)

static bool read_u32(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)document;
    return slc_json_read_u32(json, to);
}

static bool read_u64(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)document;
    return slc_json_read_u64(json, to);
}

static bool read_string(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    const char *string;
    (void)document;
    if (!slc_json_read_string(json, &string))
        return false;
    *(const char **)to = string;
    return true;
}

/* Reads a name and finds its index in a list that ends with NULL. */
static bool read_name(struct slc_json *json, const char *const *names, const char *trouble,
                      uint32_t *to)
{
    const char *name;
    if (!slc_json_read_string(json, &name))
        return false;
    for (uint32_t i = 0; names[i]; i++)
        if (strcmp(names[i], name) == 0) {
            *to = i;
            return true;
        }
    return slc_json_fail(json, trouble);
}

static bool read_type(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const char *const NAMES[] = {
        [SLC_NEURAL_TYPE_NONE] = "",     [SLC_NEURAL_INT8] = "Int8",
        [SLC_NEURAL_INT32] = "Int32",    [SLC_NEURAL_E4M3] = "FloatE4M3",
        [SLC_NEURAL_E5M2] = "FloatE5M2", [SLC_NEURAL_HALF] = "Float16",
        [SLC_NEURAL_FLOAT] = "Float32",  NULL};
    (void)document;
    return read_name(json, NAMES, "a type of numbers is unknown", to);
}

static bool read_color_space(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const char *const NAMES[] = {"Linear", "sRGB", "HLG", NULL};
    (void)document;
    return read_name(json, NAMES, "a color space is unknown", to);
}

static bool read_channel_format(struct slc_json *json, struct slc_neural_document *document,
                                void *to)
{
    static const char *const NAMES[] = {"UNKNOWN", "UNORM8", "UNORM16", "FLOAT16",
                                        "FLOAT32", "UINT32", NULL};
    (void)document;
    return read_name(json, NAMES, "a channel format is unknown", to);
}

static bool read_bc_format(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const char *const NAMES[] = {"None", "BC1", "BC2", "BC3", "BC4",
                                        "BC5",  "BC6", "BC7", NULL};
    (void)document;
    return read_name(json, NAMES, "a block format is unknown", to);
}

static bool read_compression(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const char *const NAMES[] = {"None", "GDeflate", NULL};
    (void)document;
    return read_name(json, NAMES, "a compression is unknown", to);
}

static bool read_activation(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const char *const NAMES[] = {"", "HGELUClamp", NULL};
    (void)document;
    return read_name(json, NAMES, "an activation is unknown", to);
}

static bool read_weight_layout(struct slc_json *json, struct slc_neural_document *document,
                               void *to)
{
    static const char *const NAMES[] = {"", "RowMajor", NULL};
    (void)document;
    return read_name(json, NAMES, "a weight layout is unknown", to);
}

static bool read_double(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)document;
    return slc_json_read_number(json, to);
}

static bool read_lod(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    struct slc_neural_document_mip *mip = to;
    mip->has_position |= 1;
    return read_double(json, document, &mip->position_lod);
}

static bool read_scale(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    struct slc_neural_document_mip *mip = to;
    mip->has_position |= 2;
    return read_double(json, document, &mip->position_scale);
}

#define AT(key, read, type, field)                                                                 \
    {                                                                                              \
        key, read, offsetof(type, field)                                                           \
    }

static bool read_layer(struct slc_json *json, struct slc_neural_document *document,
                       struct slc_neural_layer *layer)
{
    static const struct field FIELDS[] = {
        AT("inputChannels", read_u32, struct slc_neural_layer, inputs),
        AT("outputChannels", read_u32, struct slc_neural_layer, outputs),
        AT("weightView", read_u32, struct slc_neural_layer, weight_view),
        AT("scaleView", read_u32, struct slc_neural_layer, scale_view),
        AT("biasView", read_u32, struct slc_neural_layer, bias_view),
        AT("weightType", read_type, struct slc_neural_layer, weight_type),
        AT("scaleType", read_type, struct slc_neural_layer, scale_type),
        AT("biasType", read_type, struct slc_neural_layer, bias_type),
        AT("scaleBiasType", read_type, struct slc_neural_layer, scale_bias_type),
    };
    *layer = (struct slc_neural_layer){
        .weight_view = SLC_NONE, .scale_view = SLC_NONE, .bias_view = SLC_NONE};
    return READ_FIELDS(json, document, FIELDS, layer);
}

static bool read_layers(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    struct slc_neural_mlp *mlp = to;
    mlp->layer_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (mlp->layer_count == SLUICE_NEURAL_LAYERS)
            return slc_json_fail(json, "a network has more than 4 layers");
        read_layer(json, document, &mlp->layers[mlp->layer_count++]);
    }
    return !json->trouble;
}

static bool read_mlp(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const struct field FIELDS[] = {
        {"layers", read_layers, 0},
        AT("activation", read_activation, struct slc_neural_mlp, is_activation_known),
        AT("weightLayout", read_weight_layout, struct slc_neural_mlp, is_row_major),
        AT("weightType", read_type, struct slc_neural_mlp, weight_type),
        AT("scaleBiasType", read_type, struct slc_neural_mlp, scale_bias_type),
    };
    *(struct slc_neural_mlp *)to = (struct slc_neural_mlp){.is_activation_known = 1};
    return READ_FIELDS(json, document, FIELDS, to);
}

static bool read_mlps(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)to;
    document->mlp_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (document->mlp_count == SLC_NEURAL_MAX_NETWORKS)
            return slc_json_fail(json, "there are more than 8 networks");
        read_mlp(json, document, &document->mlps[document->mlp_count++]);
    }
    return !json->trouble;
}

static bool read_texture(struct slc_json *json, struct slc_neural_document *document,
                         struct slc_neural_document_texture *texture)
{
    static const struct field FIELDS[] = {
        AT("name", read_string, struct slc_neural_document_texture, name),
        AT("firstChannel", read_u32, struct slc_neural_document_texture, first_channel),
        AT("numChannels", read_u32, struct slc_neural_document_texture, channel_count),
        AT("channelFormat", read_channel_format, struct slc_neural_document_texture, format),
        AT("rgbColorSpace", read_color_space, struct slc_neural_document_texture, rgb_color_space),
        AT("alphaColorSpace", read_color_space, struct slc_neural_document_texture,
           alpha_color_space),
        AT("bcFormat", read_bc_format, struct slc_neural_document_texture, bc_format),
    };
    *texture =
        (struct slc_neural_document_texture){.name = "", .format = SLUICE_NEURAL_CHANNEL_UNORM8};
    return READ_FIELDS(json, document, FIELDS, texture);
}

static bool read_textures(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)to;
    document->texture_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (document->texture_count == SLUICE_NEURAL_MAX_CHANNELS)
            return slc_json_fail(json, "there are more than 16 textures");
        read_texture(json, document, &document->textures[document->texture_count++]);
    }
    return !json->trouble;
}

static bool read_channels(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const struct field FIELDS[] = {{"colorSpace", read_color_space, 0}};
    (void)to;
    document->color_space_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (document->color_space_count == SLUICE_NEURAL_MAX_CHANNELS)
            return slc_json_fail(json, "there are more than 16 channels");
        uint32_t *space = &document->color_spaces[document->color_space_count++];
        *space = SLUICE_NEURAL_COLOR_LINEAR;
        READ_FIELDS(json, document, FIELDS, space);
    }
    return !json->trouble;
}

static bool read_layer_views(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    struct slc_neural_document_latents *latents = to;
    (void)document;
    latents->layer_view_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (latents->layer_view_count == SLC_NEURAL_MAX_LAYER_VIEWS)
            return slc_json_fail(json, "a latent image has more than 4 layers");
        slc_json_read_u32(json, &latents->layer_views[latents->layer_view_count++]);
    }
    return !json->trouble;
}

static bool read_latent(struct slc_json *json, struct slc_neural_document *document,
                        struct slc_neural_document_latents *latents)
{
    static const struct field FIELDS[] = {
        AT("width", read_u32, struct slc_neural_document_latents, width),
        AT("height", read_u32, struct slc_neural_document_latents, height),
        {"layerViews", read_layer_views, 0},
        AT("highResWidth", read_u32, struct slc_neural_document_latents, width),
        AT("highResHeight", read_u32, struct slc_neural_document_latents, height),
        AT("highResBitsPerPixel", read_u32, struct slc_neural_document_latents,
           high_bits_per_texel),
        AT("highResView", read_u32, struct slc_neural_document_latents, high_view),
        AT("lowResWidth", read_u32, struct slc_neural_document_latents, low_width),
        AT("lowResHeight", read_u32, struct slc_neural_document_latents, low_height),
        AT("lowResBitsPerPixel", read_u32, struct slc_neural_document_latents, low_bits_per_texel),
        AT("lowResView", read_u32, struct slc_neural_document_latents, low_view),
    };
    *latents = (struct slc_neural_document_latents){.high_view = SLC_NONE, .low_view = SLC_NONE};
    return READ_FIELDS(json, document, FIELDS, latents);
}

static bool read_latents(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)to;
    document->latent_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (document->latent_count == SLUICE_NEURAL_MAX_LATENT_IMAGES)
            return slc_json_fail(json, "there are more than 8 latent images");
        read_latent(json, document, &document->latents[document->latent_count++]);
    }
    return !json->trouble;
}

static bool read_mip(struct slc_json *json, struct slc_neural_document *document,
                     struct slc_neural_document_mip *mip)
{
    static const struct field FIELDS[] = {
        AT("width", read_u32, struct slc_neural_document_mip, width),
        AT("height", read_u32, struct slc_neural_document_mip, height),
        AT("latentMip", read_u32, struct slc_neural_document_mip, latent_mip),
        {"positionLod", read_lod, 0},
        {"positionScale", read_scale, 0},
    };
    *mip = (struct slc_neural_document_mip){.latent_mip = SLC_NONE};
    return READ_FIELDS(json, document, FIELDS, mip);
}

static bool read_mips(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)to;
    document->color_mip_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (document->color_mip_count == SLUICE_NEURAL_MAX_MIPS)
            return slc_json_fail(json, "there are more than 16 mips");
        read_mip(json, document, &document->mips[document->color_mip_count++]);
    }
    return !json->trouble;
}

static bool read_view(struct slc_json *json, struct slc_neural_document *document,
                      struct slc_neural_view *view)
{
    static const struct field FIELDS[] = {
        AT("offset", read_u64, struct slc_neural_view, offset),
        AT("storedSize", read_u64, struct slc_neural_view, stored_size),
        AT("compression", read_compression, struct slc_neural_view, is_compressed),
        AT("uncompressedSize", read_u64, struct slc_neural_view, size),
        AT("crc32", read_u32, struct slc_neural_view, crc),
    };
    *view = (struct slc_neural_view){0};
    return READ_FIELDS(json, document, FIELDS, view);
}

static bool reserve_view(struct slc_json *json, struct slc_neural_document *document)
{
    uint32_t capacity = document->view_capacity ? 2 * document->view_capacity : 64;
    if (document->view_count < document->view_capacity)
        return true;
    if (capacity > SLC_NEURAL_MAX_VIEWS)
        return slc_json_fail(json, "there are more than 4096 views");
    struct slc_neural_view *views = slc_regrow(&document->allocator, document->views,
                                               document->view_capacity, capacity, sizeof *views);
    document->is_out_of_memory = !views;
    if (!views)
        return slc_json_fail(json, "out of memory");
    document->views = views;
    document->view_capacity = capacity;
    return true;
}

static bool read_views(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    (void)to;
    document->view_count = 0;
    if (!slc_json_enter_array(json))
        return false;
    while (slc_json_next_element(json)) {
        if (!reserve_view(json, document))
            return false;
        read_view(json, document, &document->views[document->view_count++]);
    }
    return !json->trouble;
}

static bool read_shape(struct slc_json *json, struct slc_neural_document *document, void *to)
{
    static const struct field FIELDS[] = {
        AT("numFeatures", read_u32, struct slc_neural_document, features),
        AT("highResFeatures", read_u32, struct slc_neural_document, high_features),
        AT("highResQuantBits", read_u32, struct slc_neural_document, high_bits),
        AT("lowResFeatures", read_u32, struct slc_neural_document, low_features),
        AT("lowResQuantBits", read_u32, struct slc_neural_document, low_bits),
    };
    (void)to;
    return READ_FIELDS(json, document, FIELDS, document);
}

bool slc_neural_document_parse(struct slc_neural_document *document, struct slc_json *json)
{
    static const struct field FIELDS[] = {
        AT("schemaVersion", read_u32, struct slc_neural_document, schema),
        AT("width", read_u32, struct slc_neural_document, width),
        AT("height", read_u32, struct slc_neural_document, height),
        AT("numChannels", read_u32, struct slc_neural_document, channel_count),
        AT("numColorMips", read_u32, struct slc_neural_document, mip_count),
        {"latentShape", read_shape, 0},
        AT("mlp", read_mlp, struct slc_neural_document, mlp),
        {"mlpVersions", read_mlps, 0},
        {"textures", read_textures, 0},
        {"channels", read_channels, 0},
        {"latents", read_latents, 0},
        {"colorMips", read_mips, 0},
        {"views", read_views, 0},
    };
    document->mip_count = 1;
    return READ_FIELDS(json, document, FIELDS, document) && slc_json_end(json);
}

void slc_neural_document_finish(struct slc_neural_document *document)
{
    slc_free(&document->allocator, document->views, document->view_capacity,
             sizeof *document->views);
    document->views = NULL;
}
