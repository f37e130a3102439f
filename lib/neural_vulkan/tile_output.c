/* Output textures of a decoder. */
#include "neural_vulkan/tile_decoder.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "vulkan/context.h"

#define SPACES_PER_CHANNEL 2u

struct storage {
    SluiceFormat format;
    uint32_t store, block, words, channels;
    bool srgb;
};

static const struct storage *find_storage(SluiceFormat format)
{
    static const struct storage list[] = {
        {SLUICE_FORMAT_R8G8B8A8_UNORM, SLUICE_NEURAL_STORE_RGBA8, 1, 1, 4, false},
        {SLUICE_FORMAT_R8G8B8A8_SRGB, SLUICE_NEURAL_STORE_RGBA8, 1, 1, 4, true},
        {SLUICE_FORMAT_R16G16B16A16_SFLOAT, SLUICE_NEURAL_STORE_RGBA16F, 1, 2, 4, false},
        {SLUICE_FORMAT_BC1_RGB_UNORM_BLOCK, SLUICE_NEURAL_STORE_BC1, 4, 2, 3, false},
        {SLUICE_FORMAT_BC1_RGB_SRGB_BLOCK, SLUICE_NEURAL_STORE_BC1, 4, 2, 3, true},
        {SLUICE_FORMAT_BC4_UNORM_BLOCK, SLUICE_NEURAL_STORE_BC4, 4, 2, 1, false},
        {SLUICE_FORMAT_BC5_UNORM_BLOCK, SLUICE_NEURAL_STORE_BC5, 4, 4, 2, false},
        {SLUICE_FORMAT_BC7_UNORM_BLOCK, SLUICE_NEURAL_STORE_BC7, 4, 4, 4, false},
        {SLUICE_FORMAT_BC7_SRGB_BLOCK, SLUICE_NEURAL_STORE_BC7, 4, 4, 4, true}};
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++)
        if (list[i].format == format)
            return &list[i];
    return NULL;
}

/* Errors: INVALID_ARGUMENT, UNSUPPORTED. */
static SluiceResult check(const SluiceVulkanNeuralDecoder *decoder,
                          const SluiceVulkanNeuralOutput *o)
{
    const SluiceLogCallback *log = &decoder->context->vk.log;
    const struct storage *storage = find_storage(o->format);
    if (!storage) {
        slc_log(log, SLUICE_LOG_ERROR,
                "format %d of a neural texture cannot be written; RGBA8, RGBA16F, BC1_RGB, BC4, "
                "BC5 and BC7 can",
                (int)o->format);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    if (o->channelCount == 0 || o->channelCount > storage->channels)
        return slc_log_refusal(log, "channelCount is %u; format %d has 1 to %u", o->channelCount,
                               (int)o->format, storage->channels);
    if (o->firstChannel >= decoder->channel_count ||
        o->channelCount > decoder->channel_count - o->firstChannel)
        return slc_log_refusal(log, "channels %u to %u are not in the set, which has %u",
                               o->firstChannel, o->firstChannel + o->channelCount - 1,
                               decoder->channel_count);
    for (uint32_t c = 0; c < o->channelCount; c++) {
        if ((uint32_t)o->from[c] > SLUICE_NEURAL_COLOR_HLG ||
            (uint32_t)o->to[c] > SLUICE_NEURAL_COLOR_HLG)
            return slc_log_refusal(log, "from[%u] is %d and to[%u] is %d; both must be 0 to %d", c,
                                   (int)o->from[c], c, (int)o->to[c], SLUICE_NEURAL_COLOR_HLG);
        if (storage->srgb && c < 3 && o->to[c] != SLUICE_NEURAL_COLOR_SRGB)
            return slc_log_refusal(log, "to[%u] is %d; an SRGB format needs %d", c, (int)o->to[c],
                                   SLUICE_NEURAL_COLOR_SRGB);
    }
    return SLUICE_SUCCESS;
}

static void fill(struct slc_neural_output *output, SluiceVulkanNeuralDecoder *decoder,
                 const SluiceVulkanNeuralOutput *o)
{
    const struct storage *storage = find_storage(o->format);
    *output = (struct slc_neural_output){.next = decoder->outputs,
                                         .decoder = decoder,
                                         .image = {.structSize = sizeof output->image,
                                                   .width = decoder->width,
                                                   .height = decoder->height,
                                                   .mipLevelCount = decoder->mip_count,
                                                   .format = o->format,
                                                   .pName = o->pName},
                                         .producer = {.structSize = sizeof output->producer,
                                                      .pUserData = output,
                                                      .pfnRecordTiles = slc_neural_record_tiles},
                                         .store = storage->store,
                                         .block = storage->block,
                                         .words = storage->words,
                                         .first_channel = o->firstChannel,
                                         .channel_count = o->channelCount};
    output->producer.pImage = &output->image;
    for (uint32_t c = 0; c < o->channelCount; c++)
        output->spaces |= ((uint32_t)o->from[c] | (uint32_t)o->to[c] << SLUICE_NEURAL_SPACE_BITS)
                          << c * SPACES_PER_CHANNEL * SLUICE_NEURAL_SPACE_BITS;
}

SluiceResult sluiceAddVulkanNeuralOutput(SluiceVulkanNeuralDecoder *decoder,
                                         const SluiceVulkanNeuralOutput *pOutput,
                                         const SluiceTileProducer **ppProducer)
{
    SluiceVulkanNeuralOutput o;
    if (!decoder || !pOutput || !ppProducer)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceVulkanNeuralOutput), &o, pOutput,
                                          &decoder->context->vk.log);
    if (result == SLUICE_SUCCESS)
        result = check(decoder, &o);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_neural_output *output = slc_alloc(&decoder->cb, 1, sizeof *output);
    if (!output)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    fill(output, decoder, &o);
    decoder->outputs = output;
    *ppProducer = &output->producer;
    return SLUICE_SUCCESS;
}
