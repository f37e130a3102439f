/* golden_replays DATA TRACES: replays every recording, in TAP, without what tools need of a system.
 */
#include <sluice/replay.h>

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct expected {
    const char *next; ///< line
    bool hash_only;
    bool differs;
};

/* With a NUL behind them. NULL: there is no such file. */
static char *read_file(const char *folder, const char *name, const char *suffix, size_t *size)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s%s", folder, name, suffix);
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    char *bytes = malloc(*size + 1);
    if (bytes && fread(bytes, 1, *size, file) == *size)
        bytes[*size] = '\0';
    fclose(file);
    return bytes;
}

static void skip_comments(struct expected *expected)
{
    while (*expected->next == '#')
        expected->next += strcspn(expected->next, "\n") + 1;
}

static void take_line(void *user, const char *line)
{
    struct expected *expected = user;
    size_t length = strlen(line);
    skip_comments(expected);
    if (expected->differs || (expected->hash_only && strncmp(line, "hash ", 5) != 0))
        return;
    expected->differs =
        strncmp(expected->next, line, length) != 0 || expected->next[length] != '\n';
    if (expected->differs)
        printf("# got: %s\n", line);
    else
        expected->next += length + 1;
}

static bool decides_as(const char *trace, size_t size, const char *text)
{
    struct expected expected = {.next = text};
    skip_comments(&expected);
    expected.hash_only = strncmp(expected.next, "hash ", 5) == 0;
    SluiceReplayInfo info = {.structSize = sizeof info,
                             .pData = trace,
                             .size = size,
                             .pUserData = &expected,
                             .pfnLine = take_line,
                             .heapTileCapacity = 1024,
                             .numExtraStandbyTiles = 1000};
    SluiceReplayResult result = {.structSize = sizeof result};
    return sluiceReplay(&info, &result) == SLUICE_SUCCESS && result.divergedEvent == 0 &&
           !expected.differs && *expected.next == '\0';
}

int main(int argc, char **argv)
{
    static const char *const RECORDINGS[] = {"budget",
                                             "cancel",
                                             "defragment",
                                             "failures",
                                             "first_light",
                                             "frame_loop",
                                             "random_application",
                                             "random_calls",
                                             "demand_answers",
                                             "demand_bias",
                                             "demand_bytes",
                                             "demand_eviction",
                                             "demand_failures",
                                             "demand_first_launches",
                                             "demand_formats",
                                             "demand_random",
                                             "demand_refusals",
                                             "demand_resources",
                                             "sets",
                                             "t20_small",
                                             "t100",
                                             "t1000"};
    int count = sizeof RECORDINGS / sizeof *RECORDINGS, failed = 0;
    if (argc != 3)
        return 2;
    printf("1..%d\n", count);
    for (int i = 0; i < count; i++) {
        const char *name = RECORDINGS[i];
        bool is_trace = name[0] == 't';
        size_t size = 0, text_size = 0;
        char *trace = is_trace ? read_file(argv[2], name, ".slt", &size)
                               : read_file(argv[1], name, ".trace", &size);
        char *text = read_file(argv[1], name, is_trace ? ".hash" : ".expected", &text_size);
        bool is_skipped = is_trace && !trace;
        bool good = is_skipped || (trace && text && decides_as(trace, size, text));
        printf("%s %d - %s_decides_as_expected%s\n", good ? "ok" : "not ok", i + 1, name,
               is_skipped ? " # SKIP the trace is not there" : "");
        failed += !good;
        free(trace);
        free(text);
    }
    return failed > 0;
}
