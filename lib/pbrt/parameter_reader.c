#include "pbrt/parser.h"

#include "pbrt/growth.h"
#include "base/text_number.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define MAX_CELLS ((size_t)1 << 31)

/* Longest number to read directly, without a token. */
#define NUMBER_REACH 64u

/* True if a byte ends a number: blanks, brackets, quotes, and the 0 behind the window. */
static bool ends_word(unsigned char c)
{
    return c <= ' ' ? c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == 0
                    : c == '[' || c == ']' || c == '"';
}

/* Reads a number of the parameter's type. Returns its end, or `text` if not a number. */
static const unsigned char *read_cell(const unsigned char *text, enum slc_pbrt_type type,
                                      union slc_pbrt_cell *cell)
{
    double number = 0;
    if (type == SLC_PBRT_INTEGER) {
        const unsigned char *end = slc_read_integer(text, &cell->integer);
        if (end > text && (ends_word(*end) || *end == ','))
            return end;
        end = slc_read_number(text, &number);
        if (end == text || !(fabs(number) <= INT32_MAX) || floor(number) != number)
            return text;
        cell->integer = (int32_t)number;
        return end;
    }
    const unsigned char *end = slc_read_number(text, &number);
    if (!(fabs(number) <= FLT_MAX))
        return text;
    cell->number = (float)number;
    return end;
}

static bool warn_about_comma(struct slc_pbrt_parser *parser, const struct slc_pbrt_place *place)
{
    if (!parser->said_comma)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, place,
                     "a comma behind a number is ignored; pbrt-v4 refuses it");
    parser->said_comma = true;
    return true;
}

static bool add_cell(struct slc_pbrt_parser *parser, union slc_pbrt_cell cell)
{
    struct slc_pbrt_parameters *parameters = &parser->parameters;
    if (parameters->cell_count >= MAX_CELLS) {
        struct slc_pbrt_place place = slc_pbrt_token_place(&parser->token);
        return slc_pbrt_stop(parser, SLUICE_ERROR_LIMIT_EXCEEDED, &place,
                             "more than 2^31 values in one directive");
    }
    return slc_pbrt_add_cell(parameters, cell) || slc_pbrt_out_of_memory(parser);
}

/*
 * Reads numbers directly from the window, without tokens, for the numbers that make up most of a
 * large scene. Stops before anything else.
 */
static bool read_run(struct slc_pbrt_parser *parser, struct slc_pbrt_parameter *parameter)
{
    struct slc_pbrt_lexer *lexer = slc_pbrt_top_lexer(parser);
    struct slc_pbrt_window *window = &lexer->window;
    struct slc_pbrt_parameters *parameters = &parser->parameters;
    for (;;) {
        unsigned char c = slc_pbrt_skip_blanks(lexer);
        const unsigned char *text = window->bytes + window->cursor;
        union slc_pbrt_cell cell;
        if (!((unsigned)c - '0' < 10u || c == '-' || c == '+' || c == '.') ||
            window->end - window->cursor < NUMBER_REACH ||
            parameters->cell_count == parameters->cell_capacity)
            return true;
        const unsigned char *end = read_cell(text, parameter->type, &cell);
        if (end == text || !ends_word(*end) || *end == 0)
            return true;
        if (parameter->count == 0) {
            parameter->value_file = parser->frames[parser->frame_count - 1].file;
            parameter->value_offset = slc_pbrt_window_offset(window);
        }
        window->cursor += (size_t)(end - text);
        parameters->cells[parameters->cell_count++] = cell;
        parameter->count++;
    }
}

/* Reads a token as a number, optionally with a comma behind. False: not a number. */
static bool token_number(struct slc_pbrt_parser *parser, enum slc_pbrt_type type,
                         union slc_pbrt_cell *cell)
{
    const struct slc_pbrt_token *token = &parser->token;
    unsigned char text[256];
    if (token->kind != SLC_PBRT_TOKEN_WORD || token->length >= sizeof text)
        return false;
    memcpy(text, token->text, token->length);
    text[token->length] = 0;
    const unsigned char *end = read_cell(text, type, cell);
    if (end == text)
        return false;
    if (*end == ',' && end + 1 == text + token->length) {
        struct slc_pbrt_place place = slc_pbrt_token_place(token);
        return warn_about_comma(parser, &place);
    }
    return end == text + token->length;
}

