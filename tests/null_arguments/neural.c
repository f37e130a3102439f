/* NULL and zero in every argument of the functions of sluice-neural. */
#include "null_arguments/calls.h"

#include "neural/worked_example.h"

#include <sluice/neural.h>

/* clang-format off */
/* CALLS
sluiceOpenNeuralSet(&f->create, &f->out.set) => sluiceDestroyNeuralSet(f->out.set)
!sluiceDestroyNeuralSet(f->set)
sluiceGetNeuralSetInfo(f->set, &f->out.info)
sluiceGetNeuralTexture(f->set, 0, &f->out.texture)
sluiceGetNeuralChannel(f->set, 0, &f->out.color_space)
sluiceGetNeuralMip(f->set, 0, &f->out.mip)
sluiceGetNeuralLatentImage(f->set, 0, &f->out.image)
sluiceGetNeuralLatentPart(f->set, 0, 0, &f->out.part)
sluiceGetNeuralLatentRange(f->set, 0, 1, &f->out.offset, &f->out.size)
*/
/* clang-format on */

struct fixture {
    SluiceNeuralSetCreateInfo create;
    SluiceInput input;
    SluiceNeuralSet *set;
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    struct {
        SluiceNeuralSet *set;
        SluiceNeuralSetInfo info;
        SluiceNeuralTexture texture;
        SluiceNeuralColorSpace color_space;
        SluiceNeuralMip mip;
        SluiceNeuralLatentImage image;
        SluiceNeuralLatentPart part;
        uint64_t offset, size;
    } out;
};

CALLS_FUNCTIONS

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    f->input.structSize = sizeof f->input;
    f->input.pBytes = f->bytes;
    f->input.size = write_worked_example(f->bytes);
    f->create.structSize = sizeof f->create;
    f->create.pInput = &f->input;
    CHECK_OK(sluiceOpenNeuralSet(&f->create, &f->set));
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyNeuralSet(f->set);
}

#include "neural_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    return RUN_TESTS(tests);
}
