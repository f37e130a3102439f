/** Where the files that the tests read are. */
#ifndef TESTS_EXR_EXR_PATHS_H
#define TESTS_EXR_EXR_PATHS_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/** The file `name` of tests/exr/data. */
static inline const char *own_file(const char *name, char path[1024])
{
    const char *root = getenv("SLUICE_SOURCE_ROOT");
    snprintf(path, 1024, "%s/tests/exr/data/%s", root ? root : ".", name);
    return path;
}

/** `name` among the OpenEXR project's images; false if it is not there. */
static inline bool find_image(const char *name, char path[1024])
{
    const char *data = getenv("SLUICE_TEST_DATA"), *root = getenv("SLUICE_SOURCE_ROOT");
    struct stat status;
    if (data)
        snprintf(path, 1024, "%s/openexr-images/%s", data, name);
    else
        snprintf(path, 1024, "%s/../shared/data/openexr-images/%s", root ? root : ".", name);
    return stat(path, &status) == 0;
}

#endif /* TESTS_EXR_EXR_PATHS_H */
