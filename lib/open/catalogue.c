#include "open/catalogue.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/system.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_SIZE ((uint64_t)1 << 28)
#define PIECE ((size_t)1 << 20)
#define COLUMNS 8u
#define PICTURE 6u /* column */
#define STORE 7u
static const char head[] =
    "sluice catalogue 1\nhash\tformat\twidth\theight\tlayers\tbytes\tpicture\tstore\n";

static SluiceResult read_file(void *user, uint64_t offset, void *bytes, size_t size)
{
    const int descriptor = *(const int *)user;
    for (size_t done = 0; done < size;) {
        int64_t got =
            slc_file_read_at(descriptor, offset + done, (char *)bytes + done, size - done);
        if (got > 0)
            done += (size_t)got;
        else if (got == 0 || errno != EINTR)
            return SLUICE_ERROR_IO;
    }
    return SLUICE_SUCCESS;
}

/* Ends with a zero. `*text` has `input->size` + 1 bytes, and is the caller's also after an error.
 */
static SluiceResult read_text(const struct slc_catalogue_query *q, const SluiceInput *input,
                              char **text)
{
    SluiceResult result = SLUICE_SUCCESS;
    if (input->size > MAX_SIZE) {
        slc_log(q->log, SLUICE_LOG_ERROR, "%s: is larger than 256 MiB", q->shown);
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    const size_t size = (size_t)input->size;
    *text = slc_alloc(q->allocator, size + 1, 1);
    if (!*text)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (input->pBytes)
        memcpy(*text, input->pBytes, size);
    for (size_t at = 0; at < size && !input->pBytes && result == SLUICE_SUCCESS; at += PIECE)
        result =
            input->pfnRead(input->pUserData, at, *text + at, size - at < PIECE ? size - at : PIECE);
    (*text)[size] = '\0';
    if (result != SLUICE_SUCCESS)
        slc_log(q->log, SLUICE_LOG_ERROR, "%s: cannot be read", q->shown);
    return result;
}

/* "\t", "\n", "\r" and "\\" become one character each. */
static void unescape(char *text)
{
    char *out = text;
    for (; *text; text++) {
        if (*text == '\\' && text[1]) {
            text++;
            *out++ = *text == 't' ? '\t' : *text == 'n' ? '\n' : *text == 'r' ? '\r' : *text;
        } else {
            *out++ = *text;
        }
    }
    *out = '\0';
}

/* Cuts a line into its columns. False: it is damaged. */
static bool split(char *line, char *columns[COLUMNS])
{
    for (uint32_t i = 0; i < COLUMNS; i++) {
        columns[i] = line;
        char *end = strchr(line, '\t');
        if (!end != (i + 1 == COLUMNS))
            return false;
        if (end) {
            *end = '\0';
            line = end + 1;
        }
    }
    unescape(columns[PICTURE]);
    unescape(columns[STORE]);
    return strspn(columns[0], "0123456789abcdef") == 16 && strlen(columns[0]) == 16 &&
           columns[STORE][0];
}

/* 2: it is the name; 1: it ends with the name, behind a slash. */
static int match(const char *text, const char *name)
{
    size_t length = strlen(text), wanted = strlen(name);
    if (strcmp(text, name) == 0)
        return 2;
    return length > wanted && text[length - wanted - 1] == '/' &&
           strcmp(text + length - wanted, name) == 0;
}

static bool is_absolute(const char *store)
{
    return store[0] == '/' || store[0] == '\\' || strstr(store, "://") ||
           (store[0] && store[1] == ':');
}

/* As the path of a URL of the web. s3:// URLs have keys as they are. */
static void append(char *out, const char *text, bool escapes)
{
    static const char plain[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
    out += strlen(out);
    for (; *text; text++) {
        if (!escapes || strchr(plain, *text))
            *out++ = *text;
        else
            out += snprintf(out, 4, "%%%02X", (unsigned)(unsigned char)*text);
    }
    *out = '\0';
}

/* Relative names begin in the catalogue's folder. */
static SluiceResult make_path(const struct slc_catalogue_query *q, const char *store, char **path)
{
    const bool is_web = strncmp(q->path, "http", 4) == 0 && strstr(q->path, "://");
    const bool is_local = !strstr(q->path, "://");
    /* A server must not choose among this machine's files. */
    if (!is_local && is_absolute(store) && !strstr(store, "://")) {
        slc_log(q->log, SLUICE_LOG_ERROR, "%s: names the local file %s", q->shown, store);
        return SLUICE_ERROR_CORRUPT_DATA;
    }
    size_t folder = is_local ? (size_t)(slc_path_name(q->path) - q->path)
                    : is_web ? strcspn(q->path, "?#")
                             : strlen(q->path);
    while (!is_local && folder > 0 && q->path[folder - 1] != '/')
        folder--;
    if (is_absolute(store))
        folder = 0;
    const size_t size = folder + 3 * strlen(store) + 1;
    char *made = slc_alloc(q->allocator, size, 1);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memcpy(made, q->path, folder);
    made[folder] = '\0';
    append(made, store, is_web && folder > 0);
    *path = slc_strdup(q->allocator, made);
    slc_free(q->allocator, made, size, 1);
    return *path ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/* Looks at all rows, whatever is found: a damaged catalogue is refused for each name. */
static SluiceResult find_row(const struct slc_catalogue_query *q, char *text, char *found[COLUMNS])
{
    char *columns[COLUMNS];
    uint32_t count = 0, line_number = 3;
    int best = 0;
    if (strncmp(text, head, sizeof head - 1) != 0) {
        slc_log(q->log, SLUICE_LOG_ERROR, "%s: its columns are not those of a catalogue", q->shown);
        return SLUICE_ERROR_CORRUPT_DATA;
    }
    for (char *line = text + sizeof head - 1; *line; line_number++) {
        char *end = strchr(line, '\n');
        if (end)
            *end = '\0';
        if (!end || !split(line, columns)) {
            slc_log(q->log, SLUICE_LOG_ERROR, "%s:%u: is no row of a catalogue", q->shown,
                    (unsigned)line_number);
            return SLUICE_ERROR_CORRUPT_DATA;
        }
        int a = q->name ? match(columns[PICTURE], q->name) : line_number == 3;
        int b = q->name ? match(columns[STORE], q->name) : 0;
        int how = a > b ? a : b;
        count = how > best ? 1 : count + (how > 0 && how == best);
        if (how > best)
            memcpy(found, columns, sizeof columns);
        best = how > best ? how : best;
        line = end + 1;
    }
    if (count == 1)
        return SLUICE_SUCCESS;
    return slc_log_refusal(q->log, "%s: %s '%s'", q->shown,
                           count ? "has several pictures or stores" : "has no picture and no store",
                           q->name ? q->name : "");
}

static SluiceResult find_in(const struct slc_catalogue_query *q, const SluiceInput *input,
                            struct slc_catalogue_entry *entry)
{
    char *text = NULL, *columns[COLUMNS] = {0};
    SluiceResult result = read_text(q, input, &text);
    if (result == SLUICE_SUCCESS)
        result = find_row(q, text, columns);
    if (result == SLUICE_SUCCESS) {
        entry->hash = strtoull(columns[0], NULL, 16);
        result = make_path(q, columns[STORE], &entry->store);
    }
    if (text)
        slc_free(q->allocator, text, (size_t)input->size + 1, 1);
    return result;
}

SluiceResult slc_catalogue_find(const struct slc_catalogue_query *q,
                                struct slc_catalogue_entry *entry)
{
    struct slc_pooled_file file = SLC_POOLED_FILE_CLOSED;
    struct slc_file_status status;
    if (q->input)
        return find_in(q, q->input, entry);
    int descriptor = slc_file_pool_acquire(q->pool, &file, q->path);
    if (descriptor < 0)
        return slc_system_result(errno);
    SluiceResult result = SLUICE_ERROR_IO;
    if (slc_file_get_status(descriptor, &status)) {
        SluiceInput input = {.structSize = sizeof input,
                             .size = status.size,
                             .pUserData = &descriptor,
                             .pfnRead = read_file};
        result = find_in(q, &input, entry);
    }
    slc_file_pool_release(q->pool, &file);
    slc_file_pool_remove(q->pool, &file);
    return result;
}

void slc_catalogue_entry_finish(struct slc_catalogue_entry *entry,
                                const SluiceAllocationCallbacks *cb)
{
    if (entry->store)
        slc_free(cb, entry->store, strlen(entry->store) + 1, 1);
    entry->store = NULL;
}
