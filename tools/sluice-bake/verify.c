#define _XOPEN_SOURCE 700

#include "verify.h"

#include "../common/files.h"
#include "../common/log.h"
#include "../common/remote.h"
#include "../common/text.h"

#include <sluice/store.h>

#include <inttypes.h>
#include <stdio.h>
#include <sys/stat.h>

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    static char speaker[] = "sluice-bake: ";
    (void)user;
    if (severity == SLUICE_LOG_ERROR)
        log_say(speaker, severity, message);
}

static void print_object(const char *path, SluiceResult result, const SluiceStoreReport *report)
{
    printf("{\"file\": ");
    text_write_json(stdout, path);
    printf(", \"status\": \"%s\", \"result\": \"%s\", \"tiles\": %" PRIu64 ", \"defects\": %" PRIu64
           ", \"stored_size\": %" PRIu64 ", \"texel_size\": %" PRIu64 "}\n",
           result == SLUICE_SUCCESS ? "whole" : "damaged", sluiceGetResultName(result),
           report->tileCount, report->defectCount, report->storedSize, report->texelSize);
}

static void print_row(const char *path, SluiceResult result, const SluiceStoreReport *report)
{
    bool is_whole = result == SLUICE_SUCCESS;
    printf("%s  %9" PRIu64 " tiles  ", is_whole ? "whole  " : "damaged", report->tileCount);
    text_write(stdout, path);
    if (!is_whole)
        printf(": %" PRIu64 " cannot be read; %s", report->defectCount,
               sluiceGetResultName(result));
    putchar('\n');
}

static SluiceResult verify_store(const char *path, struct remote_session *session,
                                 SluiceStoreReport *report)
{
    struct remote_file remote = {0};
    SluiceStoreVerifyInfo info = {.structSize = sizeof info, .pPath = path, .log = {NULL, on_log}};
    if (remote_is_url(path) && !remote_open(&remote, session, path, &info.log))
        return SLUICE_ERROR_IO;
    info.pInput = remote_input(&remote);
    SluiceResult result = sluiceVerifyStore(&info, report);
    remote_close(&remote);
    return result;
}

static bool verify(const char *path, struct remote_session *session, bool json)
{
    SluiceStoreReport report = {.structSize = sizeof report};
    SluiceResult result = verify_store(path, session, &report);
    if (json)
        print_object(path, result, &report);
    else
        print_row(path, result, &report);
    return result == SLUICE_SUCCESS;
}

/* Collects files under any name, and all stores in folders. */
static bool collect(const struct option_list *paths, struct file_list *list)
{
    struct stat status;
    bool enough_memory = true;
    for (size_t i = 0; i < paths->count && enough_memory; i++) {
        const char *path = paths->items[i];
        enough_memory = stat(path, &status) == 0 && S_ISDIR(status.st_mode)
                            ? files_collect(path, SLUICE_STORE_EXTENSION, list)
                            : files_add(path, list);
    }
    if (!enough_memory)
        fprintf(stderr, "sluice-bake: out of memory\n");
    return enough_memory;
}

bool verify_files(const struct option_list *paths, bool json)
{
    struct file_list list = {.speaker = "sluice-bake: "};
    struct remote_session session = {0};
    bool all_are_whole = collect(paths, &list);
    for (size_t i = 0; i < list.count; i++)
        all_are_whole = verify(list.paths[i], &session, json) && all_are_whole;
    remote_end(&session);
    log_finish();
    all_are_whole = all_are_whole && list.unreadable_count == 0;
    if (list.count == 0 && list.unreadable_count == 0) {
        fprintf(stderr, "sluice-bake: there is no store to verify\n");
        all_are_whole = false;
    }
    files_finish(&list);
    return all_are_whole;
}