static bool is_word(const struct slc_pbrt_token *token, const char *word)
{
    return token->length == strlen(word) && memcmp(token->text, word, token->length) == 0;
}

/* Reads the token as a value. *good: the value has the parameter's type. False: stop. */
static bool read_token_value(struct slc_pbrt_parser *parser, struct slc_pbrt_parameter *parameter,
                             bool *good)
{
    struct slc_pbrt_parameters *parameters = &parser->parameters;
    const struct slc_pbrt_token *token = &parser->token;
    union slc_pbrt_cell cell = {0};
    bool wants_string = parameter->type == SLC_PBRT_STRING || parameter->type == SLC_PBRT_TEXTURE;
    bool is_string = token->kind == SLC_PBRT_TOKEN_STRING;
    if (parameter->type == SLC_PBRT_SPECTRUM) {
        wants_string = is_string;
        *good = parameter->count == 0 || parameter->has_strings == is_string;
        parameter->has_strings = is_string;
        if (!*good)
            return true;
    }
    if (wants_string) {
        char *text = (char *)(uintptr_t)token->text; /* shorter in its place */
        *good = is_string && !memchr(token->text, 0, token->length);
        if (*good &&
            !slc_pbrt_add_string(parameters, token->text,
                                 token->has_escape ? slc_pbrt_unescape(token, text) : token->length,
                                 &cell.string))
            return slc_pbrt_out_of_memory(parser);
    } else if (parameter->type == SLC_PBRT_BOOL) {
        cell.integer = is_word(token, "true");
        *good = cell.integer || is_word(token, "false");
    } else {
        *good = token_number(parser, parameter->type, &cell);
    }
    if (!*good)
        return true;
    if (parameter->count++ == 0) {
        parameter->value_file = token->file;
        parameter->value_offset = token->offset;
    }
    return add_cell(parser, cell);
}

static bool stop_in_parameter(struct slc_pbrt_parser *parser,
                              const struct slc_pbrt_parameter *parameter, const char *what)
{
    return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, &parameter->place, "the file ends %s",
                         what);
}

static void say_bad_value(struct slc_pbrt_parser *parser,
                          const struct slc_pbrt_parameter *parameter)
{
    char text[32];
    const struct slc_pbrt_token *token = &parser->token;
    size_t length = token->length < sizeof text - 1 ? token->length : sizeof text - 1;
    for (size_t i = 0; i < length; i++)
        text[i] = token->text[i] >= ' ' && token->text[i] < 127 ? token->text[i] : '?';
    text[length] = 0;
    struct slc_pbrt_place place = slc_pbrt_token_place(token);
    slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, &place,
                 "\"%s\" is no value of the type of \"%s\": the parameter is ignored", text,
                 parser->parameters.chars + parameter->name);
}

