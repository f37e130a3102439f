/* NULL and zero in every argument of the functions of sluice-open. */
#include "null_arguments/calls.h"

#include "neural/worked_example.h"

#include <sluice/bake.h>
#include <sluice/open.h>

#include <stdio.h>
#include <unistd.h>

/* clang-format off */
/* CALLS
sluiceCreateImageOpener(&f->create, &f->out.opener) => sluiceDestroyImageOpener(f->out.opener)
!sluiceDestroyImageOpener(f->opener)
sluiceOpenImageSource(f->opener, f->path, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceOpenNamedImageSource(f->opener, f->path, "two", &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceOpenBakedImageSource(f->opener, f->path, &f->settings, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceGetOpenedImageInfo(f->source, &f->out.info)
*/
/* clang-format on */

struct fixture {
    SluiceImageOpenerCreateInfo create;
    SluiceImageOpener *opener;
    SluiceImageSource *source;
    SluiceBakeSettings settings;
    char path[64];
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
    static uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    size_t size = write_worked_example(bytes);
    snprintf(f->path, sizeof f->path, "/tmp/sluice-null-XXXXXX");
    int descriptor = mkstemp(f->path);
    assert_int_equal(write(descriptor, bytes, size), size);
    close(descriptor);
    f->create.structSize = sizeof f->create;
    f->settings.structSize = sizeof f->settings;
    CHECK_OK(sluiceCreateImageOpener(&f->create, &f->opener));
    CHECK_OK(sluiceOpenImageSource(f->opener, f->path, &f->source));
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyImageSource(f->source);
    sluiceDestroyImageOpener(f->opener);
    unlink(f->path);
}

#include "open_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
