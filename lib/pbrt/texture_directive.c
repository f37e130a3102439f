#include "pbrt/parser.h"

#include "base/text_number.h"
#include "pbrt/growth.h"

#include <float.h>
#include <string.h>
#include <strings.h>

#define MAX_TEXTURES ((size_t)1 << 24)
#define MAX_TEXTURE_DEPTH 32u

static void set_all(float value[3], float to)
{
    value[0] = value[1] = value[2] = to;
}

static SluicePbrtValue constant(float value)
{
    return (SluicePbrtValue){{value, value, value}, SLUICE_PBRT_NONE};
}

static bool read_input(struct slc_pbrt_parser *parser, const SluicePbrtTexture *texture,
                       const char *name, SluicePbrtValue *input)
{
    bool found;
    return slc_pbrt_read_value(parser, name, texture->isFloat, input, &found);
}

static void read_mapping(struct slc_pbrt_parser *parser, SluicePbrtTexture *texture)
{
    static const char *const NAMES[] = {"uv", "planar", "spherical", "cylindrical"};
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    const char *mapping = slc_pbrt_get_string(parameters, "mapping");
    struct slc_pbrt_affine to_texture;
    double v1[3] = {1, 0, 0}, v2[3] = {0, 1, 0};
    for (int i = 0; mapping && i < 4; i++)
        if (strcmp(mapping, NAMES[i]) == 0)
            texture->mapping = (SluicePbrtMapping)i;
    texture->scale[0] = slc_pbrt_get_float(parameters, "uscale", 1);
    texture->scale[1] = slc_pbrt_get_float(parameters, "vscale", 1);
    texture->delta[0] = slc_pbrt_get_float(parameters, "udelta", 0);
    texture->delta[1] = slc_pbrt_get_float(parameters, "vdelta", 0);
    slc_pbrt_get_point(parameters, "v1", v1);
    slc_pbrt_get_point(parameters, "v2", v2);
    for (int i = 0; i < 3; i++) {
        texture->axes[i] = (float)v1[i];
        texture->axes[3 + i] = (float)v2[i];
    }
    if (!slc_pbrt_inverse(&parser->state.transform, &to_texture))
        to_texture = slc_pbrt_identity();
    slc_pbrt_to_floats(&to_texture, texture->worldToTexture);
}

static void read_filter(struct slc_pbrt_parser *parser, SluicePbrtTexture *texture)
{
    static const char *const WRAPS[] = {"repeat", "black", "clamp", "octahedralsphere"};
    static const char *const FILTERS[] = {"", "point", "bilinear", "trilinear", "EWA"};
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    const char *wrap = slc_pbrt_get_string(parameters, "wrap");
    const char *filter = slc_pbrt_get_string(parameters, "filter");
    const char *encoding = slc_pbrt_get_string(parameters, "encoding");
    for (int i = 0; wrap && i < 4; i++)
        if (strcmp(wrap, WRAPS[i]) == 0)
            texture->wrap = (SluicePbrtWrap)i;
    for (int i = 1; filter && i < 5; i++)
        if (strcasecmp(filter, FILTERS[i]) == 0)
            texture->filter = (SluicePbrtFilter)i;
    if (slc_pbrt_get_bool(parameters, "trilinear", false))
        texture->filter = SLUICE_PBRT_FILTER_TRILINEAR;
    if (slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_BOOL), "gamma"))
        texture->encoding = slc_pbrt_get_bool(parameters, "gamma", true)
                                ? SLUICE_PBRT_ENCODING_SRGB
                                : SLUICE_PBRT_ENCODING_LINEAR;
    if (encoding && strcasecmp(encoding, "srgb") == 0)
        texture->encoding = SLUICE_PBRT_ENCODING_SRGB;
    else if (encoding && strcmp(encoding, "linear") == 0)
        texture->encoding = SLUICE_PBRT_ENCODING_LINEAR;
    else if (encoding && strncmp(encoding, "gamma ", 6) == 0) {
        double gamma = 1;
        slc_read_number((const unsigned char *)encoding + 6, &gamma);
        texture->encoding = SLUICE_PBRT_ENCODING_GAMMA;
        texture->gamma = gamma > 0 && gamma <= FLT_MAX ? (float)gamma : 1;
    }
}

static bool has_known_extension(const char *path)
{
    static const char *const EXTENSIONS[] = {".png", ".tga",  ".exr",  ".pfm",   ".jpg",
                                             ".hdr", ".jpeg", ".bmp",  ".qoi",   ".tif",
                                             ".dds", ".ktx2", ".tiff", ".sluice"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof EXTENSIONS / sizeof *EXTENSIONS; i++)
        if (strcasecmp(dot, EXTENSIONS[i]) == 0)
            return true;
    return false;
}