/* Reads the values behind the name. *good: all have the parameter's type. */
static bool read_values(struct slc_pbrt_parser *parser, struct slc_pbrt_parameter *parameter,
                        bool *good)
{
    if (!slc_pbrt_take_token(parser))
        return false;
    switch (parser->token.kind) {
    case SLC_PBRT_TOKEN_END:
    case SLC_PBRT_TOKEN_FILE_END:
        return stop_in_parameter(parser, parameter, "where the value of this parameter belongs");
    case SLC_PBRT_TOKEN_CLOSE: *good = false; return true;
    case SLC_PBRT_TOKEN_OPEN: break;
    default: {
        bool fits;
        if (!read_token_value(parser, parameter, &fits))
            return false;
        if (!fits && *good)
            say_bad_value(parser, parameter);
        *good &= fits;
        return true;
    }
    }
    bool is_number = parameter->type != SLC_PBRT_STRING && parameter->type != SLC_PBRT_TEXTURE &&
                     parameter->type != SLC_PBRT_BOOL && parameter->type != SLC_PBRT_SPECTRUM;
    for (;;) {
        bool fits = false;
        if (is_number && !read_run(parser, parameter))
            return false;
        if (!slc_pbrt_take_token(parser))
            return false;
        if (parser->token.kind == SLC_PBRT_TOKEN_CLOSE) {
            /* Numbers of meshes are read again by their place. */
            if (*good && parameter->count && parser->token.file != parameter->value_file) {
                say_bad_value(parser, parameter);
                *good = false;
            }
            return true;
        }
        if (parser->token.kind == SLC_PBRT_TOKEN_END ||
            parser->token.kind == SLC_PBRT_TOKEN_FILE_END)
            return stop_in_parameter(parser, parameter, "inside of these brackets");
        if (parser->token.kind != SLC_PBRT_TOKEN_OPEN &&
            !read_token_value(parser, parameter, &fits))
            return false;
        if (!fits && *good)
            say_bad_value(parser, parameter);
        *good &= fits;
    }
}

/* Splits "type name". *good: both are present and the type is known. */
static bool read_declaration(struct slc_pbrt_parser *parser, struct slc_pbrt_parameter *parameter,
                             bool *good)
{
    const struct slc_pbrt_token *token = &parser->token;
    const char *text = token->text, *end = token->text + token->length;
    while (text < end && (*text == ' ' || *text == '\t'))
        text++;
    const char *type = text;
    while (text < end && *text != ' ' && *text != '\t')
        text++;
    size_t type_length = (size_t)(text - type);
    while (text < end && (*text == ' ' || *text == '\t'))
        text++;
    const char *name = text;
    while (end > name && (end[-1] == ' ' || end[-1] == '\t'))
        end--;
    parameter->place = slc_pbrt_token_place(token);
    parameter->type = slc_pbrt_type_of(type, type_length);
    size_t length = (size_t)(end - name);
    const char *trouble = NULL;
    if (parameter->type == SLC_PBRT_TYPE_COUNT)
        trouble = "the type of this parameter is not known";
    else if (length == 0)
        trouble = "this parameter has no name";
    else if (memchr(name, 0, length))
        trouble = "the name of this parameter has a byte of 0";
    *good = !trouble;
    if (trouble) {
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, &parameter->place, "%s: it is ignored",
                     trouble);
        parameter->type = SLC_PBRT_STRING;
    }
    return slc_pbrt_add_string(&parser->parameters, name, length, &parameter->name) ||
           slc_pbrt_out_of_memory(parser);
}

/* Skips the values of an unknown parameter, strings or numbers. */
static bool skip_values(struct slc_pbrt_parser *parser, const struct slc_pbrt_parameter *parameter)
{
    bool in_brackets = false;
    for (;;) {
        if (!slc_pbrt_take_token(parser))
            return false;
        switch (parser->token.kind) {
        case SLC_PBRT_TOKEN_END:
        case SLC_PBRT_TOKEN_FILE_END:
            return stop_in_parameter(parser, parameter,
                                     in_brackets ? "inside of these brackets"
                                                 : "where the value of this parameter belongs");
        case SLC_PBRT_TOKEN_OPEN: in_brackets = true; break;
        case SLC_PBRT_TOKEN_CLOSE: return true;
        default:
            if (!in_brackets)
                return true;
        }
    }
}

