/* NULL and zero in every argument of the functions of sluice-neural. */
#include "null_arguments/calls.h"

#include "neural/worked_example.h"

#include <sluice/neural_pages.h>
#include <sluice/neural_source.h>

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
sluiceGetNeuralWeights(f->set, 0, ?f->outputs, &f->out.size, ?NULL)
sluiceReadNeuralLatents(f->set, ?&f->request, &f->out.constants, &f->out.size, ?NULL)
sluiceBoundNeuralLatents(f->set, &f->request, 1, &f->out.size)
sluiceReadNeuralLatentPart(f->set, 0, 0, &f->out.size, ?NULL)
sluiceDecodeNeuralTexels(&f->decode)
sluiceRepairNeuralMasks(&f->masks, ?&f->out.report)
sluiceConvertNeuralColor(0, 0, 0)
sluiceCreateNeuralImageSource(&f->source, &f->out.source) => sluiceDestroyImageSource(f->out.source)
sluiceLayOutNeuralPages(f->set, 4096, &f->out.pages)
sluiceReadNeuralPage(f->set, &f->pages, 0, f->page)
sluicePlanNeuralFile(&f->write, &f->out.constants, &f->out.size)
sluiceWriteNeuralFile(&f->write)
*/
/* clang-format on */

struct fixture {
    SluiceNeuralSetCreateInfo create;
    SluiceInput input;
    SluiceNeuralSet *set;
    SluiceNeuralOutput outputs[16];
    SluiceNeuralRequest request;
    SluiceNeuralDecodeInfo decode;
    SluiceNeuralMaskInfo masks;
    const float *mips[1];
    SluiceNeuralWriteInfo write;
    uint8_t codes[64];
    SluiceNeuralConstants constants;
    uint64_t sizes[2];
    uint8_t latents[1024], weights[16384];
    float texels[16 * 2];
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    SluiceNeuralImageSourceCreateInfo source;
    SluiceNeuralPages pages;
    uint8_t page[4096];
    struct {
        SluiceImageSource *source;
        SluiceNeuralPages pages;
        SluiceNeuralSet *set;
        SluiceNeuralSetInfo info;
        SluiceNeuralTexture texture;
        SluiceNeuralColorSpace color_space;
        SluiceNeuralMip mip;
        SluiceNeuralMaskReport report;
        SluiceNeuralLatentImage image;
        SluiceNeuralLatentPart part;
        SluiceNeuralConstants constants;
        uint64_t offset, size;
    } out;
};

CALLS_FUNCTIONS

static SluiceResult drop(void *user, const void *bytes, size_t size)
{
    (void)user, (void)bytes, (void)size;
    return SLUICE_SUCCESS;
}

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    f->input.structSize = sizeof f->input;
    f->input.pBytes = f->bytes;
    f->input.size = write_worked_example(f->bytes);
    f->create.structSize = sizeof f->create;
    f->create.pInput = &f->input;
    CHECK_OK(sluiceOpenNeuralSet(&f->create, &f->set));
    CHECK_OK(sluiceLayOutNeuralPages(f->set, sizeof f->page, &f->pages));
    f->source = (SluiceNeuralImageSourceCreateInfo){.structSize = sizeof f->source, .set = f->set};
    f->sizes[0] = sizeof f->latents;
    f->sizes[1] = sizeof f->weights;
    CHECK_OK(sluiceReadNeuralLatents(f->set, NULL, &f->constants, &f->sizes[0], f->latents));
    CHECK_OK(
        sluiceGetNeuralWeights(f->set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &f->sizes[1], f->weights));
    f->decode = (SluiceNeuralDecodeInfo){
        .structSize = sizeof f->decode,
        .pConstants = &f->constants,
        .pLatents = f->latents,
        .latentSize = f->sizes[0],
        .pWeights = f->weights,
        .weightSize = f->sizes[1],
        .width = 4,
        .height = 4,
        .channelCount = 2,
        .pTexels = f->texels,
    };
    f->mips[0] = f->texels;
    f->masks = (SluiceNeuralMaskInfo){
        .structSize = sizeof f->masks,
        .pConstants = &f->constants,
        .pLatents = f->latents,
        .latentSize = f->sizes[0],
        .pInt8Weights = f->weights,
        .weightSize = f->sizes[1],
        .channelCount = 2,
        .ppMips = f->mips,
    };
    f->write = (SluiceNeuralWriteInfo){
        .structSize = sizeof f->write,
        .pfnWrite = drop,
        .schema = 3,
        .width = 4,
        .height = 4,
        .channelCount = 2,
        .network = SLUICE_NEURAL_NETWORK_SCHEMA3,
        .highFeatures = 4,
        .gridScale = 2,
        .pCodes = f->codes,
        .pInt8Weights = f->weights,
    };
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
