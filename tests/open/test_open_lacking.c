/* Kinds of files that this build does not read are refused by name. Runs in every build. */
#define _XOPEN_SOURCE 700

#include <sluice/open.h>

#include "support/test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void on_log(void *user, SluiceLogSeverity severity, const char *message)
{
    if (severity == SLUICE_LOG_ERROR)
        snprintf(user, 1024, "%s", message);
}

static void kinds_that_are_lacking_are_refused_by_name(void **state)
{
    (void)state;
    static const struct {
        const char *start, *library;
        bool is_read;
    } kinds[] = {
        {"\x89SLS\r\n\x1A\n", "sluice-store", HAVE_STORE},
        {"\x76\x2F\x31\x01", "sluice-exr", HAVE_EXR},
        {"DDS ", "sluice-container", HAVE_CONTAINER},
        {"\xABKTX 20\xBB\r\n\x1A\n", "sluice-container", HAVE_CONTAINER},
        {"NTEX", "sluice-neural", HAVE_NEURAL},
        {"\x89PNG\r\n\x1A\n", "sluice-bake", HAVE_BAKE},
    };
    char path[] = "/tmp/sluice-lacking-XXXXXX", folder[64], last[1024];
    int descriptor = mkstemp(path);
    SluiceImageOpener *opener;
    snprintf(folder, sizeof folder, "%s.cache", path);
    SluiceImageOpenerCreateInfo info = {
        .structSize = sizeof info, .pCacheFolder = folder, .log = {last, on_log}};
    CHECK_OK(sluiceCreateImageOpener(&info, &opener));
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        SluiceImageSource *source = NULL;
        size_t size = strlen(kinds[i].start);
        assert_int_equal(ftruncate(descriptor, 0), 0);
        assert_int_equal(pwrite(descriptor, kinds[i].start, size, 0), size);
        last[0] = '\0';
        CHECK_RESULT(sluiceOpenImageSource(opener, path, &source),
                     kinds[i].is_read ? SLUICE_ERROR_CORRUPT_DATA : SLUICE_ERROR_UNSUPPORTED);
        assert_non_null(strstr(last, path));
        assert_int_equal(strstr(last, kinds[i].library) != NULL, !kinds[i].is_read);
        assert_null(source);
    }
    sluiceDestroyImageOpener(opener);
    rmdir(folder);
    close(descriptor);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_that_are_lacking_are_refused_by_name),
    };
    return RUN_TESTS(tests);
}
