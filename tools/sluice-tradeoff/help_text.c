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

static void split_default(struct help_entry *entry)
{
    size_t length = strlen(entry->meaning);
    char *open = strrchr(entry->meaning, '[');
    entry->default_value = memory_copy_text("");
    if (!open || length == 0 || entry->meaning[length - 1] != ']')
        return;
    entry->meaning[length - 1] = '\0';
    free(entry->default_value);
    entry->default_value = memory_copy_text(open + 1);
    while (open > entry->meaning && open[-1] == ' ')
        open--;
    *open = '\0';
}

bool help_text_find(const char *help, const char *name, struct help_entry *entry)
{
    const char *at = find_line(help, name);
    *entry = (struct help_entry){0};
    if (!at)
        return false;
    const char *end = entry_end(at), *line_end = at + strcspn(at, "\n");
    at += 2 + strlen(name);
    /* The operand is one space away, what it means two at least, or on the next line. */
    const char *words = strstr(at, "  ");
    if (!words || words > line_end)
        words = line_end;
    entry->operand = one_line(at, (size_t)(words - at));
    if (entry->operand[0] == '=' || entry->operand[0] == ' ')
        memmove(entry->operand, entry->operand + 1, strlen(entry->operand));
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
