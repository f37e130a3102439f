#include "lines.h"

#include "support/test.h"

#include <stdlib.h>
#include <string.h>

void lines_take(void *user, const char *line)
{
    struct lines *lines = user;
    size_t size = strlen(line);
    assert_null(strchr(line, '\n'));
    if (lines->size + size + 2 > lines->capacity) {
        lines->capacity = 2 * (lines->size + size + 2);
        lines->text = realloc(lines->text, lines->capacity);
        assert_non_null(lines->text);
    }
    memcpy(lines->text + lines->size, line, size);
    lines->size += size;
    lines->text[lines->size++] = '\n';
    lines->text[lines->size] = '\0';
}

void lines_free(struct lines *lines)
{
    free(lines->text);
    *lines = (struct lines){0};
}
