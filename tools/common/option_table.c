#include "option_table.h"

#include "nearest.h"
#include "option_help.h"
#include "option_value.h"
#include "text.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Position of the parser. */
struct command_line {
    const struct option_table *table;
    int argc, index; ///< `index`: current argument
    char **argv;
    int word_count;  ///< words of OPTION_WORDS, which are at the front of argv
    size_t next_row; ///< OPTION_WORD: rows before this one are filled
};

bool options_refuse(const struct option_table *table, const char *format, ...)
{
    char line[4096];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    text_say("%s: %s", table->program, line);
    return false;
}

static const struct option *find_kind(const struct option_table *table, enum option_kind kind)
{
    for (size_t i = 0; i < table->option_count; i++)
        if (table->options[i].kind == kind)
            return &table->options[i];
    return NULL;
}

static const struct option *find_option(const struct option_table *table, const char *argument)
{
    bool is_long = argument[1] == '-';
    size_t length = is_long ? strcspn(argument + 2, "=") : 0;
    for (size_t i = 0; i < table->option_count; i++) {
        const struct option *option = &table->options[i];
        if (is_long && option->name && strlen(option->name) == length &&
            strncmp(option->name, argument + 2, length) == 0)
            return option;
        if (!is_long && option->letter == argument[1] && argument[2] == '\0')
            return option;
    }
    return NULL;
}

static bool refuse_unknown(const struct option_table *table, const char *argument)
{
    char question[64];
    const char *word = argument + strspn(argument, "-");
    struct nearest nearest = {.word = word, .word_length = strcspn(word, "=")};
    for (size_t i = 0; i < table->option_count; i++)
        if (table->options[i].name && table->options[i].kind != OPTION_RENAMED)
            nearest_try(&nearest, table->options[i].name, strlen(table->options[i].name));
    return options_refuse(table, "there is no option %s%s --help lists all", argument,
                          nearest.best ? nearest_question(&nearest, "--", question, sizeof question)
                                       : ";");
}

static bool refuse_value(const struct option_table *table, const struct option *option,
                         const char *text)
{
    char wanted[512];
    return options_refuse(table, "--%s%s%s: wants %s", option->name, *text ? " " : "", text,
                          option_value_wanted(option, text, wanted, sizeof wanted));
}

static bool is_dashes(const char *argument)
{
    return strcmp(argument, "--") == 0;
}

static bool take_list(struct command_line *line, const struct option *option, bool has_value)
{
    struct option_list *list = option->value;
    int next = line->index + 1;
    if (has_value || list->count > 0)
        return options_refuse(line->table, "--%s: give it once, with all of %s behind it",
                              option->name, option->operand);
    bool all = next < line->argc && is_dashes(line->argv[next]);
    int first = next + all, end = first;
    while (end < line->argc && (all || strncmp(line->argv[end], "--", 2) != 0))
        end++;
    list->items = line->argv + first;
    list->count = (size_t)(end - first);
    line->index = end - 1;
    return list->count > 0 || refuse_value(line->table, option, "");
}

/* Takes the value behind `--name=` or the next argument. */
static bool take_option(struct command_line *line)
{
    const char *argument = line->argv[line->index];
    const struct option *option = find_option(line->table, argument);
    if (!option)
        return refuse_unknown(line->table, argument);
    const char *equals = argument[1] == '-' ? strchr(argument, '=') : NULL;
    if (option->given)
        *option->given = true;
    if (option->kind == OPTION_RENAMED)
        return options_refuse(line->table, "--%s is called --%s", option->name, option->operand);
    if (option->kind == OPTION_LIST)
        return take_list(line, option, equals != NULL);
    if (option->kind == OPTION_FLAG) {
        *(bool *)option->value = true;
        return !equals || refuse_value(line->table, option, equals + 1);
    }
    if (!equals && line->index + 1 >= line->argc)
        return refuse_value(line->table, option, "");
    const char *text = equals ? equals + 1 : line->argv[++line->index];
    return option_value_read(option, text) || refuse_value(line->table, option, text);
}

static bool take_word(struct command_line *line, char *word)
{
    const struct option_table *table = line->table;
    for (; line->next_row < table->option_count; line->next_row++) {
        const struct option *option = &table->options[line->next_row];
        if (option->kind == OPTION_WORD) {
            *(const char **)option->value = word;
            line->next_row++;
            return true;
        }
    }
    if (!find_kind(table, OPTION_WORDS))
        return options_refuse(table, "'%s' is one word too many; --help says more", word);
    line->argv[1 + line->word_count++] = word;
    return true;
}

/* Returns false after a mistake. */
static bool take_all(struct command_line *line)
{
    const struct option *rest = find_kind(line->table, OPTION_REST);
    bool only_words = false;
    for (line->index = 1; line->index < line->argc; line->index++) {
        char *argument = line->argv[line->index];
        if (!only_words && is_dashes(argument)) {
            only_words = true;
            if (rest) {
                struct option_list *list = rest->value;
                list->items = line->argv + line->index + 1;
                list->count = (size_t)(line->argc - line->index - 1);
                return true;
            }
        } else if (only_words || argument[0] != '-' || argument[1] == '\0') {
            if (!take_word(line, argument))
                return false;
        } else if (!take_option(line)) {
            return false;
        }
    }
    return true;
}

static bool has_needed_words(const struct command_line *line)
{
    for (size_t i = 0; i < line->table->option_count; i++) {
        const struct option *option = &line->table->options[i];
        bool missing = (option->kind == OPTION_WORD && i >= line->next_row) ||
                       (option->kind == OPTION_WORDS && line->word_count == 0);
        if (missing && option->minimum > 0)
            return options_refuse(line->table, "%s is needed; --help says more", option->help);
    }
    return true;
}

static void set_initial_values(const struct option_table *table)
{
    for (size_t i = 0; i < table->option_count; i++) {
        const struct option *option = &table->options[i];
        if (!option->initial || *option->initial == '(')
            continue;
        bool is_value = option_value_read(option, option->initial);
        assert(is_value);
        (void)is_value;
    }
}

static bool asks_for_help(int argc, char **argv)
{
    for (int i = 1; i < argc && !is_dashes(argv[i]); i++)
        if (strcmp(argv[i], "--help") == 0 || strcmp(argv[i], "-h") == 0)
            return true;
    return false;
}

enum option_outcome options_parse(const struct option_table *table, int argc, char **argv)
{
    struct command_line line = {.table = table, .argc = argc, .argv = argv};
    const struct option *words = find_kind(table, OPTION_WORDS);
    assert(!words || !find_kind(table, OPTION_LIST));
    if (asks_for_help(argc, argv)) {
        option_help_print(table, stdout);
        return OPTIONS_HELP;
    }
    set_initial_values(table);
    if (!take_all(&line) || !has_needed_words(&line))
        return OPTIONS_ERROR;
    if (words)
        *(struct option_list *)words->value =
            (struct option_list){argv + 1, (size_t)line.word_count};
    return OPTIONS_RUN;
}
