#include "file.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* By reading on, not by asking for the size, so that pipes work. */
static bool read_stream(FILE *stream, char **data, size_t *size)
{
    size_t capacity = 0;
    for (;;) {
        if (*size + 1 >= capacity) {
            if (capacity > SIZE_MAX / 2) {
                errno = ENOMEM;
                return false;
            }
            capacity = capacity ? 2 * capacity : 65536;
            char *bigger = realloc(*data, capacity);
            if (!bigger)
                return false;
            *data = bigger;
        }
        size_t got = fread(*data + *size, 1, capacity - *size - 1, stream);
        *size += got;
        (*data)[*size] = '\0';
        if (got == 0)
            return !ferror(stream);
    }
}

bool read_file(const char *path, char **data, size_t *size)
{
    *data = NULL;
    *size = 0;
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return false;
    bool read = read_stream(stream, data, size);
    int error = errno;
    fclose(stream);
    if (!read) {
        free(*data);
        *data = NULL;
        errno = error;
    }
    return read;
}
