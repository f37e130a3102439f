#include "option_help.h"

#include <stdio.h>
#include <string.h>

#define HELP_COLUMN 30
#define LINE_LENGTH 96
#define LONGEST_OPERAND 40 ///< longer lists of choices are printed behind the help

static void print_words(FILE *out, const char *words, int *column)
{
    for (; *words; words += strspn(words, " ")) {
        int length = (int)strcspn(words, " ");
        if (*column > HELP_COLUMN && *column + 1 + length > LINE_LENGTH) {
            fprintf(out, "\n%*s", HELP_COLUMN, "");
            *column = HELP_COLUMN;
        }
        *column += fprintf(out, "%s%.*s", *column > HELP_COLUMN ? " " : "", length, words);
        words += length;
    }
}

/* Prints "auto|r8" as "auto, r8". */
static void print_choices(FILE *out, const char *choices, int *column)
{
    char word[64];
    print_words(out, "One of", column);
    for (; *choices; choices += *choices == '|') {
        size_t length = strcspn(choices, "|");
        snprintf(word, sizeof word, "%.*s%s", (int)length, choices, choices[length] ? "," : ".");
        print_words(out, word, column);
        choices += length;
    }
}

static void print_row(FILE *out, const struct option *option)
{
    const char *operand = option->operand ? option->operand : "";
    bool is_long = strlen(operand) > LONGEST_OPERAND;
    int column = 2;
    fprintf(out, "  ");
    if (option->letter)
        column += fprintf(out, "-%c, ", option->letter);
    column +=
        fprintf(out, "--%s%s%s", option->name, *operand ? " " : "", is_long ? "NAME" : operand);
    if (column + 2 > HELP_COLUMN) {
        fprintf(out, "\n");
        column = 0;
    }
    fprintf(out, "%*s", HELP_COLUMN - column, "");
    column = HELP_COLUMN;
    print_words(out, option->help, &column);
    if (is_long)
        print_choices(out, operand, &column);
    if (option->initial) {
        char words[256];
        snprintf(words, sizeof words, *option->initial == '(' ? "%s" : "[%s]", option->initial);
        print_words(out, words, &column);
    }
    fprintf(out, "\n");
}

static bool has_kind(const struct option_table *table, enum option_kind kind)
{
    for (size_t i = 0; i < table->option_count; i++)
        if (table->options[i].kind == kind)
            return true;
    return false;
}

static void print_units(FILE *out, const struct option_table *table)
{
    bool sizes = has_kind(table, OPTION_BYTES), seconds = has_kind(table, OPTION_SECONDS);
    fprintf(out, "\nDefaults are in brackets.");
    if (sizes)
        fprintf(out, " SIZE: like 512K, 64M or 2G; a number alone is in MiB.");
    if (seconds)
        fprintf(out, "%sSECONDS: like 0.5, 250ms or 2min.", sizes ? "\n" : " ");
    fprintf(out, "\n");
}

void option_help_print(const struct option_table *table, FILE *out)
{
    fprintf(out, "%s\n", table->usage);
    bool first = true;
    for (size_t i = 0; i < table->option_count; i++) {
        const struct option *option = &table->options[i];
        switch (option->kind) {
        case OPTION_SECTION:
            fprintf(out, "%s%s\n", first ? "" : "\n", option->help);
            first = false;
            break;
        case OPTION_WORD:
        case OPTION_WORDS:
        case OPTION_REST:
        case OPTION_RENAMED: break;
        default: print_row(out, option); first = false;
        }
    }
    fprintf(out, "%-*sthis text\n", HELP_COLUMN, "  --help");
    print_units(out, table);
    if (table->notes)
        fprintf(out, "\n%s", table->notes);
}
