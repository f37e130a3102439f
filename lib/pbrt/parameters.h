/** Parameters of one directive. */
#ifndef SLC_PBRT_PARAMETERS_H
#define SLC_PBRT_PARAMETERS_H

#include "pbrt/parsed_scene.h"

enum slc_pbrt_type {
    SLC_PBRT_FLOAT,
    SLC_PBRT_INTEGER,
    SLC_PBRT_BOOL,
    SLC_PBRT_POINT2, ///< also vector2
    SLC_PBRT_POINT3, ///< also vector3, point and vector
    SLC_PBRT_NORMAL,
    SLC_PBRT_RGB,
    SLC_PBRT_XYZ,
    SLC_PBRT_BLACKBODY,
    SLC_PBRT_SPECTRUM, ///< numbers or names
    SLC_PBRT_STRING,
    SLC_PBRT_TEXTURE,
    SLC_PBRT_TYPE_COUNT
};

#define SLC_PBRT_TYPES(type) (1u << (type))

union slc_pbrt_cell {
    float number;
    int32_t integer; ///< also bool: 0 or 1
    uint32_t string; ///< first byte in chars
};

struct slc_pbrt_parameter {
    enum slc_pbrt_type type;
    bool has_strings; ///< the cells of a spectrum are strings
    uint32_t name;    ///< first byte in chars
    size_t first;     ///< in cells
    size_t count;
    struct slc_pbrt_place place;
    uint32_t value_file;   ///< file of the first value
    uint64_t value_offset; ///< offset of the first value in the file's text
};

struct slc_pbrt_parameters {
    SluiceAllocationCallbacks allocator;
    struct slc_pbrt_parameter *list; ///< owned
    union slc_pbrt_cell *cells;      ///< owned
    char *chars;                     ///< owned
    size_t count, cell_count, char_count;
    size_t capacity, cell_capacity, char_capacity;
};

static inline void slc_pbrt_parameters_clear(struct slc_pbrt_parameters *parameters)
{
    parameters->count = parameters->cell_count = parameters->char_count = 0;
}
void slc_pbrt_parameters_finish(struct slc_pbrt_parameters *parameters);

/** Adds a cell. False: out of memory. */
bool slc_pbrt_add_cell(struct slc_pbrt_parameters *parameters, union slc_pbrt_cell cell);
/** Adds a string and a final 0. A byte of 0 in the string ends it early. */
bool slc_pbrt_add_string(struct slc_pbrt_parameters *parameters, const char *string, size_t length,
                         uint32_t *start);
/** Inserts all parameters of `from` before the parameters of `to`. */
bool slc_pbrt_prepend(struct slc_pbrt_parameters *to, const struct slc_pbrt_parameters *from);

/** Returns the type of a word, or SLC_PBRT_TYPE_COUNT. */
enum slc_pbrt_type slc_pbrt_type_of(const char *word, size_t length);
/** Returns the numbers per element; 1 for strings. */
uint32_t slc_pbrt_type_width(enum slc_pbrt_type type);

/** Returns the last parameter with a value, this name and one of these types, or NULL. */
const struct slc_pbrt_parameter *slc_pbrt_find(const struct slc_pbrt_parameters *parameters,
                                               uint32_t types, const char *name);
static inline const union slc_pbrt_cell *
slc_pbrt_cells(const struct slc_pbrt_parameters *parameters,
               const struct slc_pbrt_parameter *parameter)
{
    return parameters->cells + parameter->first;
}

float slc_pbrt_get_float(const struct slc_pbrt_parameters *parameters, const char *name,
                         float otherwise);
int32_t slc_pbrt_get_integer(const struct slc_pbrt_parameters *parameters, const char *name,
                             int32_t otherwise);
bool slc_pbrt_get_bool(const struct slc_pbrt_parameters *parameters, const char *name,
                       bool otherwise);
/** Returns a string, valid until a string is added. NULL: missing. */
const char *slc_pbrt_get_string(const struct slc_pbrt_parameters *parameters, const char *name);
/** Reads a point. If missing, `point` is unchanged. */
bool slc_pbrt_get_point(const struct slc_pbrt_parameters *parameters, const char *name,
                        double point[3]);

#endif /* SLC_PBRT_PARAMETERS_H */
