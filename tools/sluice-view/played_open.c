/* fileno, fstat */
#define _XOPEN_SOURCE 700

#include "played.h"

#include "../common/files.h"
#include "../common/input.h"
#include "../common/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_TRACE_SIZE (1ull << 30)
#define MAGIC_SIZE 8u

static bool begins_as_trace(const char *bytes, size_t size)
{
    static const char *const magics[] = {"SLUICERT", "SLUICEDR", "SLTRACE1"};
    for (size_t i = 0; size >= MAGIC_SIZE && i < sizeof magics / sizeof *magics; i++)
        if (memcmp(bytes, magics[i], MAGIC_SIZE) == 0)
            return true;
    return false;
}

bool played_takes(const char *path)
{
    char magic[MAGIC_SIZE];
    if (files_has_suffix(path, ".trace|.slt"))
        return true;
    FILE *file = input_open(path);
    const size_t read = file ? fread(magic, 1, sizeof magic, file) : 0;
    if (file)
        fclose(file);
    return begins_as_trace(magic, read);
}

struct played *played_open(const char *path, played_progress *progress, void *user)
{
    char *data = NULL;
    size_t size = 0;
    if (!input_read_file(path, MOST_TRACE_SIZE, &data, &size)) {
        text_say("sluice-view: %s: %s", path, input_reason(errno));
        return NULL;
    }
    if (size == 0) {
        text_say("sluice-view: %s: is empty: no recording", path);
        free(data);
        return NULL;
    }
    if (!begins_as_trace(data, size)) {
        text_say("sluice-view: %s: is no recording: it does not begin with SLUICERT", path);
        free(data);
        return NULL;
    }
    return played_open_bytes(path, data, size, 0, progress, user);
}
