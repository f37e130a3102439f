#include "pbrt/ply_header.h"

#include <string.h>

#define MAX_LINE 512u
#define MAX_LINES 4096u

uint32_t slc_pbrt_ply_size(enum slc_pbrt_ply_type type)
{
    static const uint8_t SIZES[] = {1, 1, 2, 2, 4, 4, 4, 8, 0};
    return SIZES[type];
}

static enum slc_pbrt_ply_type type_of(const char *word)
{
    static const char *const NAMES[][2] = {
        {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
        {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
    for (int i = 0; i < SLC_PBRT_PLY_NO_TYPE; i++)
        if (strcmp(word, NAMES[i][0]) == 0 || strcmp(word, NAMES[i][1]) == 0)
            return (enum slc_pbrt_ply_type)i;
    return SLC_PBRT_PLY_NO_TYPE;
}

static enum slc_pbrt_ply_role vertex_role(const char *word)
{
    static const struct {
        const char *name;
        enum slc_pbrt_ply_role role;
    } ROLES[] = {
        {"x", SLC_PBRT_PLY_X},         {"y", SLC_PBRT_PLY_Y},         {"z", SLC_PBRT_PLY_Z},
        {"nx", SLC_PBRT_PLY_NX},       {"ny", SLC_PBRT_PLY_NY},       {"nz", SLC_PBRT_PLY_NZ},
        {"u", SLC_PBRT_PLY_U},         {"s", SLC_PBRT_PLY_U},         {"texture_u", SLC_PBRT_PLY_U},
        {"texture_s", SLC_PBRT_PLY_U}, {"v", SLC_PBRT_PLY_V},         {"t", SLC_PBRT_PLY_V},
        {"texture_v", SLC_PBRT_PLY_V}, {"texture_t", SLC_PBRT_PLY_V},
    };
    for (size_t i = 0; i < sizeof ROLES / sizeof *ROLES; i++)
        if (strcmp(word, ROLES[i].name) == 0)
            return ROLES[i].role;
    return SLC_PBRT_PLY_NO_ROLE;
}

/* Reads a line without its end. False: no line, or too long. */
static bool read_line(struct slc_pbrt_window *window, char line[MAX_LINE])
{
    size_t length = 0;
    char c;
    while (slc_pbrt_window_take(window, &c, 1)) {
        if (c == '\n') {
            while (length > 0 && (line[length - 1] == '\r' || line[length - 1] == ' ' ||
                                  line[length - 1] == '\t'))
                length--;
            line[length] = 0;
            return true;
        }
        if (length + 1 >= MAX_LINE)
            return false;
        line[length++] = c;
    }
    return false;
}

/* Splits a line into words. Returns their number, at most `most`. */
static uint32_t split(char *line, char *words[], uint32_t most)
{
    uint32_t count = 0;
    for (char *c = line; *c && count < most;) {
        while (*c == ' ' || *c == '\t')
            *c++ = 0;
        if (*c)
            words[count++] = c;
        while (*c && *c != ' ' && *c != '\t')
            c++;
    }
    if (count)
        words[count - 1][strcspn(words[count - 1], " \t")] = 0;
    return count;
}

static bool read_count(const char *word, uint64_t *count)
{
    *count = 0;
    if (!*word)
        return false;
    for (; *word >= '0' && *word <= '9' && *count < UINT64_MAX / 20; word++)
        *count = 10 * *count + (uint64_t)(*word - '0');
    return !*word;
}

static const char *add_element(struct slc_pbrt_ply_header *header, char *words[], uint32_t count)
{
    if (header->element_count == SLC_PBRT_PLY_MAX_ELEMENTS)
        return "more than 16 elements";
    uint32_t index = header->element_count++;
    struct slc_pbrt_ply_element *element = &header->elements[index];
    *element = (struct slc_pbrt_ply_element){0};
    if (count != 3 || !read_count(words[2], &element->count))
        return "an element without a name or a count";
    if (strcmp(words[1], "vertex") == 0 && header->vertex_element == UINT32_MAX) {
        element->is_vertex = true;
        header->vertex_element = index;
    } else if (strcmp(words[1], "face") == 0 && header->face_element == UINT32_MAX) {
        element->is_face = true;
        header->face_element = index;
    }
    return NULL;
}

static const char *add_property(struct slc_pbrt_ply_header *header, char *words[], uint32_t count)
{
    if (header->element_count == 0)
        return "a property without an element";
    struct slc_pbrt_ply_element *element = &header->elements[header->element_count - 1];
    if (element->property_count == SLC_PBRT_PLY_MAX_PROPERTIES)
        return "more than 64 properties";
    bool is_list = count == 5 && strcmp(words[1], "list") == 0;
    if (!is_list && count != 3)
        return "a property that is not understood";
    struct slc_pbrt_ply_property property = {.type = type_of(words[count - 2]),
                                             .count_type =
                                                 is_list ? type_of(words[2]) : SLC_PBRT_PLY_NO_TYPE,
                                             .role = SLC_PBRT_PLY_NO_ROLE};
    if (property.type == SLC_PBRT_PLY_NO_TYPE ||
        (is_list && property.count_type >= SLC_PBRT_PLY_FLOAT))
        return "a property of a type that is not known";
    const char *name = words[count - 1];
    if (element->is_vertex && !is_list)
        property.role = vertex_role(name);
    else if (element->is_face && is_list &&
             (strcmp(name, "vertex_indices") == 0 || strcmp(name, "vertex_index") == 0))
        property.role = SLC_PBRT_PLY_INDICES;
    if (property.role < SLC_PBRT_PLY_INDICES)
        header->roles |= 1u << property.role;
    element->properties[element->property_count++] = property;
    return NULL;
}

/* Returns the fewest bytes of an element. A text file's last line may have no end. */
static uint64_t least_size(const struct slc_pbrt_ply_header *header,
                           const struct slc_pbrt_ply_element *element)
{
    uint64_t size = 0;
    if (header->format == SLC_PBRT_PLY_ASCII)
        return 2 * (uint64_t)element->property_count;
    for (uint32_t i = 0; i < element->property_count; i++) {
        const struct slc_pbrt_ply_property *p = &element->properties[i];
        size += slc_pbrt_ply_size(p->count_type < SLC_PBRT_PLY_NO_TYPE ? p->count_type : p->type);
    }
    return size;
}

static const char *check_sizes(const struct slc_pbrt_window *window,
                               struct slc_pbrt_ply_header *header)
{
    uint64_t left = slc_pbrt_window_left(window);
    left += left < UINT64_MAX; /* the end of the last line */
    for (uint32_t i = 0; i < header->element_count; i++) {
        struct slc_pbrt_ply_element *element = &header->elements[i];
        uint64_t size = least_size(header, element);
        element->stride = (uint32_t)size;
        for (uint32_t j = 0; j < element->property_count; j++)
            if (element->properties[j].count_type < SLC_PBRT_PLY_NO_TYPE)
                element->stride = 0;
        if (element->count && !size)
            return "an element without properties";
        if (element->count && element->count > left / size)
            return "more elements are announced than the file has bytes for";
        left -= left < UINT64_MAX ? element->count * size : 0;
    }
    return NULL;
}

static const char *check_header(const struct slc_pbrt_window *window,
                                struct slc_pbrt_ply_header *header)
{
    const uint32_t xyz = 1u << SLC_PBRT_PLY_X | 1u << SLC_PBRT_PLY_Y | 1u << SLC_PBRT_PLY_Z;
    if (header->vertex_element == UINT32_MAX || header->elements[header->vertex_element].count == 0)
        return "no vertices";
    if ((header->roles & xyz) != xyz)
        return "vertices without x, y and z";
    if (header->elements[header->vertex_element].count > INT32_MAX)
        return "more than 2^31 - 1 vertices";
    if (header->face_element == UINT32_MAX || header->elements[header->face_element].count == 0)
        return "no faces";
    const struct slc_pbrt_ply_element *faces = &header->elements[header->face_element];
    for (uint32_t i = 0; i < faces->property_count; i++)
        if (faces->properties[i].role == SLC_PBRT_PLY_INDICES)
            return check_sizes(window, header);
    return "faces without vertex_indices";
}

static const char *read_format(struct slc_pbrt_ply_header *header, char *words[], uint32_t count)
{
    static const char *const FORMATS[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    for (int i = 0; count >= 2 && i < 3; i++)
        if (strcmp(words[1], FORMATS[i]) == 0) {
            header->format = (enum slc_pbrt_ply_format)i;
            return NULL;
        }
    return "a format that is not known";
}

const char *slc_pbrt_ply_read_header(struct slc_pbrt_window *window,
                                     struct slc_pbrt_ply_header *header)
{
    char line[MAX_LINE], *words[6];
    bool has_format = false;
    header->element_count = header->roles = 0;
    header->vertex_element = header->face_element = UINT32_MAX;
    if (!read_line(window, line) || strcmp(line, "ply") != 0)
        return "no PLY file";
    for (uint32_t i = 0; i < MAX_LINES; i++) {
        const char *trouble = NULL;
        if (!read_line(window, line))
            return "the header has no end";
        uint32_t count = split(line, words, 6);
        if (count == 0 || strcmp(words[0], "comment") == 0 || strcmp(words[0], "obj_info") == 0)
            continue;
        if (strcmp(words[0], "end_header") == 0)
            return has_format ? check_header(window, header) : "no format";
        if (strcmp(words[0], "format") == 0) {
            trouble = read_format(header, words, count);
            has_format = true;
        } else if (strcmp(words[0], "element") == 0) {
            trouble = add_element(header, words, count);
        } else if (strcmp(words[0], "property") == 0) {
            trouble = add_property(header, words, count);
        }
        if (trouble)
            return trouble;
    }
    return "the header has no end";
}
