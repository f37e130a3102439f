#include "neural/file_text.h"

#include "base/alloc.h"
#include "base/checked.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <zlib.h>

static bool make_room(struct slc_neural_text *text, size_t size)
{
    size_t capacity = text->capacity ? text->capacity : 4096;
    while (capacity - text->size < size)
        capacity *= 2;
    if (text->failed || capacity == text->capacity)
        return !text->failed;
    char *grown = slc_regrow(&text->allocator, text->text, text->capacity, capacity, 1);
    text->failed = !grown;
    if (!grown)
        return false;
    text->text = grown;
    text->capacity = capacity;
    return true;
}

static void put_bytes(struct slc_neural_text *text, const char *bytes, size_t size)
{
    if (!make_room(text, size))
        return;
    memcpy(text->text + text->size, bytes, size);
    text->size += size;
}

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static void
put(struct slc_neural_text *text, const char *format, ...)
{
    char line[256];
    va_list arguments;
    va_start(arguments, format);
    int size = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    put_bytes(text, line, (size_t)size);
}

/* Appends a float with nine digits, which are exact. Replaces the locale's decimal point. */
static void put_float(struct slc_neural_text *text, float value)
{
    char line[32];
    int size = snprintf(line, sizeof line, "%.9g", (double)value);
    for (int i = 0; i < size; i++)
        if (!strchr("0123456789+-e", line[i]))
            line[i] = '.';
    put_bytes(text, line, (size_t)size);
}

static void put_string(struct slc_neural_text *text, const char *string)
{
    put_bytes(text, "\"", 1);
    for (; *string; string++) {
        unsigned char c = (unsigned char)*string;
        if (c < 0x20)
            put(text, "\\u%04x", c);
        else if (c == '"' || c == '\\')
            put(text, "\\%c", c);
        else
            put_bytes(text, string, 1);
    }
    put_bytes(text, "\"", 1);
}

void slc_neural_text_finish(struct slc_neural_text *text)
{
    slc_free(&text->allocator, text->text, text->capacity, 1);
    text->text = NULL;
}

static void put_mlp(struct slc_neural_text *text, const SluiceNeuralSet *set, bool is_fp8,
                    uint32_t *view)
{
    put(text, "{\"layers\":[");
    for (uint32_t i = 0; i < SLUICE_NEURAL_LAYERS; i++) {
        bool is_half = is_fp8 && i + 1 < SLUICE_NEURAL_LAYERS;
        put(text, "%s{\"inputChannels\":%u,\"outputChannels\":%u,\"weightView\":%u,", i ? "," : "",
            set->shape.inputs[i], set->shape.outputs[i], (*view)++);
        if (is_half)
            put(text, "\"biasView\":%u,\"weightType\":\"FloatE4M3\",\"biasType\":\"Float16\"}",
                (*view)++);
        else
            put(text,
                "\"scaleView\":%u,\"biasView\":%u,\"weightType\":\"Int8\",\"scaleType\":"
                "\"Float32\","
                "\"biasType\":\"Int32\"}",
                *view, *view + 1);
        *view += is_half ? 0 : 2;
    }
    put(text, "],\"activation\":\"HGELUClamp\",\"weightLayout\":\"RowMajor\"}");
}

/* Appends the networks. Schema 1 stores the INT8 network separately. */
static void put_mlps(struct slc_neural_text *text, const SluiceNeuralSet *set,
                     const struct slc_neural_pieces *pieces)
{
    uint32_t view = 0;
    bool is_apart = set->info.schema == 1 && pieces->has[SLUICE_NEURAL_WEIGHTS_INT8];
    if (is_apart) {
        put(text, "\"mlp\":");
        put_mlp(text, set, false, &view);
        put(text, ",");
    }
    put(text, "\"mlpVersions\":[");
    for (int kind = is_apart; kind < 2; kind++) {
        if (!pieces->has[kind])
            continue;
        if (kind && !is_apart && pieces->has[0])
            put(text, ",");
        put_mlp(text, set, kind, &view);
    }
    put(text, "],");
}

static const char *space_name(uint32_t space)
{
    static const char *const NAMES[] = {"Linear", "sRGB", "HLG"};
    return NAMES[space];
}

