#include "figures.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "../sluice-replay/file.h"
#include "memory.h"

#define EQUAL_DB 999.0

static const char *skip_blanks(const char *at)
{
    while (*at == ' ' || *at == '\t' || *at == '\r')
        at++;
    return at;
}

static size_t put_character(unsigned code, char *out)
{
    if (code < 0x80) {
        out[0] = (char)code;
        return 1;
    }
    if (code < 0x800) {
        out[0] = (char)(0xC0 | code >> 6);
        out[1] = (char)(0x80 | (code & 0x3F));
        return 2;
    }
    out[0] = (char)(0xE0 | code >> 12);
    out[1] = (char)(0x80 | (code >> 6 & 0x3F));
    out[2] = (char)(0x80 | (code & 0x3F));
    return 3;
}

/* Parses the XXXX of \uXXXX. Half of a surrogate pair, and 0000, become U+FFFD. NULL: not a
 * code. */
static const char *take_code(const char *at, char **out)
{
    unsigned code = 0;
    for (int i = 0; i < 4; i++, at++) {
        if (!isxdigit((unsigned char)*at))
            return NULL;
        code =
            code << 4 | (unsigned)(isdigit((unsigned char)*at) ? *at - '0' : (*at | 32) - 'a' + 10);
    }
    *out += put_character(code == 0 || (code >= 0xD800 && code < 0xE000) ? 0xFFFD : code, *out);
    return at;
}

/* Parses a quoted string. NULL: there is none. */
static const char *take_string(const char *at, char **text)
{
    static const char escaped[] = "\"\\/bfnrt", meant[] = "\"\\/\b\f\n\r\t";
    if (*at++ != '"')
        return NULL;
    char *out = *text = memory_take(strlen(at) + 1, 1);
    while (at && *at && *at != '"') {
        const char *escape = *at == '\\' && at[1] ? strchr(escaped, at[1]) : NULL;
        if (escape) {
            *out++ = meant[escape - escaped];
            at += 2;
        } else if (*at == '\\') {
            at = at[1] == 'u' ? take_code(at + 2, &out) : NULL;
        } else {
            *out++ = *at++;
        }
    }
    if (at && *at == '"')
        return at + 1;
    free(*text);
    *text = NULL;
    return NULL;
}

/* Parses a number, or null (NaN), true (1) or false (0). */
static const char *take_number(const char *at, double *value)
{
    static const char *const words[] = {"null", "true", "false"};
    static const double values[] = {NAN, 1.0, 0.0};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strncmp(at, words[i], strlen(words[i])) == 0) {
            *value = values[i];
            return at + strlen(words[i]);
        }
    size_t length = strspn(at, "0123456789+-.eE");
    char *end;
    *value = strtod(at, &end);
    return length > 0 && *at != '+' && end == at + length ? end : NULL;
}

/* Parses a member of the object. Keeps a name, a unit and a value. */
static const char *take_member(const char *at, struct figure *figure, bool *has_value)
{
    char *key = NULL, *text = NULL;
    double value = NAN;
    at = take_string(skip_blanks(at), &key);
    at = at ? skip_blanks(at) : NULL;
    if (at && *at == ':') {
        at = skip_blanks(at + 1);
        at = *at == '"' ? take_string(at, &text) : take_number(at, &value);
    } else {
        at = NULL;
    }
    char **place = at && strcmp(key, "name") == 0    ? &figure->name
                   : at && strcmp(key, "unit") == 0  ? &figure->unit
                   : at && strcmp(key, "value") == 0 ? &figure->text
                                                     : NULL;
    if (place == &figure->text) {
        *has_value = true;
        figure->value = value;
    }
    if (place) {
        free(*place);
        *place = text;
        text = NULL;
    }
    free(key);
    free(text);
    return at ? skip_blanks(at) : NULL;
}

bool figure_parse(const char *line, struct figure *figure)
{
    bool has_value = false;
    *figure = (struct figure){.value = NAN};
    const char *at = skip_blanks(line);
    bool open = *at == '{';
    while (open && at && (*at == '{' || *at == ','))
        at = take_member(at + 1, figure, &has_value);
    if (open && at && *at == '}' && *skip_blanks(at + 1) == '\0' && figure->name && has_value) {
        if (!figure->unit)
            figure->unit = memory_copy_text("");
        return true;
    }
    figure_finish(figure);
    return false;
}

void figure_finish(struct figure *figure)
{
    free(figure->name);
    free(figure->unit);
    free(figure->text);
    *figure = (struct figure){.value = NAN};
}

static void add_owned(struct figures *figures, struct figure figure)
{
    if (figures->count == figures->capacity) {
        figures->capacity = figures->capacity ? 2 * figures->capacity : 32;
        figures->items = memory_grow(figures->items, figures->capacity, sizeof *figures->items);
    }
    figures->items[figures->count++] = figure;
}

bool figures_read(const char *path, struct figures *figures)
{
    char *text;
    size_t size;
    if (!read_file(path, &text, &size))
        return false;
    char *line = text;
    while (line < text + size) {
        char *end = line + strcspn(line, "\n");
        struct figure figure;
        *end = '\0';
        if (figure_parse(line, &figure))
            add_owned(figures, figure);
        else if (*skip_blanks(line) != '\0')
            figures->rubbish_count++;
        line = end + 1;
    }
    free(text);
    return true;
}

void figures_add(struct figures *figures, const char *name, double value, const char *unit)
{
    add_owned(figures,
              (struct figure){memory_copy_text(name), memory_copy_text(unit), value, NULL});
}

const struct figure *figures_find(const struct figures *figures, const char *name)
{
    for (size_t i = figures->count; i-- > 0;)
        if (strcmp(figures->items[i].name, name) == 0)
            return &figures->items[i];
    return NULL;
}

double figures_value(const struct figures *figures, const char *name)
{
    const struct figure *figure = figures_find(figures, name);
    if (!figure || figure->value == -INFINITY)
        return NAN;
    if (figure->value == INFINITY)
        return strcmp(figure->unit, "dB") == 0 ? EQUAL_DB : NAN;
    return figure->value;
}

void figures_finish(struct figures *figures)
{
    for (size_t i = 0; i < figures->count; i++)
        figure_finish(&figures->items[i]);
    free(figures->items);
    *figures = (struct figures){0};
}
