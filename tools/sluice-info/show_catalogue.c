#include "file_report.h"

#include "../common/input.h"
#include "../common/remote.h"
#include "../common/text.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Format: docs/cluster.md. */
static const char first_line[] = "sluice catalogue 1\n";
enum { BYTES = 5, COLUMNS = 8 };

struct catalogue {
    uint64_t store_count, size; ///< `size`: bytes of all stores
    uint64_t damaged;           ///< number of the first damaged line; 0: none
};

bool is_catalogue(const char *path)
{
    char start[sizeof first_line] = "";
    FILE *file = remote_is_url(path) ? NULL : input_open(path);
    if (!file)
        return false;
    const size_t length = fread(start, 1, sizeof first_line - 1, file);
    fclose(file);
    return length == sizeof first_line - 1 && memcmp(start, first_line, length) == 0;
}

static void count(FILE *file, struct catalogue *catalogue)
{
    enum { NAMES = 2 }; /* number of the line with the columns' names */
    uint64_t line = 1, size = 0;
    int column = 0, length = 0;
    bool good = true;
    for (int c; (c = getc(file)) != EOF && !catalogue->damaged;) {
        length++;
        if (c == '\t')
            column++;
        else if (line > NAMES && column == BYTES && (c < '0' || c > '9'))
            good = false;
        else if (line > NAMES && column == BYTES)
            size = 10 * size + (uint64_t)(c - '0');
        if (c != '\n')
            continue;
        if (line >= NAMES && (column + 1 != COLUMNS || !good))
            catalogue->damaged = line;
        catalogue->store_count += line > NAMES;
        catalogue->size += size;
        line++;
        size = 0;
        column = length = 0;
    }
    if ((length > 0 || line <= NAMES) && !catalogue->damaged) /* line without an end */
        catalogue->damaged = line;
}

static void print(FILE *out, const struct catalogue *c, const char *path, bool json)
{
    if (json) {
        fprintf(out, "{\"file\": ");
        text_write_json(out, path);
        fprintf(out,
                ", \"kind\": \"catalogue\", \"stores\": %" PRIu64 ", \"storeSize\": %" PRIu64 "}\n",
                c->store_count, c->size);
        return;
    }
    text_write(out, path);
    fprintf(out, ": catalogue of tile stores\n");
    fprintf(out, "  stores                  %" PRIu64 "\n", c->store_count);
    fprintf(out, "  their files             %" PRIu64 " bytes\n", c->size);
}

bool report_catalogue(const char *path, bool json, FILE *out)
{
    struct catalogue catalogue = {0};
    FILE *file = input_open(path);
    bool done = file != NULL;
    int error = errno;
    if (file) {
        count(file, &catalogue);
        error = errno;
        done = !ferror(file);
        fclose(file);
    }
    if (!done)
        text_say("sluice-info: %s: %s", path, input_reason(error));
    else if (catalogue.damaged)
        text_say("sluice-info: %s: is a catalogue whose line %" PRIu64 " is damaged", path,
                 catalogue.damaged);
    if (!done || catalogue.damaged)
        return false;
    print(out, &catalogue, path, json);
    return true;
}
