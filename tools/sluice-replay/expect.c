#include "expect.h"

#include "file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char hash_prefix[] = "hash ";

static bool is_hash(const char *line)
{
    return strncmp(line, hash_prefix, sizeof hash_prefix - 1) == 0;
}

/* The next line that is not a comment, NUL-terminated; NULL at the end. */
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

bool expectation_open(struct expectation *e, const char *path)
{
    size_t size;
    *e = (struct expectation){.path = path};
    if (!read_file(path, &e->text, &size)) {
        fprintf(stderr, "sluice-replay: %s: %s\n", path, strerror(errno));
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
    fprintf(stderr, "sluice-replay: %s:%zu differs\n  expected: %s\n  got:      %s\n", e->path,
            expected ? e->number : e->number + 1, expected ? expected : "(end of file)", line);
}

bool expectation_close(struct expectation *e)
{
    const char *left = e->differs ? NULL : next_line(e);
    if (left) {
        e->differs = true;
        fprintf(stderr, "sluice-replay: %s:%zu differs\n  expected: %s\n  got:      (end)\n",
                e->path, e->number, left);
    }
    free(e->text);
    e->text = NULL;
    return !e->differs;
}
