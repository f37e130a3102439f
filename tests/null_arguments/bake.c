/* NULL and zero in every argument of the functions of sluice-bake. */
#include "null_arguments/calls.h"
#include "null_arguments/files.h"

#include <sluice/bake.h>

/* clang-format off */
/* CALLS
sluiceCreateBaker(&f->create, &f->out.baker) => sluiceDestroyBaker(f->out.baker)
!sluiceDestroyBaker(f->baker)
sluiceBakeFile(f->baker, &f->bake, ?&f->out.report)
sluiceDescribeBake(f->baker, &f->bake, &f->out.report)
sluiceHashBakeSettings(&f->settings, &f->out.hash)
*/
/* clang-format on */

struct fixture {
    struct files files;
    SluiceBakerCreateInfo create;
    SluiceBaker *baker;
    SluiceBakeSettings settings;
    SluiceBakeInfo bake;
    struct {
        SluiceBaker *baker;
        SluiceBakeReport report;
        uint64_t hash;
    } out;
};

CALLS_FUNCTIONS

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    files_init(&f->files);
    f->create =
        (SluiceBakerCreateInfo){.structSize = sizeof(SluiceBakerCreateInfo), .threadCount = 1};
    f->settings.structSize = sizeof f->settings;
    CHECK_OK(sluiceCreateBaker(&f->create, &f->baker));
    f->bake = (SluiceBakeInfo){.structSize = sizeof(SluiceBakeInfo),
                               .source = f->files.source,
                               .pOutputPath = f->files.output};
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyBaker(f->baker);
    files_finish(&f->files);
}

#include "bake_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
