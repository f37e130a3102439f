#include "pbrt/parameters.h"

#include "pbrt/growth.h"

#include <string.h>

static const struct {
    const char *word;
    enum slc_pbrt_type type;
} TYPES[] = {
    {"float", SLC_PBRT_FLOAT},         {"integer", SLC_PBRT_INTEGER},
    {"bool", SLC_PBRT_BOOL},           {"point2", SLC_PBRT_POINT2},
    {"vector2", SLC_PBRT_POINT2},      {"point3", SLC_PBRT_POINT3},
    {"vector3", SLC_PBRT_POINT3},      {"point", SLC_PBRT_POINT3},
    {"vector", SLC_PBRT_POINT3},       {"normal3", SLC_PBRT_NORMAL},
    {"normal", SLC_PBRT_NORMAL},       {"rgb", SLC_PBRT_RGB},
    {"color", SLC_PBRT_RGB},           {"xyz", SLC_PBRT_XYZ},
    {"blackbody", SLC_PBRT_BLACKBODY}, {"spectrum", SLC_PBRT_SPECTRUM},
    {"string", SLC_PBRT_STRING},       {"texture", SLC_PBRT_TEXTURE},
};

enum slc_pbrt_type slc_pbrt_type_of(const char *word, size_t length)
{
    for (size_t i = 0; i < sizeof TYPES / sizeof *TYPES; i++)
        if (strlen(TYPES[i].word) == length && memcmp(TYPES[i].word, word, length) == 0)
            return TYPES[i].type;
    return SLC_PBRT_TYPE_COUNT;
}

uint32_t slc_pbrt_type_width(enum slc_pbrt_type type)
{
    switch (type) {
    case SLC_PBRT_POINT2: return 2;
    case SLC_PBRT_POINT3:
    case SLC_PBRT_NORMAL:
    case SLC_PBRT_RGB:
    case SLC_PBRT_XYZ: return 3;
    default: return 1;
    }
}

void slc_pbrt_parameters_finish(struct slc_pbrt_parameters *parameters)
{
    const SluiceAllocationCallbacks *cb = &parameters->allocator;
    slc_free(cb, parameters->list, parameters->capacity, sizeof *parameters->list);
    slc_free(cb, parameters->cells, parameters->cell_capacity, sizeof *parameters->cells);
    slc_free(cb, parameters->chars, parameters->char_capacity, 1);
    parameters->list = NULL;
    parameters->cells = NULL;
    parameters->chars = NULL;
    parameters->capacity = parameters->cell_capacity = parameters->char_capacity = 0;
    slc_pbrt_parameters_clear(parameters);
}

bool slc_pbrt_add_cell(struct slc_pbrt_parameters *parameters, union slc_pbrt_cell cell)
{
    if (!slc_pbrt_grow(&parameters->allocator, &parameters->cells, &parameters->cell_capacity,
                       parameters->cell_count + 1, sizeof *parameters->cells))
        return false;
    parameters->cells[parameters->cell_count++] = cell;
    return true;
}

bool slc_pbrt_add_string(struct slc_pbrt_parameters *parameters, const char *string, size_t length,
                         uint32_t *start)
{
    if (parameters->char_count + length + 1 > UINT32_MAX ||
        !slc_pbrt_grow(&parameters->allocator, &parameters->chars, &parameters->char_capacity,
                       parameters->char_count + length + 1, 1))
        return false;
    *start = (uint32_t)parameters->char_count;
    memcpy(parameters->chars + *start, string, length);
    parameters->chars[*start + length] = 0;
    parameters->char_count += length + 1;
    return true;
}

static bool holds_strings(const struct slc_pbrt_parameter *parameter)
{
    return parameter->type == SLC_PBRT_STRING || parameter->type == SLC_PBRT_TEXTURE ||
           parameter->has_strings;
}

bool slc_pbrt_prepend(struct slc_pbrt_parameters *to, const struct slc_pbrt_parameters *from)
{
    const SluiceAllocationCallbacks *cb = &to->allocator;
    if (from->count == 0)
        return true;
    if (to->char_count + from->char_count > UINT32_MAX ||
        !slc_pbrt_grow(cb, &to->list, &to->capacity, to->count + from->count, sizeof *to->list) ||
        !slc_pbrt_grow(cb, &to->cells, &to->cell_capacity, to->cell_count + from->cell_count,
                       sizeof *to->cells) ||
        !slc_pbrt_grow(cb, &to->chars, &to->char_capacity, to->char_count + from->char_count, 1))
        return false;
    memmove(to->list + from->count, to->list, to->count * sizeof *to->list);
    for (size_t i = 0; i < from->count; i++) {
        struct slc_pbrt_parameter parameter = from->list[i];
        for (size_t j = 0; j < parameter.count; j++) {
            union slc_pbrt_cell cell = from->cells[parameter.first + j];
            if (holds_strings(&parameter))
                cell.string += (uint32_t)to->char_count;
            to->cells[to->cell_count + parameter.first + j] = cell;
        }
        parameter.name += (uint32_t)to->char_count;
        parameter.first += to->cell_count;
        to->list[i] = parameter;
    }
    if (from->char_count)
        memcpy(to->chars + to->char_count, from->chars, from->char_count);
    to->count += from->count;
    to->cell_count += from->cell_count;
    to->char_count += from->char_count;
    return true;
}

const struct slc_pbrt_parameter *slc_pbrt_find(const struct slc_pbrt_parameters *parameters,
                                               uint32_t types, const char *name)
{
    for (size_t i = parameters->count; i-- > 0;) {
        const struct slc_pbrt_parameter *p = &parameters->list[i];
        if (types & SLC_PBRT_TYPES(p->type) && p->count >= slc_pbrt_type_width(p->type) &&
            strcmp(parameters->chars + p->name, name) == 0)
            return p;
    }
    return NULL;
}

float slc_pbrt_get_float(const struct slc_pbrt_parameters *parameters, const char *name,
                         float otherwise)
{
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_FLOAT), name);
    return p ? slc_pbrt_cells(parameters, p)->number : otherwise;
}

int32_t slc_pbrt_get_integer(const struct slc_pbrt_parameters *parameters, const char *name,
                             int32_t otherwise)
{
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_INTEGER), name);
    return p ? slc_pbrt_cells(parameters, p)->integer : otherwise;
}

bool slc_pbrt_get_bool(const struct slc_pbrt_parameters *parameters, const char *name,
                       bool otherwise)
{
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_BOOL), name);
    return p ? slc_pbrt_cells(parameters, p)->integer != 0 : otherwise;
}

const char *slc_pbrt_get_string(const struct slc_pbrt_parameters *parameters, const char *name)
{
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_STRING), name);
    return p ? parameters->chars + slc_pbrt_cells(parameters, p)->string : NULL;
}

bool slc_pbrt_get_point(const struct slc_pbrt_parameters *parameters, const char *name,
                        double point[3])
{
    const struct slc_pbrt_parameter *p =
        slc_pbrt_find(parameters, SLC_PBRT_TYPES(SLC_PBRT_POINT3), name);
    for (int i = 0; p && i < 3; i++)
        point[i] = slc_pbrt_cells(parameters, p)[i].number;
    return p != NULL;
}
