/* UDIM patterns: names of files with the number of a cell in them. */

#include "base/log.h"
#include "base/system.h"
#include "platform/folder.h"

#include <sluice/udim.h>

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define MAX_PATTERN 4095u
#define CELLS (SLUICE_UDIM_LAST - SLUICE_UDIM_FIRST + 1)

struct pattern {
    size_t folder;      ///< bytes up to and with the last slash; 0: none
    const char *prefix; ///< file name before the pattern
    size_t prefix_length;
    const char *suffix;
    size_t suffix_length;
    bool uv; ///< `<UVTILE>`
};

/* Returns what is wrong, or NULL. */
static const char *split(const char *text, struct pattern *pattern)
{
    if (strlen(text) > MAX_PATTERN)
        return "is longer than 4095 bytes";
    const char *udim = strstr(text, "<UDIM>"), *uv = strstr(text, "<UVTILE>");
    const char *at = udim ? udim : uv, *name = slc_path_name(text);
    if (!at)
        return "has neither <UDIM> nor <UVTILE>";
    pattern->uv = !udim;
    pattern->suffix = at + (udim ? strlen("<UDIM>") : strlen("<UVTILE>"));
    if ((udim && uv) || strstr(pattern->suffix, "<UDIM>") || strstr(pattern->suffix, "<UVTILE>"))
        return "has more than one placeholder";
    if (name > at)
        return "has its placeholder in the name of a folder";
    pattern->prefix = name;
    pattern->folder = (size_t)(pattern->prefix - text);
    pattern->prefix_length = (size_t)(at - pattern->prefix);
    pattern->suffix_length = strlen(pattern->suffix);
    return NULL;
}

static SluiceResult read_pattern(const char *text, const SluiceLogCallback *log,
                                 struct pattern *pattern)
{
    const char *trouble = split(text, pattern);
    return trouble ? slc_log_refusal(log, "UDIM pattern '%.200s' %s", text, trouble)
                   : SLUICE_SUCCESS;
}

/* Reads a number of at most `digits` digits without a leading 0, and passes it. 0: none. */
static uint32_t read_number(const char **text, const char *end, uint32_t digits)
{
    uint32_t number = 0;
    if (*text < end && **text == '0')
        return 0;
    for (; digits > 0 && *text < end && **text >= '0' && **text <= '9'; digits--)
        number = number * 10 + (uint32_t)(*(*text)++ - '0');
    return number;
}

/* The number of the cell whose file has the name, or 0. */
static uint32_t cell_of(const struct pattern *pattern, const char *name)
{
    size_t length = strlen(name);
    if (length < pattern->prefix_length + pattern->suffix_length ||
        memcmp(name, pattern->prefix, pattern->prefix_length) != 0 ||
        strcmp(name + length - pattern->suffix_length, pattern->suffix) != 0)
        return 0;
    const char *at = name + pattern->prefix_length, *end = name + length - pattern->suffix_length;
    uint32_t number = 0;
    if (pattern->uv) {
        uint32_t u = at < end && *at++ == 'u' ? read_number(&at, end, 2) : 0;
        bool joined = end - at >= 2 && at[0] == '_' && at[1] == 'v';
        at += joined ? 2 : 0;
        uint32_t v = joined ? read_number(&at, end, 3) : 0;
        if (u >= 1 && u <= SLUICE_UDIM_COLUMNS && v >= 1)
            number = SLUICE_UDIM_FIRST + (u - 1) + SLUICE_UDIM_COLUMNS * (v - 1);
    } else {
        number = read_number(&at, end, 4);
    }
    return at == end && number >= SLUICE_UDIM_FIRST && number <= SLUICE_UDIM_LAST ? number : 0;
}

