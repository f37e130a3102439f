#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <stdlib.h>
#include <string.h>

enum where {
    ANYWHERE,
    IN_OPTIONS, ///< before WorldBegin
    IN_WORLD
};

static bool world_begin(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    (void)place;
    uint32_t name;
    parser->in_world = true;
    parser->state.transform = slc_pbrt_identity();
    if (!slc_pbrt_grow(&parser->scene->allocator, &parser->coordinates,
                       &parser->coordinate_capacity, parser->coordinate_count + 1,
                       sizeof *parser->coordinates))
        return slc_pbrt_out_of_memory(parser);
    parser->coordinates[parser->coordinate_count] = slc_pbrt_identity();
    return slc_pbrt_intern(parser, "world", &name) &&
           slc_pbrt_define(parser, name, SLC_PBRT_COORDINATES,
                           (uint32_t)parser->coordinate_count++);
}

static bool world_end(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    (void)place;
    slc_pbrt_close_blocks(parser, 0);
    parser->in_world = false;
    parser->after_world = parser->has_world_end = true;
    return true;
}

/* A name and one value, which a preview does not need. */
static bool option(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t name;
    bool found, in_brackets = false;
    if (!slc_pbrt_read_name(parser, "name of the option", &name, &found))
        return false;
    while (found && slc_pbrt_take_token(parser)) {
        enum slc_pbrt_token_kind kind = parser->token.kind;
        if (kind == SLC_PBRT_TOKEN_END || kind == SLC_PBRT_TOKEN_FILE_END)
            return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, place,
                                 "the file ends where a value belongs");
        in_brackets |= kind == SLC_PBRT_TOKEN_OPEN;
        if (!in_brackets || kind == SLC_PBRT_TOKEN_CLOSE)
            return true;
    }
    return parser->result == SLUICE_SUCCESS;
}

static bool ignored_type(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t name;
    bool found;
    (void)place;
    return slc_pbrt_read_name(parser, "type", &name, &found) && slc_pbrt_read_parameters(parser);
}

/* One string or two, and no parameters. */
static bool medium_interface(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    if (!slc_pbrt_warn_once(parser, "MediumInterface", place, "media are ignored"))
        return false;
    for (int i = 0; i < 2; i++) {
        if (!slc_pbrt_take_token(parser))
            return false;
        if (parser->token.kind != SLC_PBRT_TOKEN_STRING) {
            parser->has_token = true;
            return true;
        }
    }
    return true;
}

static bool make_named_medium(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    return slc_pbrt_warn_once(parser, "MediumInterface", place, "media are ignored") &&
           ignored_type(parser, place);
}

static bool color_space(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t name;
    bool found;
    if (!slc_pbrt_read_name(parser, "name of the color space", &name, &found))
        return false;
    if (!found || strcmp(slc_pbrt_name(&parser->scene->names, name), "srgb") == 0)
        return true;
    return slc_pbrt_warn_once(parser, "ColorSpace", place,
                              "color spaces other than srgb are ignored");
}

static bool include(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t name;
    bool found;
    if (!slc_pbrt_read_name(parser, "file name", &name, &found))
        return false;
    return !found ||
           slc_pbrt_enter_file(parser, slc_pbrt_name(&parser->scene->names, name), false, place);
}

static bool import(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t name;
    bool found;
    if (!slc_pbrt_read_name(parser, "file name", &name, &found))
        return false;
    return !found ||
           slc_pbrt_enter_file(parser, slc_pbrt_name(&parser->scene->names, name), true, place);
}

