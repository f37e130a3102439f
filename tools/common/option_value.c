#include "option_value.h"

#include "nearest.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct unit {
    const char *name;
    double factor;
};

static const struct unit times[] = {{"us", 1e-6}, {"ms", 1e-3}, {"s", 1}, {"min", 60}, {NULL, 0}};
static const struct unit sizes[] = {
    {"K", 1024}, {"M", 1048576}, {"G", 1073741824.0}, {"T", 1099511627776.0}, {NULL, 0}};

/* `bare`: factor of a number without a unit. */
static bool read_unit(const struct unit *units, double bare, const char *text, double *factor)
{
    *factor = bare;
    if (*text == '\0')
        return true;
    for (; units->name; units++)
        if (strcmp(units->name, text) == 0) {
            *factor = units->factor;
            return true;
        }
    return false;
}

static bool in_range(const struct option *option, double value)
{
    return value >= option->minimum && value <= option->maximum;
}

/* Reads a decimal number. `fraction`: also two with a slash between them. */
static bool read_real(const char *text, bool fraction, const char **end, double *value)
{
    char *stop;
    *value = strtod(text, &stop);
    if (stop == text || isspace((unsigned char)*text))
        return false;
    if (fraction && *stop == '/') {
        const char *divisor_text = stop + 1;
        double divisor = strtod(divisor_text, &stop);
        if (stop == divisor_text || divisor == 0.0)
            return false;
        *value /= divisor;
    }
    *end = stop;
    return isfinite(*value);
}

static bool read_whole(const char *text, const char **end, uint64_t *value)
{
    char *stop;
    if (!isdigit((unsigned char)*text))
        return false;
    errno = 0;
    *value = strtoull(text, &stop, 10);
    *end = stop;
    return errno == 0;
}

static bool read_uint(const struct option *option, const char *text, const char **end,
                      uint32_t *value)
{
    uint64_t number;
    if (!read_whole(text, end, &number) || number > UINT32_MAX)
        return false;
    *value = (uint32_t)number;
    return in_range(option, *value);
}

static bool read_int(const struct option *option, const char *text, int32_t *value)
{
    uint64_t number;
    const char *end;
    const char *digits = text + (*text == '-' || *text == '+');
    if (!read_whole(digits, &end, &number) || *end || number > INT32_MAX)
        return false;
    *value = *text == '-' ? -(int32_t)number : (int32_t)number;
    return in_range(option, *value);
}

/* Converts to the option's own unit, which is also that of its range. */
static bool read_time(const struct option *option, const char *text, double unit, double *value)
{
    double factor;
    const char *end;
    if (!read_real(text, false, &end, value) || !read_unit(times, unit, end, &factor))
        return false;
    if (factor != unit)
        *value *= factor / unit;
    return in_range(option, *value);
}

static bool read_bytes(const struct option *option, const char *text, uint64_t *value)
{
    double factor;
    const char *end;
    if (!read_whole(text, &end, value) || !read_unit(sizes, 1048576, end, &factor) ||
        *value > UINT64_MAX / (uint64_t)factor)
        return false;
    *value *= (uint64_t)factor;
    return in_range(option, (double)*value);
}

static bool read_choice(const struct option *option, const char *text, int *value)
{
    size_t length = strlen(text);
    const char *choice = option->operand;
    for (int i = 0;; i++) {
        size_t choice_length = strcspn(choice, "|");
        if (length == choice_length && strncmp(choice, text, length) == 0) {
            *value = i;
            return true;
        }
        if (choice[choice_length] == '\0')
            return false;
        choice += choice_length + 1;
    }
}

static bool read_extent(const struct option *option, const char *text, uint32_t extent[2])
{
    const char *end;
    return read_uint(option, text, &end, &extent[0]) && *end == 'x' &&
           read_uint(option, end + 1, &end, &extent[1]) && *end == '\0';
}

