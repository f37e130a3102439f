#include "scene_catalogue.h"

#include "../common/log.h"
#include "../common/names_in_lines.h"
#include "../common/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SIZE ((uint64_t)1 << 28)
#define PIECE ((size_t)1 << 20)
#define STORE 7 /* column */

bool scene_catalogue_takes(const char *path)
{
    char name[256];
    if (!remote_is_url(path))
        return files_has_suffix(path, CATALOGUE);
    remote_name(path, name, sizeof name);
    return files_has_suffix(name, CATALOGUE);
}

static bool read_file(const char *path, char *text, size_t size)
{
    FILE *file = fopen(path, "rb");
    const bool read = file && fread(text, 1, size, file) == size;
    if (file)
        fclose(file);
    return read;
}

static bool read_input(const SluiceInput *input, char *text, size_t size)
{
    SluiceResult result = SLUICE_SUCCESS;
    for (size_t at = 0; at < size && result == SLUICE_SUCCESS; at += PIECE)
        result =
            input->pfnRead(input->pUserData, at, text + at, size - at < PIECE ? size - at : PIECE);
    return result == SLUICE_SUCCESS;
}

/* Reads the text, with a zero at its end. NULL on failure. */
static char *read_text(const char *path, struct remote_session *session)
{
    const SluiceLogCallback log = {NULL, log_say};
    struct remote_file remote = {.file = NULL};
    if (remote_is_url(path) && !remote_open(&remote, session, path, &log))
        return NULL;
    const SluiceInput *input = remote_input(&remote);
    const uint64_t size = input ? input->size : files_size(path);
    char *text = size > 0 && size <= MAX_SIZE ? malloc((size_t)size + 1) : NULL;
    const bool read = text && (input ? read_input(input, text, (size_t)size)
                                     : read_file(path, text, (size_t)size));
    remote_close(&remote);
    if (!read) {
        free(text);
        return NULL;
    }
    text[size] = '\0';
    return text;
}

/* Returns the name in a row of the catalogue; NULL: none. */
static char *store_of(char *line)
{
    for (int i = 0; line && i < STORE; i++) {
        line = strchr(line, '\t');
        line += line ? 1 : 0;
    }
    return line && line_read_name(line) ? line : NULL;
}

bool scene_catalogue_collect(const char *path, struct remote_session *session,
                             struct file_list *files)
{
    char *text = read_text(path, session), name[8192];
    bool collected = text != NULL;
    uint32_t number = 0;
    for (char *line = text, *next; collected && line && *line; line = next) {
        next = strchr(line, '\n');
        if (next)
            *next++ = '\0';
        if (number++ < 2) /* title and names of columns */
            continue;
        const char *store = store_of(line);
        const int length = store ? snprintf(name, sizeof name, "%s#%s", path, store) : -1;
        collected = length > 0 && length < (int)sizeof name && files_add(name, files);
    }
    free(text);
    if (!collected)
        text_say("sluice-view: %.*s: cannot be read as a catalogue", (int)strcspn(path, "?"), path);
    return collected;
}