static bool read_parameter(struct slc_pbrt_parser *parser)
{
    struct slc_pbrt_parameters *parameters = &parser->parameters;
    struct slc_pbrt_parameter parameter = {.first = parameters->cell_count};
    bool good;
    if (!read_declaration(parser, &parameter, &good))
        return false;
    if (!good)
        return skip_values(parser, &parameter);
    if (!read_values(parser, &parameter, &good))
        return false;
    uint32_t width = slc_pbrt_type_width(parameter.type);
    if (good && parameter.count % width)
        slc_pbrt_say(parser->scene, SLUICE_LOG_WARNING, &parameter.place,
                     "\"%s\" has %zu values, no multiple of %u: the last are ignored",
                     parameters->chars + parameter.name, parameter.count, width);
    if (!good) {
        parameters->cell_count = parameter.first;
        return true;
    }
    if (!slc_pbrt_grow(&parameters->allocator, &parameters->list, &parameters->capacity,
                       parameters->count + 1, sizeof *parameters->list))
        return slc_pbrt_out_of_memory(parser);
    parameters->list[parameters->count++] = parameter;
    return true;
}

bool slc_pbrt_read_parameters(struct slc_pbrt_parser *parser)
{
    slc_pbrt_parameters_clear(&parser->parameters);
    for (;;) {
        if (!slc_pbrt_take_token(parser))
            return false;
        if (parser->token.kind != SLC_PBRT_TOKEN_STRING) {
            parser->has_token = true;
            return true;
        }
        if (!read_parameter(parser))
            return false;
    }
}

bool slc_pbrt_read_parameters_for(struct slc_pbrt_parser *parser, enum slc_pbrt_target target)
{
    if (!slc_pbrt_read_parameters(parser))
        return false;
    uint32_t attribute = parser->state.attributes[target];
    if (attribute == SLUICE_PBRT_NONE)
        return true;
    return slc_pbrt_prepend(&parser->parameters, &parser->attributes[attribute].parameters) ||
           slc_pbrt_out_of_memory(parser);
}

bool slc_read_numbers(struct slc_pbrt_parser *parser, double *numbers, int count,
                      const struct slc_pbrt_place *place)
{
    bool in_brackets = false;
    for (int i = 0; i < count + in_brackets; i++) {
        if (!slc_pbrt_take_token(parser))
            return false;
        const struct slc_pbrt_token *token = &parser->token;
        if (i == 0 && token->kind == SLC_PBRT_TOKEN_OPEN && !in_brackets) {
            in_brackets = true;
            i = -1;
            continue;
        }
        if (i == count && token->kind == SLC_PBRT_TOKEN_CLOSE)
            return true;
        unsigned char text[256];
        size_t length = token->length;
        if (i == count || token->kind != SLC_PBRT_TOKEN_WORD || length >= sizeof text)
            return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, place,
                                 "%d numbers are expected here", count);
        memcpy(text, token->text, length);
        text[length] = 0;
        const unsigned char *end = slc_read_number(text, &numbers[i]);
        bool has_comma = *end == ',' && end + 1 == text + length;
        if (end == text || (end != text + length && !has_comma) || !(fabs(numbers[i]) <= FLT_MAX))
            return slc_pbrt_stop(parser, SLUICE_ERROR_CORRUPT_DATA, place,
                                 "%d numbers are expected here", count);
        if (has_comma)
            warn_about_comma(parser, place);
    }
    return true;
}

bool slc_pbrt_read_name(struct slc_pbrt_parser *parser, const char *what, uint32_t *name,
                        bool *found)
{
    if (!slc_pbrt_take_token(parser))
        return false;
    const struct slc_pbrt_token *token = &parser->token;
    *found = token->kind == SLC_PBRT_TOKEN_STRING;
    if (!*found) {
        struct slc_pbrt_place place = slc_pbrt_token_place(token);
        parser->has_token = true;
        slc_pbrt_say(parser->scene, SLUICE_LOG_ERROR, &place, "the %s in quotes belongs here",
                     what);
        return true;
    }
    char *text = (char *)(uintptr_t)token->text;
    size_t length = token->has_escape ? slc_pbrt_unescape(token, text) : token->length;
    SluicePbrtScene *scene = parser->scene;
    return slc_pbrt_names_add(&scene->names, &scene->allocator, text, length, name) ||
           slc_pbrt_out_of_memory(parser);
}
