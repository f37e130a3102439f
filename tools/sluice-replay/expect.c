#include "expect.h"

#include "../common/input.h"
#include "../common/text.h"
#include "trace.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char hash_prefix[] = "hash ";

static bool is_hash(const char *line)
{
    return strncmp(line, hash_prefix, sizeof hash_prefix - 1) == 0;
}

/* Returns the next line that is not a comment, NUL-terminated, or NULL at the end. */
static char *next_line(struct expectation *e)
{
    while (*e->next) {
        char *line = e->next;
        size_t size = strcspn(line, "\n");
        e->next = line + size + (line[size] == '\n');
        line[size] = '\0';
        if (size > 0 && line[size - 1] == '\r')
            line[size - 1] = '\0';
        e->number++;
        if (line[0] != '#')
            return line;
    }
    return NULL;
}

static void say_difference(const struct expectation *e, size_t number, const char *expected,
                           const char *got)
{
    text_say("sluice-replay: %s:%llu differs", e->path, (unsigned long long)number);
    text_say("  expected: %s", expected);
    text_say("  got:      %s", got);
}

bool expectation_open(struct expectation *e, const char *path, uint64_t memory)
{
    *e = (struct expectation){.path = path};
    FILE *stream = input_open_stream(path);
    bool done = stream && input_read_rest(stream, memory, &e->text, &e->size);
    int error = errno;
    if (stream)
        fclose(stream);
    if (!done) {
        say_unread(path, error, memory);
        return false;
    }
    e->next = e->text;
    const char *first = e->text;
    while (*first == '#')
        first += strcspn(first, "\n") + (first[strcspn(first, "\n")] == '\n');
    e->hash_only = is_hash(first);
    return true;
}

void expectation_line(struct expectation *e, const char *line)
{
    if (e->differs || (e->hash_only && !is_hash(line)))
        return;
    const char *expected = next_line(e);
    if (expected && strcmp(expected, line) == 0)
        return;
    e->differs = true;
    say_difference(e, expected ? e->number : e->number + 1, expected ? expected : "(end of file)",
                   line);
}

bool expectation_close(struct expectation *e)
{
    const char *left = e->differs ? NULL : next_line(e);
    if (left) {
        e->differs = true;
        say_difference(e, e->number, left, "(end)");
    }
    free(e->text);
    e->text = NULL;
    return !e->differs;
}