static void put_textures(struct slc_neural_text *text, const SluiceNeuralSet *set)
{
    static const char *const FORMATS[] = {"UNKNOWN", "UNORM8",  "UNORM16",
                                          "FLOAT16", "FLOAT32", "UINT32"};
    put(text, "\"textures\":[");
    for (uint32_t i = 0; i < set->info.textureCount; i++) {
        const struct slc_neural_document_texture *t = &set->textures[i];
        put(text, "%s{\"name\":", i ? "," : "");
        put_string(text, t->name);
        put(text, ",\"firstChannel\":%u,\"numChannels\":%u,\"channelFormat\":\"%s\"",
            t->first_channel, t->channel_count, FORMATS[t->format]);
        if (t->rgb_color_space)
            put(text, ",\"rgbColorSpace\":\"%s\"", space_name(t->rgb_color_space));
        if (t->alpha_color_space)
            put(text, ",\"alphaColorSpace\":\"%s\"", space_name(t->alpha_color_space));
        if (t->bc_format)
            put(text, ",\"bcFormat\":\"BC%u\"", t->bc_format);
        put(text, "}");
    }
    put(text, "],\"channels\":[");
    for (uint32_t i = 0; i < set->info.channelCount; i++)
        if (set->color_spaces[i])
            put(text, "%s{\"colorSpace\":\"%s\"}", i ? "," : "", space_name(set->color_spaces[i]));
        else
            put(text, "%s{}", i ? "," : "");
    put(text, "],");
}

static void put_latent_1(struct slc_neural_text *text, const struct slc_neural_grid *grid,
                         uint32_t view)
{
    put(text,
        "{\"highResWidth\":%u,\"highResHeight\":%u,\"lowResWidth\":%u,\"lowResHeight\":%u,"
        "\"highResBitsPerPixel\":%u,\"lowResBitsPerPixel\":%u,",
        grid[0].width, grid[0].height, grid[1].width, grid[1].height,
        grid[0].features * grid[0].bits, grid[1].features * grid[1].bits);
    put(text, "\"highResView\":%u,\"lowResView\":%u}", view, view + 1);
}

static void put_latent_3(struct slc_neural_text *text, const struct slc_neural_grid *grid,
                         uint32_t view)
{
    put(text, "{\"width\":%u,\"height\":%u,\"layerViews\":[", grid->width, grid->height);
    for (uint32_t i = 0; i < grid->part_count; i++)
        put(text, "%s%u", i ? "," : "", view + i);
    put(text, "]}");
}

static void put_latents(struct slc_neural_text *text, const SluiceNeuralSet *set, uint32_t view)
{
    bool is_one = set->info.schema == 1;
    put(text, "\"latents\":[");
    for (uint32_t n = 0; n < set->info.latentImageCount; n++) {
        put(text, "%s", n ? "," : "");
        if (is_one)
            put_latent_1(text, &set->grids[2 * n], view);
        else
            put_latent_3(text, &set->grids[n], view);
        view += is_one ? 2 : set->grids[n].part_count;
    }
    put(text, "],\"colorMips\":[");
    for (uint32_t i = 0; i < set->info.mipCount; i++) {
        const struct slc_neural_mip *mip = &set->mips[i];
        put(text, "%s{\"width\":%u,\"height\":%u,\"latentMip\":%u,\"positionLod\":", i ? "," : "",
            mip->width, mip->height, is_one ? mip->first_grid / 2 : mip->first_grid);
        put_float(text, mip->position_lod);
        put(text, ",\"positionScale\":");
        put_float(text, mip->position_scale);
        put(text, "}");
    }
    put(text, "],");
}

static void put_views(struct slc_neural_text *text, const struct slc_neural_pieces *pieces)
{
    uint64_t offset = 0;
    put(text, "\"views\":[");
    for (uint32_t i = 0; i < pieces->count; i++) {
        const struct slc_neural_piece *piece = &pieces->pieces[i];
        put(text, "%s{\"offset\":%llu,\"storedSize\":%llu", i ? "," : "",
            (unsigned long long)offset, (unsigned long long)piece->size);
        if (piece->has_checksum)
            put(text, ",\"crc32\":%lu", crc32_z(0, piece->bytes, (size_t)piece->size));
        put(text, "}");
        offset += (piece->size + 3) / 4 * 4;
    }
    put(text, "]}");
}

void slc_neural_describe(struct slc_neural_text *text, const SluiceNeuralSet *set,
                         const struct slc_neural_pieces *pieces)
{
    const SluiceNeuralSetInfo *info = &set->info;
    put(text,
        "{\"schemaVersion\":%u,\"width\":%u,\"height\":%u,\"numChannels\":%u,"
        "\"numColorMips\":%u,\"latentShape\":{",
        info->schema, info->width, info->height, info->channelCount, info->mipCount);
    if (info->schema == 3)
        put(text, "\"numFeatures\":%u},", info->highFeatures);
    else
        put(text,
            "\"highResFeatures\":%u,\"highResQuantBits\":%u,\"lowResFeatures\":%u,"
            "\"lowResQuantBits\":%u},",
            info->highFeatures, info->highBits, info->lowFeatures, info->lowBits);
    put_mlps(text, set, pieces);
    put_textures(text, set);
    put_latents(text, set, pieces->first_latent);
    put_views(text, pieces);
    put_bytes(text, "", 1);
}