/* Returns 0 or a value of errno. */
static int mark_files(struct slc_folder *folder, const struct pattern *pattern, bool found[CELLS])
{
    for (;;) {
        struct slc_file_status status;
        const char *name = slc_folder_next(folder);
        if (!name)
            return errno;
        uint32_t number = cell_of(pattern, name);
        if (number && slc_folder_get_status(folder, name, false, &status) &&
            status.kind == SLC_NODE_FILE)
            found[number - SLUICE_UDIM_FIRST] = true;
    }
}

static SluiceResult list_files(const char *text, const struct pattern *pattern,
                               const SluiceLogCallback *log, bool found[CELLS])
{
    char path[MAX_PATTERN + 1] = ".";
    if (pattern->folder) {
        memcpy(path, text, pattern->folder);
        path[pattern->folder] = 0;
    }
    struct slc_folder *folder = slc_folder_begin(path);
    int error = folder ? mark_files(folder, pattern, found) : errno;
    slc_folder_end(folder);
    if (error == 0)
        return SLUICE_SUCCESS;
    SluiceResult result = slc_system_result(error);
    if (result < 0)
        slc_log(log, SLUICE_LOG_ERROR, "%.900s: cannot be listed: %s.", path, strerror(error));
    return result;
}

static SluiceResult write_numbers(const bool found[CELLS], uint32_t *count, uint32_t *numbers)
{
    uint32_t capacity = *count, written = 0;
    for (uint32_t i = 0; i < CELLS; i++) {
        if (!found[i])
            continue;
        if (numbers && written == capacity)
            return SLUICE_INCOMPLETE;
        if (numbers)
            numbers[written] = SLUICE_UDIM_FIRST + i;
        *count = ++written;
    }
    return SLUICE_SUCCESS;
}

SluiceResult sluiceFindUdimFiles(const char *pPattern, const SluiceLogCallback *pLog,
                                 uint32_t *pCount, uint32_t *pNumbers)
{
    struct pattern pattern;
    bool found[CELLS] = {false};
    if (!pPattern || !pCount)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = read_pattern(pPattern, pLog, &pattern);
    if (result == SLUICE_SUCCESS)
        result = list_files(pPattern, &pattern, pLog, found);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!memchr(found, true, sizeof found)) {
        slc_log(pLog, SLUICE_LOG_ERROR, "%.900s: no cell from %u to %u has a file.", pPattern,
                SLUICE_UDIM_FIRST, SLUICE_UDIM_LAST);
        return SLUICE_ERROR_FILE_NOT_FOUND;
    }
    return write_numbers(found, pCount, pNumbers);
}

SluiceResult sluiceWriteUdimPath(const char *pPattern, uint32_t number,
                                 const SluiceLogCallback *pLog, size_t pathSize, char *pPath)
{
    struct pattern pattern;
    char cell[32];
    if (!pPattern || !pPath)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = read_pattern(pPattern, pLog, &pattern);
    if (result != SLUICE_SUCCESS)
        return result;
    if (number < SLUICE_UDIM_FIRST || number > SLUICE_UDIM_LAST)
        return slc_log_refusal(pLog, "UDIM number %u is not %u to %u", number, SLUICE_UDIM_FIRST,
                               SLUICE_UDIM_LAST);
    uint32_t index = number - SLUICE_UDIM_FIRST;
    if (pattern.uv)
        snprintf(cell, sizeof cell, "u%u_v%u", index % SLUICE_UDIM_COLUMNS + 1,
                 index / SLUICE_UDIM_COLUMNS + 1);
    else
        snprintf(cell, sizeof cell, "%u", number);
    size_t before = pattern.folder + pattern.prefix_length, length = strlen(cell);
    if (before + length + pattern.suffix_length >= pathSize)
        return slc_log_refusal(pLog, "pathSize %llu is below the path's %llu bytes",
                               (unsigned long long)pathSize,
                               (unsigned long long)(before + length + pattern.suffix_length + 1));
    memcpy(pPath, pPattern, before);
    memcpy(pPath + before, cell, length);
    memcpy(pPath + before + length, pattern.suffix, pattern.suffix_length + 1);
    return SLUICE_SUCCESS;
}
