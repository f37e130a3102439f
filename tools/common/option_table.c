#include "option_table.h"

#include "text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HELP_COLUMN 30

static void print_default(const struct option *option)
{
    switch (option->kind) {
    case OPTION_UINT: printf(" [%u]", *(const uint32_t *)option->value); break;
    case OPTION_REAL:
        if (!isnan(*(const double *)option->value))
            printf(" [%g]", *(const double *)option->value);
        break;
    case OPTION_TEXT: {
        const char *text = *(const char *const *)option->value;
        if (text)
            printf(" [%s]", text);
        break;
    }
    case OPTION_CHOICE: {
        const char *choice = option->operand;
        for (int i = *(const int *)option->value; i > 0; i--)
            choice = strchr(choice, '|') + 1;
        printf(" [%.*s]", (int)strcspn(choice, "|"), choice);
        break;
    }
    case OPTION_SIZE: {
        const uint32_t *size = option->value;
        printf(" [%ux%u]", size[0], size[1]);
        break;
    }
    case OPTION_SECTION:
    case OPTION_FLAG:
    case OPTION_LIST: break;
    }
}

static void print_help(const struct option *options, size_t option_count, const char *usage)
{
    fputs(usage, stdout);
    for (size_t i = 0; i < option_count; i++) {
        const struct option *option = &options[i];
        if (option->kind == OPTION_SECTION) {
            printf("\n%s\n", option->help);
            continue;
        }
        int column = printf("  --%s%s%s", option->name, option->operand ? " " : "",
                            option->operand ? option->operand : "");
        if (column >= HELP_COLUMN)
            column = printf("\n") - 1;
        for (const char *line = option->help; line;) {
            int length = (int)strcspn(line, "\n");
            printf("%*s%.*s", HELP_COLUMN - column, "", length, line);
            line = line[length] ? line + length + 1 : NULL;
            if (line)
                printf("\n");
            column = 0;
        }
        print_default(option);
        printf("\n");
    }
    printf("%-*sthis text\n", HELP_COLUMN, "  --help");
}

/** A number, or two with a slash between them. */
static bool parse_real(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text)
        return false;
    if (*end == '/') {
        const char *divisor_text = end + 1;
        double divisor = strtod(divisor_text, &end);
        if (end == divisor_text || divisor == 0.0)
            return false;
        *value /= divisor;
    }
    return *end == '\0' && isfinite(*value);
}

static bool parse_uint(const char *text, const char **end, uint32_t *value)
{
    if (!isdigit((unsigned char)*text))
        return false;
    errno = 0;
    unsigned long long number = strtoull(text, (char **)end, 10);
    *value = (uint32_t)number;
    return errno == 0 && number <= UINT32_MAX;
}

static bool in_range(const struct option *option, double value)
{
    return value >= option->minimum && value <= option->maximum;
}

static bool parse_choice(const struct option *option, const char *text)
{
    size_t length = strlen(text);
    const char *choice = option->operand;
    for (int i = 0;; i++) {
        size_t choice_length = strcspn(choice, "|");
        if (length == choice_length && strncmp(choice, text, length) == 0) {
            *(int *)option->value = i;
            return true;
        }
        if (choice[choice_length] == '\0')
            return false;
        choice += choice_length + 1;
    }
}

static bool parse_value(const struct option *option, const char *text)
{
    const char *end = text;
    switch (option->kind) {
    case OPTION_UINT: {
        uint32_t *value = option->value;
        return parse_uint(text, &end, value) && *end == '\0' && in_range(option, *value);
    }
    case OPTION_REAL: {
        double *value = option->value;
        return parse_real(text, value) && in_range(option, *value);
    }
    case OPTION_TEXT: *(const char **)option->value = text; return *text != '\0';
    case OPTION_CHOICE: return parse_choice(option, text);
    case OPTION_SIZE: {
        uint32_t *size = option->value;
        return parse_uint(text, &end, &size[0]) && *end == 'x' &&
               parse_uint(end + 1, &end, &size[1]) && *end == '\0' && in_range(option, size[0]) &&
               in_range(option, size[1]);
    }
    case OPTION_SECTION:
    case OPTION_FLAG:
    case OPTION_LIST: break;
    }
    return false;
}

static const struct option *find_option(const struct option *options, size_t option_count,
                                        const char *argument)
{
    if (strncmp(argument, "--", 2) != 0)
        return NULL;
    size_t length = strcspn(argument + 2, "=");
    for (size_t i = 0; i < option_count; i++)
        if (options[i].name && strlen(options[i].name) == length &&
            strncmp(options[i].name, argument + 2, length) == 0)
            return &options[i];
    return NULL;
}

static void explain_bad_value(const struct option *option, const char *text)
{
    char range[64] = "";
    if (option->kind == OPTION_UINT || option->kind == OPTION_REAL || option->kind == OPTION_SIZE)
        snprintf(range, sizeof range, " from %.15g to %.15g", option->minimum, option->maximum);
    text_say("--%s%s%s: wants %s%s", option->name, *text ? " " : "", text,
             option->operand ? option->operand : "no value", range);
}

/** Takes the operand behind `--name=` or the next argument; moves *index to the last one used. */
static bool take_operands(const struct option *option, int argc, char *const *argv, int *index)
{
    const char *equals = strchr(argv[*index], '=');
    if (option->kind == OPTION_FLAG) {
        *(bool *)option->value = true;
        return equals == NULL || (explain_bad_value(option, equals + 1), false);
    }
    if (option->kind == OPTION_LIST) {
        struct option_list *list = option->value;
        if (equals || list->count > 0) {
            text_say("--%s: give it once, with all of %s behind it", option->name, option->operand);
            return false;
        }
        bool all = *index + 1 < argc && strcmp(argv[*index + 1], "--") == 0;
        *index += all;
        list->items = argv + *index + 1;
        for (list->count = 0; *index + 1 < argc && (all || strncmp(argv[*index + 1], "--", 2) != 0);
             ++*index)
            list->count++;
        return list->count > 0 || (explain_bad_value(option, ""), false);
    }
    if (!equals && *index + 1 >= argc) {
        explain_bad_value(option, "");
        return false;
    }
    const char *text = equals ? equals + 1 : argv[++*index];
    return parse_value(option, text) || (explain_bad_value(option, text), false);
}

enum option_outcome options_parse(const struct option *options, size_t option_count,
                                  const char *usage, int argc, char *const *argv)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--") != 0; i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0) {
            print_help(options, option_count, usage);
            return OPTIONS_HELP;
        }
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--") == 0 && i + 1 == argc)
            break;
        if (strcmp(argv[i], "--") == 0) {
            text_say("%s: only options are taken, no words", argv[i + 1]);
            return OPTIONS_ERROR;
        }
        const struct option *option = find_option(options, option_count, argv[i]);
        if (!option) {
            text_say("%s: no such option; see --help", argv[i]);
            return OPTIONS_ERROR;
        }
        if (!take_operands(option, argc, argv, &i))
            return OPTIONS_ERROR;
    }
    return OPTIONS_RUN;
}