/* Reads a picture, or a constant if the picture is missing. */
static bool read_image(struct slc_pbrt_parser *parser, struct slc_pbrt_texture_entry *entry,
                       const struct slc_pbrt_place *place)
{
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    SluicePbrtTexture *texture = &entry->texture;
    const char *file = slc_pbrt_get_string(parameters, "filename"), *trouble = NULL;
    struct slc_pbrt_stamp stamp;
    texture->imageScale = slc_pbrt_get_float(parameters, "scale", 1);
    texture->invert = slc_pbrt_get_bool(parameters, "invert", false);
    texture->maxAnisotropy = slc_pbrt_get_float(parameters, "maxanisotropy", 8);
    read_filter(parser, texture);
    set_all(texture->value, 0.5f);
    if (!file) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, place,
                     "the texture names no picture: it becomes gray");
        return true;
    }
    if (!slc_pbrt_intern_path(parser, file, &entry->image))
        return false;
    const char *path = slc_pbrt_name(&parser->scene->names, entry->image);
    if (!slc_pbrt_stamp_of(path, &stamp))
        trouble = "no such picture";
    else if (!has_known_extension(path))
        trouble = "pictures of this kind are not known";
    if (!trouble) {
        texture->kind = SLUICE_PBRT_TEXTURE_IMAGE;
        return true;
    }
    char key[256];
    size_t length = strlen(path) < sizeof key ? strlen(path) : sizeof key - 1;
    memcpy(key, path + strlen(path) - length, length);
    key[length] = 0;
    entry->image = SLUICE_PBRT_NONE;
    return slc_pbrt_warn_once(parser, key, place, "%s: %s; the texture becomes gray", key, trouble);
}

static bool read_scale(struct slc_pbrt_parser *parser, SluicePbrtTexture *texture)
{
    SluicePbrtValue *inputs = texture->inputs;
    texture->kind = SLUICE_PBRT_TEXTURE_SCALE;
    inputs[0] = inputs[1] = constant(1);
    if (!read_input(parser, texture, "tex1", &inputs[0]) ||
        !read_input(parser, texture, "tex", &inputs[0]) ||
        !read_input(parser, texture, "tex2", &inputs[1]))
        return false;
    bool found;
    /* In pbrt-v4, the scale is a float texture for all types. */
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(&parser->parameters, SLC_PBRT_TYPES(SLC_PBRT_TEXTURE), "scale");
    if (!slc_pbrt_read_value(parser, "scale", p || texture->isFloat, &inputs[1], &found))
        return false;
    for (int i = 0; i < 3; i++)
        texture->value[i] = inputs[0].value[i] * inputs[1].value[i];
    return true;
}

static bool read_mix(struct slc_pbrt_parser *parser, SluicePbrtTexture *texture)
{
    SluicePbrtValue *inputs = texture->inputs;
    bool found;
    texture->kind = SLUICE_PBRT_TEXTURE_MIX;
    inputs[0] = constant(0);
    inputs[1] = constant(1);
    texture->amount = constant(0.5f);
    if (!read_input(parser, texture, "tex1", &inputs[0]) ||
        !read_input(parser, texture, "tex2", &inputs[1]) ||
        !slc_pbrt_read_value(parser, "amount", true, &texture->amount, &found))
        return false;
    for (int i = 0; i < 3; i++)
        texture->value[i] = inputs[0].value[i] * (1 - texture->amount.value[i]) +
                            inputs[1].value[i] * texture->amount.value[i];
    return true;
}

static bool read_checkerboard(struct slc_pbrt_parser *parser, SluicePbrtTexture *texture)
{
    SluicePbrtValue *inputs = texture->inputs;
    texture->kind = SLUICE_PBRT_TEXTURE_CHECKERBOARD;
    inputs[0] = constant(1);
    inputs[1] = constant(0);
    if (!read_input(parser, texture, "tex1", &inputs[0]) ||
        !read_input(parser, texture, "tex2", &inputs[1]))
        return false;
    for (int i = 0; i < 3; i++)
        texture->value[i] = 0.5f * (inputs[0].value[i] + inputs[1].value[i]);
    return true;
}

