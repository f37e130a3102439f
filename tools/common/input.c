#define _POSIX_C_SOURCE 200809L
#include "input.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define NO_REGULAR_FILE ENOTSUP ///< no call here fails so by itself
#define FIRST_CAPACITY 65536u

/* Takes over the descriptor. */
static FILE *take(int descriptor, bool any_kind)
{
    struct stat status;
    FILE *file = NULL;
    if (descriptor < 0)
        return NULL;
    bool known = fstat(descriptor, &status) == 0;
    if (known && S_ISDIR(status.st_mode))
        errno = EISDIR;
    else if (known && !any_kind && !S_ISREG(status.st_mode))
        errno = NO_REGULAR_FILE;
    else if (known)
        file = fdopen(descriptor, "rb");
    int error = errno;
    if (!file)
        close(descriptor);
    errno = error;
    return file;
}

FILE *input_open(const char *path)
{
    /* Do not block: a pipe may have no writer. The flag changes nothing for regular files. */
    return take(open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY), false);
}

/* Returns the number behind /dev/fd/, or -1. */
static int descriptor_of(const char *path)
{
    static const char folder[] = "/dev/fd/";
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdin") == 0)
        return STDIN_FILENO;
    if (strncmp(path, folder, sizeof folder - 1) != 0)
        return -1;
    char *end;
    const char *digits = path + sizeof folder - 1;
    long number = strtol(digits, &end, 10);
    return *digits >= '0' && *digits <= '9' && *end == '\0' && number < 1 << 20 ? (int)number : -1;
}

FILE *input_open_stream(const char *path)
{
    int descriptor = descriptor_of(path);
    if (descriptor < 0)
        return input_open(path);
    return take(fcntl(descriptor, F_DUPFD_CLOEXEC, 0), true);
}

const char *input_stream_path(const char *path)
{
    return strcmp(path, "-") == 0 ? "/dev/stdin" : path;
}

const char *input_reason(int error)
{
    return error == NO_REGULAR_FILE ? "is not a regular file" : strerror(error);
}

/* Makes room for one byte more than the input so far, to detect that it exceeds the limit, and for
 * the NUL. */
static bool grow(char **data, size_t *capacity, size_t size, uint64_t limit)
{
    if (size + 1 < *capacity)
        return true;
    uint64_t wanted = *capacity ? 2 * (uint64_t)*capacity : FIRST_CAPACITY;
    if (wanted > limit && limit <= SIZE_MAX - 2 && limit + 2 >= size + 2)
        wanted = limit + 2;
    char *bigger = wanted <= SIZE_MAX / 2 ? realloc(*data, wanted) : NULL;
    if (!bigger) {
        errno = ENOMEM;
        return false;
    }
    *data = bigger;
    *capacity = (size_t)wanted;
    return true;
}

static bool read_on(FILE *stream, uint64_t limit, char **data, size_t *size)
{
    for (size_t capacity = 0; grow(data, &capacity, *size, limit);) {
        size_t got = fread(*data + *size, 1, capacity - *size - 1, stream);
        *size += got;
        (*data)[*size] = '\0';
        if (*size > limit) {
            errno = EFBIG;
            return false;
        }
        if (got == 0)
            return !ferror(stream);
    }
    return false;
}

bool input_read_rest(FILE *stream, uint64_t limit, char **data, size_t *size)
{
    if (read_on(stream, limit, data, size))
        return true;
    int error = errno;
    free(*data);
    *data = NULL;
    *size = 0;
    errno = error;
    return false;
}

bool input_read_file(const char *path, uint64_t limit, char **data, size_t *size)
{
    *data = NULL;
    *size = 0;
    FILE *file = input_open(path);
    bool done = file && input_read_rest(file, limit, data, size);
    int error = errno;
    if (file)
        fclose(file);
    errno = error;
    return done;
}
