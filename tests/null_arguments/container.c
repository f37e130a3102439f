/* NULL and zero in every argument of the functions of sluice-container. */
#include "null_arguments/calls.h"

#include <sluice/dds.h>
#include <sluice/ktx2.h>

/* clang-format off */
/* CALLS
sluiceCreateDdsImageSource(&f->dds, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceCreateKtx2ImageSource(&f->ktx2, &f->out.source) => sluiceDestroyImageSource(f->out.source)
*/
/* clang-format on */

struct fixture {
    SluiceDdsImageSourceCreateInfo dds;
    SluiceKtx2ImageSourceCreateInfo ktx2;
    struct {
        SluiceImageSource *source;
    } out;
};

CALLS_FUNCTIONS

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    f->dds.structSize = sizeof f->dds;
    f->ktx2.structSize = sizeof f->ktx2;
    f->dds.pPath = f->ktx2.pPath = "a file that is opened when it is read";
}

static void fixture_finish(struct fixture *f)
{
    (void)f;
}

#include "container_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
