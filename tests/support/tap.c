#define _GNU_SOURCE /* fopencookie */
#include "support/tap.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#if defined(__GLIBC__)

#define REASON_MARK "# skipped: "

struct filter {
    FILE *out;
    size_t length;
    char line[1024];   /* received part of the current line; longer lines are cut */
    char reason[1024]; /* reason of the next skipped test */
};

static bool begins_with(const char *text, const char *prefix)
{
    return strncmp(text, prefix, strlen(prefix)) == 0;
}

static bool is_tap(const char *line)
{
    return line[0] == '#' || line[0] == '\0' || begins_with(line, "ok ") ||
           begins_with(line, "not ok ") || begins_with(line, "1..") ||
           begins_with(line, "TAP version ") || begins_with(line, "Bail out!");
}

/* Rewrites "not ok 3 # SKIP name" to "ok 3 - name # SKIP reason". */
static bool write_skipped(struct filter *filter)
{
    int number = 0, name = 0;
    const char *line = filter->line + (begins_with(filter->line, "not ") ? 4 : 0);
    if (sscanf(line, "ok %d # SKIP %n", &number, &name) < 1 || name == 0)
        return false;
    fprintf(filter->out, "ok %d - %s # SKIP %s\n", number, line + name,
            filter->reason[0] != '\0' ? filter->reason : "no reason given");
    filter->reason[0] = '\0';
    return true;
}

static void write_line(struct filter *filter)
{
    filter->line[filter->length] = '\0';
    filter->length = 0;
    if (begins_with(filter->line, REASON_MARK))
        strcpy(filter->reason, filter->line + strlen(REASON_MARK));
    else if (!write_skipped(filter))
        fprintf(filter->out, "%s%s\n", is_tap(filter->line) ? "" : "# ", filter->line);
    fflush(filter->out);
}

static ssize_t filter_write(void *cookie, const char *text, size_t size)
{
    struct filter *filter = cookie;
    for (size_t i = 0; i < size; i++) {
        if (text[i] == '\n')
            write_line(filter);
        else if (filter->length + 1 < sizeof filter->line)
            filter->line[filter->length++] = text[i];
    }
    return (ssize_t)size;
}

void tap_filter_stdout(void)
{
    static struct filter filter; /* used until the program has ended */
    cookie_io_functions_t functions = {.write = filter_write};
    FILE *stream = fopencookie(&filter, "w", functions);
    if (stream == NULL)
        return;
    setvbuf(stream, NULL, _IONBF, 0);
    filter.out = stdout;
    stdout = stream;
}

#else

void tap_filter_stdout(void) {}

#endif
