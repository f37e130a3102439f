#include "help_text.h"

#include <stdlib.h>
#include <string.h>

#include "memory.h"

/* Finds the line "  --name ...". */
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

/* Returns the end of an entry: before the next option, heading or empty line. */
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

/* Replaces each run of blanks and line ends by one space. */
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

/* Moves the text in brackets at the end of the meaning to the default. Removes a text in
 * parentheses, which is no value. */
static void split_default(struct help_entry *entry)
{
    size_t length = strlen(entry->meaning);
    char last = length > 0 ? entry->meaning[length - 1] : '\0';
    char *open = NULL;
    if (*entry->operand != '\0' && (last == ']' || last == ')'))
        open = strrchr(entry->meaning, last == ']' ? '[' : '(');
    if (!open) {
        entry->default_value = memory_copy_text("");
        return;
    }
    entry->meaning[length - 1] = '\0';
    entry->default_value = memory_copy_text(last == ']' ? open + 1 : "");
    while (open > entry->meaning && open[-1] == ' ')
        open--;
    *open = '\0';
}

/* Finds the operand, which begins after one space and ends before two. Returns 0 for an option
 * without an operand. */
static size_t operand_length(const char *at, const char **start)
{
    *start = at + (*at == '=' || *at == ' ');
    if (at[0] == ' ' && at[1] == ' ')
        return 0;
    size_t line = strcspn(*start, "\n");
    const char *end = strstr(*start, "  ");
    return end && (size_t)(end - *start) < line ? (size_t)(end - *start) : line;
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
