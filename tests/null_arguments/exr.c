/* NULL and zero in every argument of the functions of sluice-exr. */
#include "null_arguments/calls.h"
#include "null_arguments/files.h"

#include <sluice/exr.h>

/* clang-format off */
/* CALLS
sluiceCreateExrMemoryBudget(1 << 20, ?NULL, &f->out.budget) => sluiceDestroyExrMemoryBudget(f->out.budget)
!sluiceDestroyExrMemoryBudget(NULL)
sluiceGetExrInfo(f->exr, &f->out.info)
sluiceCreateExrImageSource(&f->create, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceWriteExrFile(&f->write, f->files.source)
*/
/* clang-format on */

struct fixture {
    struct files files;
    SluiceExrImageSourceCreateInfo create;
    SluiceExrWriteInfo write;
    SluiceImageSource *exr;
    struct {
        SluiceExrMemoryBudget *budget;
        SluiceExrInfo info;
        SluiceImageSource *source;
    } out;
};

CALLS_FUNCTIONS

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    files_init(&f->files);
    f->write =
        (SluiceExrWriteInfo){.structSize = sizeof(SluiceExrWriteInfo), .pPath = f->files.input};
    CHECK_OK(sluiceWriteExrFile(&f->write, f->files.source));
    f->write.pPath = f->files.output;
    f->create = (SluiceExrImageSourceCreateInfo){
        .structSize = sizeof(SluiceExrImageSourceCreateInfo), .pPath = f->files.input};
    CHECK_OK(sluiceCreateExrImageSource(&f->create, &f->exr));
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyImageSource(f->exr);
    files_finish(&f->files);
}

#include "exr_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
