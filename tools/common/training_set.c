#include "training_set.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STRIDE SLUICE_NEURAL_MAX_CHANNELS

/* Returns whether a name is taken. Names must differ, because they open textures. */
static bool has_name(const struct training_set *set, const char *name)
{
    for (uint32_t i = 0; i < set->texture_count; i++)
        if (strncmp(set->names[i], name, sizeof set->names[i] - 1) == 0)
            return true;
    return false;
}

static bool fits(const struct training_set *set, const struct training_picture *picture)
{
    if (has_name(set, picture->name)) {
        fprintf(stderr, "%s: two pictures of a set have this name; rename one\n", picture->name);
        return false;
    }
    bool is_size =
        set->texture_count == 0 || (set->width == picture->width && set->height == picture->height);
    if (!is_size)
        fprintf(stderr, "%s: is %u x %u, the pictures before are %u x %u\n", picture->name,
                picture->width, picture->height, set->width, set->height);
    else if (set->channel_count + picture->channel_count > STRIDE)
        fprintf(stderr, "%s: the set has more than %d channels\n", picture->name, STRIDE);
    return is_size && set->channel_count + picture->channel_count <= STRIDE;
}

static void describe(struct training_set *set, const struct training_picture *picture)
{
    const uint32_t first = set->channel_count, texture = set->texture_count++;
    const SluiceNeuralColorSpace wanted =
        picture->space == SLUICE_NEURAL_COLOR_HLG ? SLUICE_NEURAL_COLOR_LINEAR : picture->space;
    snprintf(set->names[texture], sizeof set->names[texture], "%s", picture->name);
    set->textures[texture] = (SluiceNeuralTexture){.structSize = sizeof(SluiceNeuralTexture),
                                                   .pName = set->names[texture],
                                                   .firstChannel = first,
                                                   .channelCount = picture->channel_count,
                                                   .format = picture->format,
                                                   .rgbColorSpace = wanted};
    for (uint32_t c = 0; c < picture->channel_count; c++) {
        bool is_mask = picture->mask && c + 1 == picture->channel_count;
        bool is_color = c < 3 && !is_mask;
        set->spaces[first + c] = is_color ? picture->space : SLUICE_NEURAL_COLOR_LINEAR;
        set->meaning[first + c] = (SluiceNeuralTrainingChannel){
            .clamped = set->spaces[first + c] != SLUICE_NEURAL_COLOR_HLG, .mask = is_mask};
    }
    set->channel_count += picture->channel_count;
}

bool training_set_add(struct training_set *set, const struct training_picture *picture)
{
    const size_t count = (size_t)picture->width * picture->height;
    if (!fits(set, picture))
        return false;
    if (!set->level0)
        set->level0 = calloc(count, STRIDE * sizeof(float));
    if (!set->level0) {
        fprintf(stderr, "%s: out of memory\n", picture->name);
        return false;
    }
    const uint32_t first = set->channel_count;
    set->width = picture->width;
    set->height = picture->height;
    describe(set, picture);
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < picture->channel_count; c++) {
            float value = picture->texels[i * picture->channel_count + c];
            if (set->spaces[first + c] == SLUICE_NEURAL_COLOR_HLG)
                value = sluiceConvertNeuralColor(value, SLUICE_NEURAL_COLOR_LINEAR,
                                                 SLUICE_NEURAL_COLOR_HLG);
            set->level0[i * STRIDE + first + c] = value;
        }
    return true;
}

bool training_set_weigh(struct training_set *set, const char *name, float weight)
{
    bool is_there = false;
    for (uint32_t t = 0; t < set->texture_count; t++) {
        const SluiceNeuralTexture *texture = &set->textures[t];
        if (strcmp(set->names[t], name) != 0)
            continue;
        is_there = true;
        for (uint32_t c = 0; c < texture->channelCount; c++)
            set->meaning[texture->firstChannel + c].weight = weight;
    }
    return is_there;
}

static uint32_t mip_size(uint32_t size, uint32_t mip)
{
    return size >> mip ? size >> mip : 1;
}

/* Computes a mip of a channel. `linear`: its texels of mip 0, in linear light. */
static void fill_channel(const struct training_set *set, uint32_t mip, uint32_t channel,
                         const float *linear)
{
    const uint32_t width = mip_size(set->width, mip), height = mip_size(set->height, mip);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint32_t x0 = (uint32_t)((uint64_t)x * set->width / width);
            uint32_t x1 = (uint32_t)((uint64_t)(x + 1) * set->width / width);
            uint32_t y0 = (uint32_t)((uint64_t)y * set->height / height);
            uint32_t y1 = (uint32_t)((uint64_t)(y + 1) * set->height / height);
            double sum = 0.0;
            for (uint32_t row = y0; row < y1; row++)
                for (uint32_t column = x0; column < x1; column++)
                    sum += (double)linear[(size_t)row * set->width + column];
            double mean = sum / ((double)(x1 - x0) * (y1 - y0));
            set->mips[mip][((size_t)y * width + x) * set->channel_count + channel] =
                sluiceConvertNeuralColor((float)mean, SLUICE_NEURAL_COLOR_LINEAR,
                                         set->spaces[channel]);
        }
}

bool training_set_finish_mips(struct training_set *set)
{
    const size_t count = (size_t)set->width * set->height;
    float *linear = malloc(count * sizeof *linear);
    uint32_t size = set->width > set->height ? set->width : set->height;
    bool enough_memory = linear != NULL;
    for (set->mip_count = 0; size >> set->mip_count && enough_memory; set->mip_count++) {
        size_t texels =
            (size_t)mip_size(set->width, set->mip_count) * mip_size(set->height, set->mip_count);
        set->mips[set->mip_count] = malloc(texels * set->channel_count * sizeof(float));
        enough_memory = set->mips[set->mip_count] != NULL;
    }
    for (uint32_t c = 0; c < set->channel_count && enough_memory; c++) {
        for (size_t i = 0; i < count; i++) {
            float value = set->level0[i * STRIDE + c];
            set->mips[0][i * set->channel_count + c] = value;
            linear[i] = sluiceConvertNeuralColor(value, set->spaces[c], SLUICE_NEURAL_COLOR_LINEAR);
        }
        for (uint32_t m = 1; m < set->mip_count; m++)
            fill_channel(set, m, c, linear);
    }
    free(linear);
    free(set->level0);
    set->level0 = NULL;
    if (!enough_memory)
        fprintf(stderr, "out of memory\n");
    return enough_memory;
}

void training_set_free(struct training_set *set)
{
    free(set->level0);
    for (uint32_t m = 0; m < SLUICE_NEURAL_MAX_MIPS; m++)
        free(set->mips[m]);
    *set = (struct training_set){0};
}