bool option_value_read(const struct option *option, const char *text)
{
    const char *end = text;
    switch (option->kind) {
    case OPTION_UINT: return read_uint(option, text, &end, option->value) && *end == '\0';
    case OPTION_INT: return read_int(option, text, option->value);
    case OPTION_REAL:
        return read_real(text, true, &end, option->value) && *end == '\0' &&
               in_range(option, *(double *)option->value);
    case OPTION_SECONDS: return read_time(option, text, 1.0, option->value);
    case OPTION_MILLISECONDS: return read_time(option, text, 1e-3, option->value);
    case OPTION_BYTES: return read_bytes(option, text, option->value);
    case OPTION_TEXT: *(const char **)option->value = text; return *text != '\0';
    case OPTION_CHOICE: return read_choice(option, text, option->value);
    case OPTION_EXTENT: return read_extent(option, text, option->value);
    case OPTION_CUSTOM: return option->parse(text, option->value);
    case OPTION_REPEATED: {
        struct option_texts *texts = option->value;
        if (*text == '\0' || texts->count == OPTION_MOST_REPEATS)
            return false;
        texts->items[texts->count++] = text;
        return true;
    }
    case OPTION_SECTION:
    case OPTION_FLAG:
    case OPTION_LIST:
    case OPTION_WORD:
    case OPTION_WORDS:
    case OPTION_REST:
    case OPTION_RENAMED: break;
    }
    return false;
}

/* Writes in the largest unit that gives a whole number, else in the base unit. */
static void write_amount(const struct unit *units, double amount, const char *base, char *words,
                         size_t size)
{
    const struct unit *best = NULL;
    for (const struct unit *unit = units; unit->name; unit++)
        if (amount >= unit->factor && fmod(amount, unit->factor) == 0.0)
            best = unit;
    if (best)
        snprintf(words, size, "%.15g%s", amount / best->factor, best->name);
    else
        snprintf(words, size, "%.15g%s", amount, amount == 0.0 ? "" : base);
}

static void write_time(double seconds, char *words, size_t size)
{
    if (seconds > 0.0 && seconds < 1e-3)
        snprintf(words, size, "%.15gus", seconds * 1e6);
    else if (seconds > 0.0 && seconds < 1.0)
        snprintf(words, size, "%.15gms", seconds * 1e3);
    else
        snprintf(words, size, "%.15g%s", seconds, seconds > 0.0 ? "s" : "");
}

static const char *write_range(const struct option *option, const char *what, char *words,
                               size_t size)
{
    char least[64], most[64];
    double unit = option->kind == OPTION_MILLISECONDS ? 1e-3 : 1.0;
    if (option->kind == OPTION_BYTES) {
        write_amount(sizes, option->minimum, " bytes", least, sizeof least);
        write_amount(sizes, option->maximum, " bytes", most, sizeof most);
    } else if (option->kind == OPTION_SECONDS || option->kind == OPTION_MILLISECONDS) {
        write_time(option->minimum * unit, least, sizeof least);
        write_time(option->maximum * unit, most, sizeof most);
    } else {
        snprintf(least, sizeof least, "%.15g", option->minimum);
        snprintf(most, sizeof most, "%.15g", option->maximum);
    }
    snprintf(words, size, "%s from %s to %s", what, least, most);
    return words;
}

static const char *write_choices(const struct option *option, const char *text, char *words,
                                 size_t size)
{
    char question[64];
    struct nearest nearest = {.word = text, .word_length = strlen(text)};
    for (const char *choice = option->operand; *choice; choice += *choice == '|') {
        size_t length = strcspn(choice, "|");
        nearest_try(&nearest, choice, length);
        choice += length;
    }
    snprintf(words, size, "%s%s", option->operand,
             nearest_question(&nearest, "", question, sizeof question));
    return words;
}

const char *option_value_wanted(const struct option *option, const char *text, char *words,
                                size_t size)
{
    switch (option->kind) {
    case OPTION_UINT:
    case OPTION_INT: return write_range(option, "a whole number", words, size);
    case OPTION_REAL: return write_range(option, "a number", words, size);
    case OPTION_SECONDS: return write_range(option, "seconds, or a time like 250ms,", words, size);
    case OPTION_MILLISECONDS:
        return write_range(option, "milliseconds, or a time like 1.5s,", words, size);
    case OPTION_BYTES: return write_range(option, "a size like 512M or 2G,", words, size);
    case OPTION_EXTENT: return write_range(option, "WxH, each", words, size);
    case OPTION_CHOICE: return write_choices(option, text, words, size);
    case OPTION_REPEATED:
        snprintf(words, size, "%s, at most %u times", option->operand, OPTION_MOST_REPEATS);
        return words;
    default:
        snprintf(words, size, "%s",
                 option->wanted    ? option->wanted
                 : option->operand ? option->operand
                                   : "no value");
        return words;
    }
}
