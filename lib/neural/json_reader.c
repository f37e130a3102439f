#include "neural/json_reader.h"

#include "base/text_number.h"

#include <string.h>

void slc_json_begin(struct slc_json *json, char *text, size_t size)
{
    *json = (struct slc_json){.text = text, .size = size, .at = text};
}

bool slc_json_fail(struct slc_json *json, const char *trouble)
{
    if (!json->trouble)
        json->trouble = trouble;
    return false;
}

static void skip_blanks(struct slc_json *json)
{
    while (*json->at == ' ' || *json->at == '\t' || *json->at == '\n' || *json->at == '\r')
        json->at++;
}

/* Takes a character. The text ends with NUL, which is invalid in JSON, so scans stop there. */
static bool take(struct slc_json *json, char c)
{
    if (json->trouble)
        return false;
    skip_blanks(json);
    if (*json->at != c)
        return false;
    json->at++;
    return true;
}

static bool enter(struct slc_json *json, char open, const char *expected)
{
    if (!take(json, open))
        return slc_json_fail(json, expected);
    if (json->depth == SLC_JSON_MAX_DEPTH)
        return slc_json_fail(json, "values are nested too deep");
    json->depth++;
    json->is_first = true;
    return true;
}

bool slc_json_enter_array(struct slc_json *json)
{
    return enter(json, '[', "an array is expected");
}

bool slc_json_enter_object(struct slc_json *json)
{
    return enter(json, '{', "an object is expected");
}

/* Goes to the next value. False: no more values. */
static bool next(struct slc_json *json, char close)
{
    if (json->trouble)
        return false;
    if (take(json, close)) {
        json->depth--;
        json->is_first = false;
        return false;
    }
    if (!json->is_first && !take(json, ','))
        return slc_json_fail(json, "a comma or the end of an array or object is expected");
    json->is_first = false;
    return true;
}

bool slc_json_next_element(struct slc_json *json)
{
    return next(json, ']');
}

bool slc_json_next_member(struct slc_json *json, const char **key)
{
    return next(json, '}') && slc_json_read_string(json, key) &&
           (take(json, ':') || slc_json_fail(json, "a colon is expected"));
}

/* Reads four hexadecimal digits. */
static bool read_unit(const char *digits, uint32_t *unit)
{
    *unit = 0;
    for (int i = 0; i < 4; i++) {
        char c = digits[i];
        uint32_t value = c >= '0' && c <= '9'   ? (uint32_t)(c - '0')
                         : c >= 'a' && c <= 'f' ? (uint32_t)(c - 'a' + 10)
                         : c >= 'A' && c <= 'F' ? (uint32_t)(c - 'A' + 10)
                                                : 16;
        if (value == 16)
            return false;
        *unit = *unit << 4 | value;
    }
    return true;
}

/* Writes up to four bytes, never more than the escape's length. Returns their end. */
static char *write_utf8(char *out, uint32_t code)
{
    if (code < 0x80) {
        *out++ = (char)code;
    } else if (code < 0x800) {
        *out++ = (char)(0xC0 | code >> 6);
        *out++ = (char)(0x80 | (code & 63));
    } else if (code < 0x10000) {
        *out++ = (char)(0xE0 | code >> 12);
        *out++ = (char)(0x80 | (code >> 6 & 63));
        *out++ = (char)(0x80 | (code & 63));
    } else {
        *out++ = (char)(0xF0 | code >> 18);
        *out++ = (char)(0x80 | (code >> 12 & 63));
        *out++ = (char)(0x80 | (code >> 6 & 63));
        *out++ = (char)(0x80 | (code & 63));
    }
    return out;
}

/* Decodes an escape; `*in` is behind "\u". False: lone surrogate, or NUL. */
static bool decode_unicode(const char **in, char **out)
{
    uint32_t high, low;
    if (!read_unit(*in, &high) || high == 0)
        return false;
    *in += 4;
    if (high >= 0xDC00 && high < 0xE000)
        return false;
    if (high >= 0xD800 && high < 0xDC00) {
        if ((*in)[0] != '\\' || (*in)[1] != 'u' || !read_unit(*in + 2, &low) || low < 0xDC00 ||
            low >= 0xE000)
            return false;
        *in += 6;
        high = 0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00);
    }
    *out = write_utf8(*out, high);
    return true;
}

