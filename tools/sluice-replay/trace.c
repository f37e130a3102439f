#include "trace.h"

#include "../common/input.h"
#include "../common/text.h"

#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#define MAGIC_SIZE 8

static bool fail(const char *path, const char *why)
{
    text_say("sluice-replay: %s: %s", path, why);
    return false;
}

void say_unread(const char *path, int error, uint64_t memory)
{
    if (error == EFBIG)
        text_say("sluice-replay: %s: has more than %" PRIu64 " MiB; --memory SIZE allows more",
                 path, memory >> 20);
    else
        text_say("sluice-replay: %s: %s", path, input_reason(error));
}

/* Reads and checks the first bytes, because a device or a film of many gigabytes is no trace. */
static bool read_magic(FILE *stream, const char *path, char **data, size_t *size)
{
    *data = malloc(MAGIC_SIZE);
    if (!*data)
        return fail(path, strerror(ENOMEM));
    *size = fread(*data, 1, MAGIC_SIZE, stream);
    if (ferror(stream))
        return fail(path, strerror(errno));
    static const char *const magics[] = {"SLUICERT", "SLUICEDR", "SLTRACE1"};
    for (size_t i = 0; *size == MAGIC_SIZE && i < sizeof magics / sizeof *magics; i++)
        if (memcmp(*data, magics[i], MAGIC_SIZE) == 0)
            return true;
    return fail(path, "is no trace: it begins with none of SLUICERT, SLUICEDR, SLTRACE1");
}

static bool read_all(FILE *stream, const char *path, uint64_t memory, char **data, size_t *size)
{
    if (!read_magic(stream, path, data, size))
        return false;
    if (input_read_rest(stream, memory, data, size))
        return true;
    say_unread(path, errno, memory);
    return false;
}

bool read_trace(const char *path, uint64_t memory, char **data, size_t *size)
{
    *data = NULL;
    *size = 0;
    FILE *stream = input_open_stream(path);
    if (!stream)
        return fail(path, input_reason(errno));
    bool done = read_all(stream, path, memory, data, size);
    fclose(stream);
    if (!done) {
        free(*data);
        *data = NULL;
    }
    return done;
}
