/** A folder of our own under the system's for temporary files, and a gray image. */
#ifndef TESTS_NULL_ARGUMENTS_FILES_H
#define TESTS_NULL_ARGUMENTS_FILES_H

#include "support/test.h"

#include <sluice/image.h>

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

struct files {
    char folder[32], input[64], output[64];
    SluiceImageSource *source;
};

static inline void files_texel(void *user, uint32_t level, uint32_t x, uint32_t y, uint32_t width,
                               uint32_t height, float rgba[4])
{
    (void)user, (void)level, (void)x, (void)y, (void)width, (void)height;
    rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0.5f;
}

static inline void files_init(struct files *files)
{
    const SluiceProceduralImage image = {NULL, files_texel};
    const SluiceImageInfo info = {.structSize = sizeof info,
                                  .width = 16,
                                  .height = 16,
                                  .format = SLUICE_FORMAT_R8G8B8A8_UNORM,
                                  .pName = "gray"};
    snprintf(files->folder, sizeof files->folder, "/tmp/sluice-null-XXXXXX");
    assert_non_null(mkdtemp(files->folder));
    snprintf(files->input, sizeof files->input, "%s/in", files->folder);
    snprintf(files->output, sizeof files->output, "%s/out", files->folder);
    CHECK_OK(sluiceCreateProceduralImageSource(&image, &info, NULL, &files->source));
}

static inline void files_finish(struct files *files)
{
    sluiceDestroyImageSource(files->source);
    remove(files->input);
    remove(files->output);
    assert_int_equal(rmdir(files->folder), 0);
}

#endif /* TESTS_NULL_ARGUMENTS_FILES_H */