/* Decodes an escape; `*in` is behind the backslash. */
static bool decode_escape(const char **in, char **out)
{
    static const char NAMES[] = "\"\\/bfnrt", VALUES[] = "\"\\/\b\f\n\r\t";
    char name = *(*in)++;
    if (name == 'u')
        return decode_unicode(in, out);
    const char *found = name ? strchr(NAMES, name) : NULL;
    if (!found)
        return false;
    *(*out)++ = VALUES[found - NAMES];
    return true;
}

bool slc_json_read_string(struct slc_json *json, const char **string)
{
    if (!take(json, '"'))
        return slc_json_fail(json, "a string is expected");
    const char *in = json->at;
    char *out = json->at;
    *string = out;
    while (*in != '"') {
        if ((unsigned char)*in < 0x20)
            return slc_json_fail(json, "a string has a control character or no end");
        if (*in != '\\')
            *out++ = *in++;
        else if (in++, !decode_escape(&in, &out))
            return slc_json_fail(json, "a string has an unknown escape");
    }
    json->at += in + 1 - json->at;
    *out = '\0';
    return true;
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static const char *skip_digits(const char *c)
{
    while (is_digit(*c))
        c++;
    return c;
}

/* Returns the end of the JSON number at `c`, or NULL. */
static const char *number_end(const char *c)
{
    c += *c == '-';
    if (!is_digit(*c))
        return NULL;
    c = *c == '0' ? c + 1 : skip_digits(c);
    if (*c == '.') {
        if (!is_digit(c[1]))
            return NULL;
        c = skip_digits(c + 1);
    }
    if (*c == 'e' || *c == 'E') {
        c += c[1] == '+' || c[1] == '-' ? 2 : 1;
        if (!is_digit(*c))
            return NULL;
        c = skip_digits(c);
    }
    return c;
}

bool slc_json_read_number(struct slc_json *json, double *number)
{
    if (json->trouble)
        return false;
    skip_blanks(json);
    const char *end = number_end(json->at);
    if (!end)
        return slc_json_fail(json, "a number is expected");
    slc_read_number((const unsigned char *)json->at, number);
    json->at += end - json->at;
    return true;
}

static bool read_integer(struct slc_json *json, uint64_t most, uint64_t *number)
{
    double value;
    if (!slc_json_read_number(json, &value))
        return false;
    if (!(value >= 0 && value <= (double)most) || value != (double)(uint64_t)value)
        return slc_json_fail(json, "a number is no integer, negative or too large");
    *number = (uint64_t)value;
    return true;
}

bool slc_json_read_u64(struct slc_json *json, uint64_t *number)
{
    return read_integer(json, (uint64_t)1 << 53, number);
}

bool slc_json_read_u32(struct slc_json *json, uint32_t *number)
{
    uint64_t value;
    if (!read_integer(json, UINT32_MAX, &value))
        return false;
    *number = (uint32_t)value;
    return true;
}

static bool skip_word(struct slc_json *json)
{
    static const char *const WORDS[] = {"true", "false", "null"};
    for (size_t i = 0; i < 3; i++)
        if (strncmp(json->at, WORDS[i], strlen(WORDS[i])) == 0) {
            json->at += strlen(WORDS[i]);
            return true;
        }
    return slc_json_fail(json, "a value is expected");
}

static bool skip_scalar(struct slc_json *json)
{
    const char *string;
    double number;
    if (*json->at == '"')
        return slc_json_read_string(json, &string);
    if (*json->at == '-' || is_digit(*json->at))
        return slc_json_read_number(json, &number);
    return skip_word(json);
}

/* Walks nested values with one bit per open value; 1: object. */
bool slc_json_skip(struct slc_json *json)
{
    uint64_t objects = 0;
    uint32_t outer = json->depth;
    const char *key;
    do {
        if (json->trouble)
            return false;
        skip_blanks(json);
        bool is_object = *json->at == '{';
        if (is_object || *json->at == '[') {
            objects = objects << 1 | is_object;
            if (!(is_object ? slc_json_enter_object : slc_json_enter_array)(json))
                return false;
        } else if (!skip_scalar(json)) {
            return false;
        }
        while (json->depth > outer &&
               !(objects & 1 ? slc_json_next_member(json, &key) : slc_json_next_element(json))) {
            if (json->trouble)
                return false;
            objects >>= 1;
        }
    } while (json->depth > outer);
    return true;
}

bool slc_json_end(struct slc_json *json)
{
    if (json->trouble)
        return false;
    skip_blanks(json);
    return json->at == json->text + json->size ||
           slc_json_fail(json, "something follows the last value");
}
