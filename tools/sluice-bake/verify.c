#include "verify.h"

#include "report.h"

#include <sluice/store.h>

#include <inttypes.h>

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user;
    if (severity == SLUICE_LOG_ERROR)
        fprintf(stderr, "sluice-bake: %s\n", message);
}

static void print_object(const char *path, SluiceResult result, const SluiceStoreReport *report)
{
    printf("{\"file\": ");
    print_json_string(stdout, path);
    printf(", \"status\": \"%s\", \"result\": \"%s\", \"tiles\": %" PRIu64 ", \"defects\": %" PRIu64
           ", \"stored_size\": %" PRIu64 ", \"texel_size\": %" PRIu64 "}\n",
           result == SLUICE_SUCCESS ? "whole" : "damaged", sluiceResultString(result),
           report->tileCount, report->defectCount, report->storedSize, report->texelSize);
}

static bool verify(const char *path, bool json)
{
    SluiceStoreReport report = {0};
    SluiceStoreVerifyInfo info = {.pPath = path, .log = {NULL, on_log}};
    SluiceResult result = sluiceVerifyStore(&info, &report);
    if (json)
        print_object(path, result, &report);
    else if (result == SLUICE_SUCCESS)
        printf("whole    %9" PRIu64 " tiles  %s\n", report.tileCount, path);
    else
        printf("damaged  %9" PRIu64 " tiles  %s: %" PRIu64 " cannot be read; %s\n",
               report.tileCount, path, report.defectCount, sluiceResultString(result));
    return result == SLUICE_SUCCESS;
}

bool verify_files(char **paths, int count, bool json)
{
    bool all_are_whole = true;
    for (int i = 0; i < count; i++)
        all_are_whole = verify(paths[i], json) && all_are_whole;
    return all_are_whole;
}
