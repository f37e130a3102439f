#include "neural_file.h"

#include "../common/output_file.h"
#include "../common/text.h"
#include "show.h"

#include <stdio.h>
#include <stdlib.h>

/* Rows decoded at once. */
#define STRIP 64u

/* Inputs and buffers of decoding. */
struct job {
    const char *path;
    SluiceNeuralSet *set;
    SluiceNeuralMip mip;
    uint32_t number; ///< index of the mip
    SluiceNeuralWeightKind kind;
    uint8_t *weights;
    uint64_t weight_size;
    uint32_t channels;
};

static bool say(const struct job *job, const char *what)
{
    text_say("sluice-info: %s: %s", job->path, what);
    return false;
}

/* Writes floats as little-endian bytes. All supported machines are little-endian. */
static bool write_strip(const struct job *job, uint32_t y, float *texels, FILE *out)
{
    uint32_t height = job->mip.height - y < STRIP ? job->mip.height - y : STRIP;
    const SluiceNeuralRequest request = {job->number, 1, 0, y, job->mip.width, height};
    SluiceNeuralConstants constants;
    uint64_t size = 0;
    SluiceResult result = sluiceReadNeuralLatents(job->set, &request, &constants, &size, NULL);
    uint8_t *latents = result == SLUICE_SUCCESS ? malloc((size_t)size) : NULL;
    if (latents)
        result = sluiceReadNeuralLatents(job->set, &request, &constants, &size, latents);
    else if (result == SLUICE_SUCCESS)
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceNeuralDecodeInfo info = {
        .structSize = sizeof info,
        .pConstants = &constants,
        .pLatents = latents,
        .latentSize = size,
        .pWeights = job->weights,
        .weightSize = job->weight_size,
        .weightKind = job->kind,
        .mip = job->number,
        .y = y,
        .width = job->mip.width,
        .height = height,
        .channelCount = job->channels,
        .pTexels = texels,
    };
    if (result == SLUICE_SUCCESS)
        result = sluiceDecodeNeuralTexels(&info);
    free(latents);
    size_t count = (size_t)job->mip.width * height * job->channels;
    if (result != SLUICE_SUCCESS)
        return say(job, sluiceGetResultName(result));
    return fwrite(texels, sizeof *texels, count, out) == count;
}

static bool write_mip(const struct job *job, const char *path)
{
    float *texels = calloc((size_t)job->mip.width * STRIP * job->channels, sizeof *texels);
    if (!texels)
        return say(job, "out of memory");
    struct output_file *out = output_file_begin(path);
    bool done = out != NULL;
    for (uint32_t y = 0; done && y < job->mip.height; y += STRIP)
        done = write_strip(job, y, texels, output_file_stream(out));
    free(texels);
    return out && output_file_end(out, done);
}

static bool prepare(struct job *job, const struct options *options)
{
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    job->mip.structSize = sizeof job->mip;
    sluiceGetNeuralSetInfo(job->set, &info);
    job->channels = info.channelCount;
    job->kind = options->weights ? SLUICE_NEURAL_WEIGHTS_FP8 : SLUICE_NEURAL_WEIGHTS_INT8;
    job->number = (uint32_t)options->decode;
    if (sluiceGetNeuralMip(job->set, job->number, &job->mip) != SLUICE_SUCCESS ||
        sluiceGetNeuralWeights(job->set, job->kind, NULL, &job->weight_size, NULL) !=
            SLUICE_SUCCESS)
        return false; /* the library has reported the error */
    job->weights = malloc((size_t)job->weight_size);
    return job->weights ? sluiceGetNeuralWeights(job->set, job->kind, NULL, &job->weight_size,
                                                 job->weights) == SLUICE_SUCCESS
                        : say(job, "out of memory");
}

int decode_neural_file(const struct options *options)
{
    struct job job = {.path = options->files.items[0]};
    output_set_speaker("sluice-info: ");
    if (!output_add_input(job.path))
        return NOT_SHOWN;
    job.set = open_neural_file(job.path);
    bool done = job.set && prepare(&job, options) && write_mip(&job, options->output);
    free(job.weights);
    sluiceDestroyNeuralSet(job.set);
    return done ? ALL_SHOWN : NOT_SHOWN;
}
