#include "verify.h"

#include "text.h"

#include <sluice/store.h>

#include <inttypes.h>

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    if (severity == SLUICE_LOG_ERROR)
        text_say("sluice-bake: %s", message);
}

static void print_object(const char *path, SluiceResult result, const SluiceStoreReport *report)
{
    printf("{\"file\": ");
    text_write_json(stdout, path);
    printf(", \"status\": \"%s\", \"result\": \"%s\", \"tiles\": %" PRIu64 ", \"defects\": %" PRIu64
           ", \"stored_size\": %" PRIu64 ", \"texel_size\": %" PRIu64 "}\n",
           result == SLUICE_SUCCESS ? "whole" : "damaged", sluiceResultString(result),
           report->tileCount, report->defectCount, report->storedSize, report->texelSize);
}

static void print_row(const char *path, SluiceResult result, const SluiceStoreReport *report)
{
    bool is_whole = result == SLUICE_SUCCESS;
    printf("%s  %9" PRIu64 " tiles  ", is_whole ? "whole  " : "damaged", report->tileCount);
    text_write(stdout, path);
    if (!is_whole)
        printf(": %" PRIu64 " cannot be read; %s", report->defectCount, sluiceResultString(result));
    putchar('\n');
}

static bool verify(const char *path, bool json)
{
    SluiceStoreReport report = {0};
    SluiceStoreVerifyInfo info = {.pPath = path, .log = {NULL, on_log}};
    SluiceResult result = sluiceVerifyStore(&info, &report);
    if (json)
        print_object(path, result, &report);
    else
        print_row(path, result, &report);
    return result == SLUICE_SUCCESS;
}

bool verify_files(char **paths, int count, bool json)
{
    bool all_are_whole = true;
    for (int i = 0; i < count; i++)
        all_are_whole = verify(paths[i], json) && all_are_whole;
    return all_are_whole;
}
