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

struct row {
    uint64_t hash;
    const char *picture, *store;
};

/** Name, given by the position of its final zero. A zero precedes each name, too. */
struct name_end {
    const char *end;
    uint32_t row;
};

struct slc_catalogue {
    char *names; ///< owned
    size_t names_size;
    struct row *rows;      ///< owned; in the file's order
    struct name_end *ends; ///< owned; two per row, sorted by bytes from last to first
    uint32_t row_count;
};

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

/* Reads the file and appends a zero. `*text` has `input->size` + 1 bytes; the caller frees it, also
 * after an error. */
static SluiceResult read_text(const struct slc_catalogue_place *p, const SluiceInput *input,
                              char **text)
{
    SluiceResult result = SLUICE_SUCCESS;
    if (input->size > MAX_SIZE) {
        slc_log(p->log, SLUICE_LOG_ERROR, "%s: is larger than 256 MiB", p->shown);
        return SLUICE_ERROR_LIMIT_EXCEEDED;
    }
    const size_t size = (size_t)input->size;
    *text = slc_alloc(p->allocator, size + 1, 1);
    if (!*text)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (input->pBytes)
        memcpy(*text, input->pBytes, size);
    for (size_t at = 0; at < size && !input->pBytes && result == SLUICE_SUCCESS; at += PIECE)
        result =
            input->pfnRead(input->pUserData, at, *text + at, size - at < PIECE ? size - at : PIECE);
    (*text)[size] = '\0';
    if (result != SLUICE_SUCCESS)
        slc_log(p->log, SLUICE_LOG_ERROR, "%s: cannot be read", p->shown);
    return result;
}

/* Replaces "\t", "\n", "\r" and "\\" by one character each. */
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

static bool is_absolute(const char *store)
{
    return store[0] == '/' || store[0] == '\\' || strstr(store, "://") ||
           (store[0] && store[1] == ':');
}

/* Appends text, percent-encoded for http URLs. s3:// URLs keep keys unescaped. */
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

/* Makes the path of a store. Relative names start in the catalogue's folder. */
static SluiceResult make_path(const struct slc_catalogue_place *p, const char *store, char **path)
{
    const bool is_web = strncmp(p->path, "http", 4) == 0 && strstr(p->path, "://");
    const bool is_local = !strstr(p->path, "://");
    /* A server must not choose among this machine's files. */
    if (!is_local && is_absolute(store) && !strstr(store, "://")) {
        slc_log(p->log, SLUICE_LOG_ERROR, "%s: names the local file %s", p->shown, store);
        return SLUICE_ERROR_CORRUPT_DATA;
    }
    size_t folder = is_local ? (size_t)(slc_path_name(p->path) - p->path)
                    : is_web ? strcspn(p->path, "?#")
                             : strlen(p->path);
    while (!is_local && folder > 0 && p->path[folder - 1] != '/')
        folder--;
    if (is_absolute(store))
        folder = 0;
    const size_t size = folder + 3 * strlen(store) + 1;
    char *made = slc_alloc(p->allocator, size, 1);
    if (!made)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memcpy(made, p->path, folder);
    made[folder] = '\0';
    append(made, store, is_web && folder > 0);
    *path = slc_strdup(p->allocator, made);
    slc_free(p->allocator, made, size, 1);
    return *path ? SLUICE_SUCCESS : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

/* Orders names by bytes from last to first. */
static int compare_ends(const void *a, const void *b)
{
    const char *x = ((const struct name_end *)a)->end, *y = ((const struct name_end *)b)->end;
    do {
        x--;
        y--;
    } while (*x == *y && *x);
    return (int)(unsigned char)*x - (int)(unsigned char)*y;
}

static bool has_end(const struct name_end *name, const char *begin, const char *end)
{
    const char *at = name->end;
    while (end > begin && at[-1] == end[-1]) {
        at--;
        end--;
    }
    return end == begin;
}

static SluiceResult refuse_row(const struct slc_catalogue_place *p, uint32_t row)
{
    slc_log(p->log, SLUICE_LOG_ERROR, "%s:%u: is no row of a catalogue", p->shown,
            (unsigned)row + 3);
    return SLUICE_ERROR_CORRUPT_DATA;
}

static char *keep_name(char *out, const char *name)
{
    const size_t size = strlen(name) + 1;
    memmove(out, name, size);
    return out + size;
}

/* Moves the names of all rows to the front of `text`, each with its zero, behind a first zero, and
 * puts the hashes into the rows. */
static SluiceResult take_rows(const struct slc_catalogue_place *p, char *text,
                              struct slc_catalogue *c)
{
    char *columns[COLUMNS], *out = text + 1;
    uint32_t row = 0;
    for (char *line = text + sizeof head - 1; *line; row++) {
        char *end = strchr(line, '\n');
        if (end)
            *end = '\0';
        if (!end || !split(line, columns))
            return refuse_row(p, row);
        c->rows[row].hash = strtoull(columns[0], NULL, 16);
        out = keep_name(keep_name(out, columns[PICTURE]), columns[STORE]);
        line = end + 1;
    }
    text[0] = '\0';
    c->names_size = (size_t)(out - text);
    return SLUICE_SUCCESS;
}

static void sort_names(struct slc_catalogue *c)
{
    const char *at = c->names + 1;
    for (uint32_t i = 0; i < c->row_count; i++) {
        c->rows[i].picture = at;
        c->ends[2 * i] = (struct name_end){at + strlen(at), i};
        c->rows[i].store = c->ends[2 * i].end + 1;
        at = c->rows[i].store + strlen(c->rows[i].store);
        c->ends[2 * i + 1] = (struct name_end){at++, i};
    }
    if (c->row_count > 0) /* the array is NULL without rows */
        qsort(c->ends, 2 * (size_t)c->row_count, sizeof *c->ends, compare_ends);
}

static SluiceResult parse(const struct slc_catalogue_place *p, char *text, struct slc_catalogue *c)
{
    if (strncmp(text, head, sizeof head - 1) != 0) {
        slc_log(p->log, SLUICE_LOG_ERROR, "%s: its columns are not those of a catalogue", p->shown);
        return SLUICE_ERROR_CORRUPT_DATA;
    }
    for (const char *at = text + sizeof head - 1; (at = strchr(at, '\n')); at++)
        c->row_count++;
    c->rows = slc_alloc(p->allocator, c->row_count, sizeof *c->rows);
    c->ends = slc_alloc(p->allocator, c->row_count, 2 * sizeof *c->ends);
    if (c->row_count && (!c->rows || !c->ends))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = take_rows(p, text, c);
    if (result != SLUICE_SUCCESS)
        return result;
    c->names = slc_alloc(p->allocator, c->names_size, 1);
    if (!c->names)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memcpy(c->names, text, c->names_size);
    return SLUICE_SUCCESS;
}

static SluiceResult read_from(const struct slc_catalogue_place *p, const SluiceInput *input,
                              struct slc_catalogue **catalogue)
{
    char *text = NULL;
    struct slc_catalogue *c = slc_calloc(p->allocator, 1, sizeof *c);
    SluiceResult result = c ? read_text(p, input, &text) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS)
        result = parse(p, text, c);
    if (text)
        slc_free(p->allocator, text, (size_t)input->size + 1, 1);
    if (result != SLUICE_SUCCESS) {
        slc_catalogue_destroy(c, p->allocator);
        return result;
    }
    sort_names(c);
    *catalogue = c;
    return SLUICE_SUCCESS;
}

