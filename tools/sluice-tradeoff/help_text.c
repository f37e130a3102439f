#include "help_text.h"

#include <stdlib.h>
#include <string.h>

#include "memory.h"

/* The line "  --name ..." */
static const char *find_line(const char *help, const char *name)
{
    size_t length = strlen(name);
    for (const char *line = help; *line;) {
        const char *at = line + strspn(line, " ");
        if (at > line && strncmp(at, "--", 2) == 0 && strncmp(at + 2, name, length) == 0 &&
            strchr(" =\n", at[2 + length]))
            return at;
        line += strcspn(line, "\n");
        line += *line == '\n';
    }
    return NULL;
}

/* Up to the next option, heading or empty line. */
static const char *entry_end(const char *at)
{
    for (;;) {
        at += strcspn(at, "\n");
        if (*at == '\0')
            return at;
        const char *words = at + 1 + strspn(at + 1, " ");
        if (words == at + 1 || *words == '\n' || *words == '\0' || strncmp(words, "--", 2) == 0)
            return at;
        at++;
    }
}

/* Blanks and ends of lines become one space each. */
static char *one_line(const char *text, size_t length)
{
    char *line = memory_take(length + 1, 1), *out = line;
    for (size_t i = 0; i < length; i++) {
        bool blank = text[i] == ' ' || text[i] == '\n';
        if (!blank)
            *out++ = text[i];
        else if (out > line && out[-1] != ' ')
            *out++ = ' ';
    }
    while (out > line && out[-1] == ' ')
        *--out = '\0';
    return line;
}

/* "[what]" or "(a number)" at the end; NULL: neither. */
static char *find_default(char *meaning)
{
    size_t length = strlen(meaning);
    char *bracket = strrchr(meaning, '['), *round = strrchr(meaning, '('), *end;
    if (length > 0 && meaning[length - 1] == ']')
        return bracket;
    if (!round || meaning[length - 1] != ')')
        return NULL;
    strtod(round + 1, &end);
    return end != round + 1 && end == meaning + length - 1 ? round : NULL;
}

static void split_default(struct help_entry *entry)
{
    size_t length = strlen(entry->meaning);
    char *open = find_default(entry->meaning);
    entry->default_value = memory_copy_text("");
    if (!open)
        return;
    entry->meaning[length - 1] = '\0';
    free(entry->default_value);
    entry->default_value = memory_copy_text(open + 1);
    while (open > entry->meaning && open[-1] == ' ')
        open--;
    *open = '\0';
}

/* The operand is one space away; where it has a column of its own it is a word of capitals, two
 * spaces before what it means. Nothing: the option stands alone. */
static size_t operand_length(const char *at, const char **start)
{
    const char *end;
    *start = at + (*at == '=' || *at == ' ');
    if (*at == ' ' && at[1] == ' ')
        *start = at + strspn(at, " ");
    size_t line = strcspn(*start, "\n");
    end = strstr(*start, "  ");
    size_t length = end && (size_t)(end - *start) < line ? (size_t)(end - *start) : line;
    if (at[0] == ' ' && at[1] == ' ' &&
        (length == line || strspn(*start, "ABCDEFGHIJKLMNOPQRSTUVWXYZ|/") != length))
        return 0;
    return length;
}

bool help_text_find(const char *help, const char *name, struct help_entry *entry)
{
    const char *at = find_line(help, name), *operand;
    *entry = (struct help_entry){0};
    if (!at)
        return false;
    const char *end = entry_end(at);
    size_t length = operand_length(at + 2 + strlen(name), &operand);
    entry->operand = one_line(operand, length);
    const char *words = operand + length;
    while (*words == ' ' || *words == '\n')
        words++;
    entry->meaning = one_line(words, words < end ? (size_t)(end - words) : 0);
    split_default(entry);
    return true;
}

void help_entry_finish(struct help_entry *entry)
{
    free(entry->operand);
    free(entry->meaning);
    free(entry->default_value);
    *entry = (struct help_entry){0};
}