/* Sorted by word. */
static const struct directive {
    const char *word;
    slc_pbrt_directive *read;
    enum where where;
} DIRECTIVES[] = {
    {"Accelerator", ignored_type, IN_OPTIONS},
    {"ActiveTransform", slc_pbrt_active_transform, ANYWHERE},
    {"AreaLightSource", slc_pbrt_area_light_source, IN_WORLD},
    {"Attribute", slc_pbrt_attribute_directive, ANYWHERE},
    {"AttributeBegin", slc_pbrt_attribute_begin, IN_WORLD},
    {"AttributeEnd", slc_pbrt_attribute_end, IN_WORLD},
    {"Camera", slc_pbrt_camera, IN_OPTIONS},
    {"ColorSpace", color_space, ANYWHERE},
    {"ConcatTransform", slc_pbrt_concat_transform, ANYWHERE},
    {"CoordSysTransform", slc_pbrt_coord_sys_transform, ANYWHERE},
    {"CoordinateSystem", slc_pbrt_coordinate_system, ANYWHERE},
    {"Film", slc_pbrt_film, IN_OPTIONS},
    {"Identity", slc_pbrt_identity_directive, ANYWHERE},
    {"Import", import, ANYWHERE},
    {"Include", include, ANYWHERE},
    {"Integrator", ignored_type, IN_OPTIONS},
    {"LightSource", slc_pbrt_light_source, IN_WORLD},
    {"LookAt", slc_pbrt_look_at_directive, ANYWHERE},
    {"MakeNamedMaterial", slc_pbrt_make_named_material, ANYWHERE},
    {"MakeNamedMedium", make_named_medium, ANYWHERE},
    {"Material", slc_pbrt_material, IN_WORLD},
    {"MediumInterface", medium_interface, ANYWHERE},
    {"NamedMaterial", slc_pbrt_named_material, IN_WORLD},
    {"ObjectBegin", slc_pbrt_object_begin, IN_WORLD},
    {"ObjectEnd", slc_pbrt_object_end, IN_WORLD},
    {"ObjectInstance", slc_pbrt_object_instance, IN_WORLD},
    {"Option", option, ANYWHERE},
    {"PixelFilter", ignored_type, IN_OPTIONS},
    {"Renderer", ignored_type, IN_OPTIONS},
    {"ReverseOrientation", slc_pbrt_reverse_orientation, IN_WORLD},
    {"Rotate", slc_pbrt_rotate, ANYWHERE},
    {"Sampler", ignored_type, IN_OPTIONS},
    {"Scale", slc_pbrt_scale, ANYWHERE},
    {"Shape", slc_pbrt_shape, IN_WORLD},
    {"SurfaceIntegrator", ignored_type, IN_OPTIONS},
    {"Texture", slc_pbrt_texture, ANYWHERE},
    {"Transform", slc_pbrt_transform, ANYWHERE},
    {"TransformBegin", slc_pbrt_transform_begin, IN_WORLD},
    {"TransformEnd", slc_pbrt_transform_end, IN_WORLD},
    {"TransformTimes", slc_pbrt_transform_times, ANYWHERE},
    {"Translate", slc_pbrt_translate, ANYWHERE},
    {"VolumeIntegrator", ignored_type, IN_OPTIONS},
    {"WorldBegin", world_begin, IN_OPTIONS},
    {"WorldEnd", world_end, IN_WORLD},
};

static int compare_words(const void *key, const void *member)
{
    const struct slc_pbrt_token *token = key;
    const struct directive *directive = member;
    size_t length = strlen(directive->word); /* the token may have bytes of 0 */
    int order =
        memcmp(token->text, directive->word, length < token->length ? length : token->length);
    return order ? order : (token->length > length) - (token->length < length);
}

/* Skips values behind a word that is not known: everything up to the next word that is no value. */
static bool skip_unknown(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    bool in_brackets = false;
    for (;;) {
        if (!slc_pbrt_take_token(parser))
            return false;
        const struct slc_pbrt_token *token = &parser->token;
        switch (token->kind) {
        case SLC_PBRT_TOKEN_OPEN: in_brackets = true; break;
        case SLC_PBRT_TOKEN_CLOSE: in_brackets = false; break;
        case SLC_PBRT_TOKEN_STRING: break;
        case SLC_PBRT_TOKEN_WORD:
            if (!in_brackets && ((token->text[0] | 32) >= 'a' && (token->text[0] | 32) <= 'z') &&
                !(token->length == 4 && memcmp(token->text, "true", 4) == 0) &&
                !(token->length == 5 && memcmp(token->text, "false", 5) == 0)) {
                parser->has_token = true;
                return true;
            }
            break;
        default:
            if (in_brackets)
                return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, place,
                                     "the file ends inside of brackets");
            parser->has_token = true;
            return true;
        }
    }
}

static bool say_unknown(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    const struct slc_pbrt_token *token = &parser->token;
    char word[40];
    size_t length = token->length < sizeof word - 1 ? token->length : sizeof word - 1;
    for (size_t i = 0; i < token->length; i++)
        if ((unsigned char)token->text[i] < ' ' || (unsigned char)token->text[i] >= 127)
            return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, place,
                                 "this is no text of a scene");
    memcpy(word, token->text, length);
    word[length] = 0;
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                 "%s is no directive: it and its parameters are ignored", word);
    return skip_unknown(parser, place);
}

bool slc_pbrt_read_directive(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    const struct directive *directive =
        bsearch(&parser->token, DIRECTIVES, sizeof DIRECTIVES / sizeof *DIRECTIVES,
                sizeof *DIRECTIVES, compare_words);
    if (!directive)
        return say_unknown(parser, place);
    if (directive->where == IN_WORLD && !parser->in_world) {
        return slc_pbrt_warn_once(parser, directive->word, place,
                                  "%s before WorldBegin is ignored, here and later",
                                  directive->word) &&
               skip_unknown(parser, place);
    }
    if (directive->where == IN_OPTIONS && parser->in_world) {
        return slc_pbrt_warn_once(parser, directive->word, place,
                                  "%s after WorldBegin is ignored, here and later",
                                  directive->word) &&
               skip_unknown(parser, place);
    }
    return directive->read(parser, place);
}
