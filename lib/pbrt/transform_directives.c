#include "pbrt/parser.h"

#include "pbrt/growth.h"

#include <math.h>
#include <string.h>

/* Replaces the current transform, unless the result is invalid. */
static bool set_transform(struct slc_pbrt_parser *parser, const struct slc_pbrt_affine *transform,
                          const struct slc_pbrt_place *place)
{
    if (parser->ignores_transforms)
        return true;
    if (!slc_pbrt_is_finite(transform)) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, place,
                     "numbers become too large: the transform is ignored");
        return true;
    }
    if (slc_pbrt_determinant(transform) == 0 && slc_pbrt_determinant(&parser->state.transform) != 0)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "singular transform: shapes become flat");
    parser->state.transform = *transform;
    return true;
}

static bool append_transform(struct slc_pbrt_parser *parser, const struct slc_pbrt_affine *by,
                             const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine product = slc_pbrt_product(&parser->state.transform, by);
    return set_transform(parser, &product, place);
}

bool slc_pbrt_identity_directive(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine identity = slc_pbrt_identity();
    return set_transform(parser, &identity, place);
}

bool slc_pbrt_translate(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine by = slc_pbrt_identity();
    double n[3];
    if (!slc_read_numbers(parser, n, 3, place))
        return false;
    for (int i = 0; i < 3; i++)
        by.m[i][3] = n[i];
    return append_transform(parser, &by, place);
}

bool slc_pbrt_scale(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine by = slc_pbrt_identity();
    double n[3];
    if (!slc_read_numbers(parser, n, 3, place))
        return false;
    for (int i = 0; i < 3; i++)
        by.m[i][i] = n[i];
    return append_transform(parser, &by, place);
}

bool slc_pbrt_rotate(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine by;
    double n[4];
    if (!slc_read_numbers(parser, n, 4, place))
        return false;
    if (slc_pbrt_rotation(n[0], n + 1, &by))
        return append_transform(parser, &by, place);
    slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, place,
                 "the axis has no length: the rotation is ignored");
    return true;
}

bool slc_pbrt_look_at_directive(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine by;
    double n[9];
    if (!slc_read_numbers(parser, n, 9, place))
        return false;
    if (slc_pbrt_look_at(n, n + 3, n + 6, &by))
        return append_transform(parser, &by, place);
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                 "view direction and up vector are parallel or 0: LookAt is ignored");
    return true;
}

/* Reads 16 numbers in columns. *usable: the bottom row is (0, 0, 0, s), s not 0. */
static bool read_matrix(struct slc_pbrt_parser *parser, struct slc_pbrt_affine *matrix,
                        const struct slc_pbrt_place *place, bool *usable)
{
    double n[16];
    if (!slc_read_numbers(parser, n, 16, place))
        return false;
    double scale = n[3] == 0 && n[7] == 0 && n[11] == 0 ? n[15] : 0;
    *usable = scale != 0;
    if (!*usable)
        slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, place,
                     "this matrix is no affine transform: it is ignored");
    for (int i = 0; *usable && i < 3; i++)
        for (int j = 0; j < 4; j++)
            matrix->m[i][j] = n[4 * j + i] / scale;
    return true;
}

bool slc_pbrt_transform(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine matrix;
    bool usable;
    return read_matrix(parser, &matrix, place, &usable) &&
           (!usable || set_transform(parser, &matrix, place));
}

bool slc_pbrt_concat_transform(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    struct slc_pbrt_affine matrix;
    bool usable;
    return read_matrix(parser, &matrix, place, &usable) &&
           (!usable || append_transform(parser, &matrix, place));
}

bool slc_pbrt_coordinate_system(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    uint32_t name;
    bool found;
    (void)place;
    if (!slc_pbrt_read_name(parser, "name", &name, &found) || !found)
        return parser->result == SLUICE_SUCCESS;
    if (!slc_pbrt_grow(&parser->scene->allocator, &parser->coordinates,
                       &parser->coordinate_capacity, parser->coordinate_count + 1,
                       sizeof *parser->coordinates))
        return slc_pbrt_out_of_memory(parser);
    struct slc_pbrt_meanings *meanings = slc_pbrt_meanings_of(parser, name);
    if (!meanings)
        return false;
    parser->coordinates[parser->coordinate_count] = parser->state.transform;
    meanings->last[SLC_PBRT_COORDINATES] = (uint32_t)parser->coordinate_count++;
    meanings->here[SLC_PBRT_COORDINATES] = SLUICE_PBRT_NONE;
    return true;
}

bool slc_pbrt_coord_sys_transform(struct slc_pbrt_parser *parser,
                                  const struct slc_pbrt_place *place)
{
    uint32_t name, index;
    bool found;
    if (!slc_pbrt_read_name(parser, "name", &name, &found) || !found)
        return parser->result == SLUICE_SUCCESS;
    if (!slc_pbrt_look_up(parser, name, SLC_PBRT_COORDINATES, &index))
        return false;
    if (index != SLUICE_PBRT_NONE) {
        struct slc_pbrt_affine transform = parser->coordinates[index];
        return set_transform(parser, &transform, place);
    }
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                 "the coordinate system \"%s\" is not known: the transform stays",
                 slc_pbrt_name(&parser->scene->names, name));
    return true;
}

bool slc_pbrt_active_transform(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    if (!slc_pbrt_take_token(parser))
        return false;
    const struct slc_pbrt_token *token = &parser->token;
    if (token->kind != SLC_PBRT_TOKEN_WORD) {
        parser->has_token = true;
        slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, place,
                     "All, StartTime or EndTime belongs behind ActiveTransform");
        return true;
    }
    parser->ignores_transforms =
        token->length == 7 && memcmp(token->text, "EndTime", token->length) == 0;
    return slc_pbrt_warn_once(parser, "ActiveTransform", place,
                              "motion is ignored: the start transforms are taken");
}

bool slc_pbrt_transform_times(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    double n[2];
    return slc_read_numbers(parser, n, 2, place);
}