/* Replaces textures of these kinds by their mean or a typical value. */
static bool read_mean(struct slc_pbrt_parser *parser, SluicePbrtTexture *texture, const char *kind,
                      const struct slc_pbrt_place *place)
{
    static const char *const CORNERS[] = {"v00", "v01", "v10", "v11"};
    SluicePbrtValue inside = constant(1), outside = constant(0);
    set_all(texture->value, 0.5f);
    if (strcmp(kind, "uv") == 0) {
        texture->value[2] = 0;
    } else if (strcmp(kind, "dots") == 0) {
        if (!read_input(parser, texture, "inside", &inside) ||
            !read_input(parser, texture, "outside", &outside))
            return false;
        for (int i = 0; i < 3; i++) /* a dot in half of the cells, with a tenth of their area */
            texture->value[i] = 0.2f * inside.value[i] + 0.8f * outside.value[i];
    } else if (strcmp(kind, "bilerp") == 0) {
        set_all(texture->value, 0);
        for (int i = 0; i < 4; i++) {
            SluicePbrtValue corner = constant(i & 1 ? 1 : 0);
            if (!read_input(parser, texture, CORNERS[i], &corner))
                return false;
            for (int j = 0; j < 3; j++)
                texture->value[j] += 0.25f * corner.value[j];
        }
    }
    char key[80] = "texture ";
    strncat(key, kind, sizeof key - strlen(key) - 1);
    return slc_pbrt_warn_once(parser, key, place,
                              "textures of the kind \"%s\" become their mean color", key + 8);
}

static bool read_kind(struct slc_pbrt_parser *parser, struct slc_pbrt_texture_entry *entry,
                      const char *kind, const struct slc_pbrt_place *place)
{
    SluicePbrtTexture *texture = &entry->texture;
    if (strcmp(kind, "imagemap") == 0)
        return read_image(parser, entry, place);
    if (strcmp(kind, "scale") == 0)
        return read_scale(parser, texture);
    if (strcmp(kind, "mix") == 0)
        return read_mix(parser, texture);
    if (strcmp(kind, "checkerboard") == 0)
        return read_checkerboard(parser, texture);
    if (strcmp(kind, "constant") != 0)
        return read_mean(parser, texture, kind, place);
    SluicePbrtValue value = constant(1);
    if (!read_input(parser, texture, "value", &value))
        return false;
    memcpy(texture->value, value.value, sizeof value.value);
    return true;
}

/* Replaces deeply nested textures by their mean, because renderers recurse into inputs. */
static bool limit_depth(struct slc_pbrt_parser *parser, struct slc_pbrt_texture_entry *entry,
                        const struct slc_pbrt_place *place)
{
    SluicePbrtTexture *texture = &entry->texture;
    const SluicePbrtValue *values[] = {&texture->inputs[0], &texture->inputs[1], &texture->amount};
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        if (values[i]->texture == SLUICE_PBRT_NONE)
            continue;
        uint32_t depth = parser->scene->textures[values[i]->texture].depth + 1;
        entry->depth = depth > entry->depth ? depth : entry->depth;
    }
    if (entry->depth <= MAX_TEXTURE_DEPTH)
        return true;
    texture->kind = SLUICE_PBRT_TEXTURE_CONSTANT;
    texture->inputs[0] = texture->inputs[1] = texture->amount = constant(0);
    entry->depth = 0;
    return slc_pbrt_warn_once(parser, "texture depth", place,
                              "textures nest more than %u deep: this one becomes its mean",
                              MAX_TEXTURE_DEPTH);
}

bool slc_pbrt_texture(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    SluicePbrtScene *scene = parser->scene;
    struct slc_pbrt_texture_entry entry = {.place = *place, .image = SLUICE_PBRT_NONE};
    uint32_t type, kind;
    bool found[3] = {false, false, false};
    char kind_text[64] = "";
    if (!slc_pbrt_read_name(parser, "name of the texture", &entry.name, &found[0]) ||
        (found[0] && !slc_pbrt_read_name(parser, "type of the texture", &type, &found[1])) ||
        (found[1] && !slc_pbrt_read_name(parser, "kind of the texture", &kind, &found[2])) ||
        !slc_pbrt_read_parameters_for(parser, SLC_PBRT_TARGET_TEXTURE))
        return false;
    if (!found[2])
        return true;
    entry.texture.isFloat = strcmp(slc_pbrt_name(&scene->names, type), "float") == 0;
    entry.texture.inputs[0] = entry.texture.inputs[1] = entry.texture.amount = constant(0);
    entry.texture.gamma = entry.texture.imageScale = 1;
    read_mapping(parser, &entry.texture);
    strncat(kind_text, slc_pbrt_name(&scene->names, kind), sizeof kind_text - 1);
    if (!read_kind(parser, &entry, kind_text, place) || !limit_depth(parser, &entry, place))
        return false;
    if (scene->texture_count >= MAX_TEXTURES)
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, place, "2^24 textures");
    if (!slc_pbrt_grow(&scene->allocator, &scene->textures, &scene->texture_capacity,
                       scene->texture_count + 1, sizeof *scene->textures))
        return slc_pbrt_out_of_memory(parser);
    scene->textures[scene->texture_count] = entry;
    return slc_pbrt_define(parser, entry.name,
                           entry.texture.isFloat ? SLC_PBRT_FLOAT_TEXTURE : SLC_PBRT_COLOR_TEXTURE,
                           (uint32_t)scene->texture_count++);
}
