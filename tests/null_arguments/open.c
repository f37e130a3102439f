/* NULL and zero in every argument of the functions of sluice-open. */
#include "null_arguments/calls.h"

#include <sluice/open.h>

#include <stdio.h>

/* clang-format off */
/* CALLS
sluiceCreateImageOpener(&f->create, &f->out.opener) => sluiceDestroyImageOpener(f->out.opener)
!sluiceDestroyImageOpener(f->opener)
sluiceOpenImageSource(f->opener, f->path, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceGetOpenedImageInfo(f->source, &f->out.info)
*/
/* clang-format on */

struct fixture {
    SluiceImageOpenerCreateInfo create;
    SluiceImageOpener *opener;
    SluiceImageSource *source;
    char path[1024];
    struct {
        SluiceImageOpener *opener;
        SluiceImageSource *source;
        SluiceOpenedImageInfo info;
    } out;
};

CALLS_FUNCTIONS

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    const char *root = getenv("SLUICE_SOURCE_ROOT");
    snprintf(f->path, sizeof f->path, "%s/tests/container/data/nvtt_bc1.dds", root ? root : ".");
    f->create.structSize = sizeof f->create;
    CHECK_OK(sluiceCreateImageOpener(&f->create, &f->opener));
    CHECK_OK(sluiceOpenImageSource(f->opener, f->path, &f->source));
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyImageSource(f->source);
    sluiceDestroyImageOpener(f->opener);
}

#include "open_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
