#include "pbrt/parser.h"

#include "pbrt/color_values.h"

#include <string.h>

#define COLORS                                                                                     \
    (SLC_PBRT_TYPES(SLC_PBRT_RGB) | SLC_PBRT_TYPES(SLC_PBRT_XYZ) |                                 \
     SLC_PBRT_TYPES(SLC_PBRT_BLACKBODY) | SLC_PBRT_TYPES(SLC_PBRT_SPECTRUM))

static bool read_named_spectrum(struct slc_pbrt_parser *parser, const char *name, bool is_light,
                                const struct slc_pbrt_place *place, float rgb[3])
{
    if (is_light)
        rgb[0] = rgb[1] = rgb[2] = 1;
    else
        slc_pbrt_metal_rgb(name, rgb);
    return slc_pbrt_warn_once(parser, "spectrum", place,
                              "spectra of names and files are approximated");
}

static bool read_color(struct slc_pbrt_parser *parser, const struct slc_pbrt_parameter *p,
                       float rgb[3], bool is_light)
{
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    const union slc_pbrt_cell *cells = slc_pbrt_cells(parameters, p);
    switch (p->type) {
    case SLC_PBRT_RGB:
        for (int i = 0; i < 3; i++)
            rgb[i] = cells[i].number;
        return true;
    case SLC_PBRT_XYZ:
        slc_pbrt_xyz_to_rgb((const float[3]){cells[0].number, cells[1].number, cells[2].number},
                            rgb);
        return true;
    case SLC_PBRT_BLACKBODY:
        slc_pbrt_blackbody_rgb(cells[0].number, rgb);
        for (int i = 0; i < 3 && p->count >= 2; i++)
            rgb[i] *= cells[1].number;
        return true;
    default: break;
    }
    if (p->has_strings)
        return read_named_spectrum(parser, parameters->chars + cells[0].string, is_light, &p->place,
                                   rgb);
    if (p->count >= 2)
        slc_pbrt_sampled_rgb(&cells[0].number, p->count / 2, rgb);
    else
        rgb[0] = rgb[1] = rgb[2] = cells[0].number;
    return true;
}

bool slc_pbrt_read_color(struct slc_pbrt_parser *parser, const char *name, float rgb[3],
                         bool is_light)
{
    const struct slc_pbrt_parameter *p = slc_pbrt_find(&parser->parameters, COLORS, name);
    return p && read_color(parser, p, rgb, is_light);
}

static bool read_texture(struct slc_pbrt_parser *parser, const struct slc_pbrt_parameter *p,
                         bool is_float, SluicePbrtValue *value, bool *found)
{
    const char *texture = parser->parameters.chars + slc_pbrt_cells(&parser->parameters, p)->string;
    enum slc_pbrt_meaning meaning = is_float ? SLC_PBRT_FLOAT_TEXTURE : SLC_PBRT_COLOR_TEXTURE;
    uint32_t name, index;
    if (!slc_pbrt_intern(parser, texture, &name) ||
        !slc_pbrt_look_up(parser, name, meaning, &index))
        return false;
    *found = index != SLUICE_PBRT_NONE;
    if (!*found) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, &p->place,
                     "no %s texture has the name \"%s\": the default is taken",
                     is_float ? "float" : "color", texture);
        return true;
    }
    memcpy(value->value, parser->scene->textures[index].texture.value, sizeof value->value);
    value->texture = index;
    return true;
}

bool slc_pbrt_read_value(struct slc_pbrt_parser *parser, const char *name, bool is_float,
                         SluicePbrtValue *value, bool *found)
{
    const struct slc_pbrt_parameters *parameters = &parser->parameters;
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_TEXTURE), name);
    *found = false;
    if (p && (!read_texture(parser, p, is_float, value, found) || *found))
        return *found;
    /* Accept a float for a color, too, as pbrt-v4 does. */
    p = slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_FLOAT) | (is_float ? 0 : COLORS), name);
    if (!p)
        return true;
    *found = true;
    value->texture = SLUICE_PBRT_NONE;
    if (p->type != SLC_PBRT_FLOAT)
        return read_color(parser, p, value->value, false);
    for (int i = 0; i < 3; i++)
        value->value[i] = slc_pbrt_cells(parameters, p)->number;
    return true;
}