SluiceResult slc_catalogue_read(const struct slc_catalogue_place *p,
                                struct slc_catalogue **catalogue)
{
    struct slc_pooled_file file = SLC_POOLED_FILE_CLOSED;
    struct slc_file_status status;
    if (p->input)
        return read_from(p, p->input, catalogue);
    int descriptor = slc_file_pool_acquire(p->pool, &file, p->path);
    if (descriptor < 0)
        return slc_system_result(errno);
    SluiceResult result = SLUICE_ERROR_IO;
    if (slc_file_get_status(descriptor, &status)) {
        SluiceInput input = {.structSize = sizeof input,
                             .size = status.size,
                             .pUserData = &descriptor,
                             .pfnRead = read_file};
        result = read_from(p, &input, catalogue);
    }
    slc_file_pool_release(p->pool, &file);
    slc_file_pool_remove(p->pool, &file);
    return result;
}

void slc_catalogue_destroy(struct slc_catalogue *c, const SluiceAllocationCallbacks *cb)
{
    if (!c)
        return;
    slc_free(cb, c->names, c->names_size, 1);
    slc_free(cb, c->rows, c->row_count, sizeof *c->rows);
    slc_free(cb, c->ends, c->row_count, 2 * sizeof *c->ends);
    slc_free(cb, c, 1, sizeof *c);
}

/* Counts rows whose name ends with the bytes from `begin` to `end`: 0, 1, or 2 for more. A zero at
 * `begin` matches the start of a name. */
static uint32_t count_rows(const struct slc_catalogue *c, const char *begin, const char *end,
                           uint32_t *row)
{
    const struct name_end key = {end, 0};
    size_t low = 0, high = 2 * (size_t)c->row_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (compare_ends(&c->ends[middle], &key) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    uint32_t count = 0;
    for (; low < 2 * (size_t)c->row_count && has_end(&c->ends[low], begin, end) && count < 2; low++)
        if (count == 0 || c->ends[low].row != *row) {
            *row = c->ends[low].row;
            count++;
        }
    return count;
}

/* Looks for the whole name first, then for names with "/name" at the end. */
static SluiceResult count_named(const struct slc_catalogue *c, const char *name,
                                const SluiceAllocationCallbacks *cb, uint32_t *count, uint32_t *row)
{
    const size_t size = strlen(name) + 3;
    char *key = slc_alloc(cb, size, 1);
    if (!key)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    memcpy(key + 2, name, size - 2);
    key[0] = key[1] = '\0';
    *count = count_rows(c, key + 1, key + size - 1, row);
    key[1] = '/';
    if (*count == 0)
        *count = count_rows(c, key + 1, key + size - 1, row);
    slc_free(cb, key, size, 1);
    return SLUICE_SUCCESS;
}

SluiceResult slc_catalogue_find(const struct slc_catalogue *c, const struct slc_catalogue_place *p,
                                const char *name, struct slc_catalogue_entry *entry)
{
    uint32_t count = c->row_count > 0, row = 0;
    SluiceResult result = name ? count_named(c, name, p->allocator, &count, &row) : SLUICE_SUCCESS;
    if (result != SLUICE_SUCCESS)
        return result;
    if (count != 1)
        return slc_log_refusal(p->log, "%s: %s '%s'", p->shown,
                               count ? "has several pictures or stores"
                                     : "has no picture and no store",
                               name ? name : "");
    entry->hash = c->rows[row].hash;
    return make_path(p, c->rows[row].store, &entry->store);
}

void slc_catalogue_entry_finish(struct slc_catalogue_entry *entry,
                                const SluiceAllocationCallbacks *cb)
{
    if (entry->store)
        slc_free(cb, entry->store, strlen(entry->store) + 1, 1);
    entry->store = NULL;
}
