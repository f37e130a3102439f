#include "material.h"

#include "baked_blocks.h"
#include "commands.h"

#include "../manager/figures.h"

#include "neural_bench_shared.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* Features per texel of random sets, and texels of level 0 per texel of their finest latent image.
 */
enum { FEATURES = 16, GRID_SCALE = 4, MAX_LEVELS = 16 };

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static bool check(SluiceResult result, const char *what)
{
    if (result == SLUICE_SUCCESS)
        return true;
    fprintf(stderr, "%s: %s\n", what, sluiceGetResultName(result));
    return false;
}

static bool read_material(struct material *m, const SluiceNeuralSet *set)
{
    bool done =
        check(sluiceReadNeuralLatents(set, NULL, &m->constants, &m->latent_size, NULL),
              "sluiceReadNeuralLatents") &&
        check(sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &m->weight_size, NULL),
              "sluiceGetNeuralWeights");
    if (done) {
        m->latents = calloc(1, (size_t)m->latent_size);
        m->weights = calloc(1, NEURAL_BENCH_MAX_WEIGHTS);
        done = m->latents && m->weights &&
               check(sluiceReadNeuralLatents(set, NULL, &m->constants, &m->latent_size, m->latents),
                     "sluiceReadNeuralLatents") &&
               check(sluiceGetNeuralWeights(set, SLUICE_NEURAL_WEIGHTS_INT8, NULL, &m->weight_size,
                                            m->weights),
                     "sluiceGetNeuralWeights");
    }
    return done;
}

/* Weights of schema 3, with scales by which sums become about -3 to 3. */
static void make_weights(uint8_t *bytes, uint32_t *state)
{
    const uint32_t weights = 48 * 64 + 64 * 48 + 48 * 32 + 32 * 16, outputs = 64 + 48 + 32 + 16;
    const float scale = 1.0f / 32768;
    for (uint32_t i = 0; i < weights; i++)
        bytes[i] = (uint8_t)next_random(state);
    for (uint32_t i = 0; i < outputs; i++)
        memcpy(bytes + weights + 4 * i, &scale, 4);
}

static bool make_material(struct material *m, uint32_t size)
{
    SluiceNeuralConstants *k = &m->constants;
    uint32_t state = 1, count = 1;
    while (count < MAX_LEVELS && size >> count)
        count++;
    *k = (SluiceNeuralConstants){.schema = 3,
                                 .width = size,
                                 .height = size,
                                 .mipCount = count,
                                 .channelCount = 8,
                                 .validChannels = 0xFF,
                                 .inputCount = 48,
                                 .networkFeatures = 16,
                                 .highFeatures = FEATURES,
                                 .highBits = 4,
                                 .lowFeatures = FEATURES,
                                 .lowBits = 4,
                                 .residentMipCount = count};
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t grid = level_size(size / GRID_SCALE, i);
        k->slices[i] = (SluiceNeuralSlice){.dataOffset = (uint32_t)m->latent_size,
                                           .gridSize = grid | grid << 16,
                                           .sliceSize = grid | grid << 16};
        m->latent_size += (uint64_t)grid * grid * FEATURES / 2;
    }
    for (uint32_t mip = 0; mip < count; mip++) {
        uint32_t image = mip < 3 ? 0 : (mip - 1) & ~1u;
        image = image > 6 ? 6 : image;
        k->mips[mip] = (SluiceNeuralMipConstants){
            .firstSlice = image,
            .positionScale =
                0.5f * (float)(k->slices[image].gridSize & 0xFFFF) / (float)level_size(size, mip)};
    }
    m->latents = malloc((size_t)m->latent_size);
    m->weights = calloc(1, NEURAL_BENCH_MAX_WEIGHTS);
    m->weight_size = 9472;
    if (!m->latents || !m->weights)
        return false;
    for (uint64_t i = 0; i < m->latent_size; i++)
        m->latents[i] = (uint8_t)next_random(&state);
    make_weights(m->weights, &state);
    return true;
}

static bool fill_buffer(const struct gpu *gpu, const void *bytes, uint64_t size,
                        VkBufferUsageFlags usage, struct gpu_buffer *buffer)
{
    struct gpu_buffer staging = {0};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    bool done =
        gpu_create_buffer(gpu, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, &staging) &&
        gpu_create_device_buffer(gpu, size, usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, buffer) &&
        commands_begin(gpu, &commands);
    if (done) {
        memcpy(staging.mapped, bytes, (size_t)size);
        vkCmdCopyBuffer(commands, staging.buffer, buffer->buffer, 1, &(VkBufferCopy){.size = size});
        done = commands_run(gpu, commands);
    }
    gpu_destroy_buffer(gpu, &staging);
    return done;
}

/* Bytes of a level: 4 per texel, or blocks of 16 bytes. */
static uint64_t level_bytes(const struct material *m, uint32_t level, bool is_blocks)
{
    uint64_t w = level_size(m->constants.width, level), h = level_size(m->constants.height, level);
    return is_blocks ? (w + 3) / 4 * ((h + 3) / 4) * 16 : 4 * w * h;
}

static uint64_t chain_bytes(const struct material *m, bool is_blocks)
{
    uint64_t sum = 0;
    for (uint32_t i = 0; i < m->constants.mipCount; i++)
        sum += level_bytes(m, i, is_blocks);
    return sum;
}

/* Channels first to first + 3 of all levels. */
static bool decode_chain(const struct material *m, uint32_t first, uint8_t *bytes)
{
    float *row = malloc(sizeof *row * 4 * m->constants.width);
    bool done = row != NULL;
    for (uint32_t mip = 0; done && mip < m->constants.mipCount; mip++) {
        uint32_t width = level_size(m->constants.width, mip);
        for (uint32_t y = 0; done && y < level_size(m->constants.height, mip); y++) {
            SluiceNeuralDecodeInfo info = {.structSize = sizeof info,
                                           .pConstants = &m->constants,
                                           .pLatents = m->latents,
                                           .latentSize = m->latent_size,
                                           .pWeights = m->weights,
                                           .weightSize = m->weight_size,
                                           .mip = mip,
                                           .y = y,
                                           .width = width,
                                           .height = 1,
                                           .firstChannel = first,
                                           .channelCount = 4,
                                           .pTexels = row};
            done = check(sluiceDecodeNeuralTexels(&info), "sluiceDecodeNeuralTexels");
            for (uint32_t i = 0; done && i < 4 * width; i++)
                *bytes++ = (uint8_t)(row[i] <= 0 ? 0 : row[i] >= 1 ? 255 : row[i] * 255 + 0.5f);
        }
    }
    free(row);
    return done;
}

static void record_copies(const struct material *m, VkCommandBuffer commands, VkBuffer from,
                          VkImage image, bool is_blocks)
{
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
        .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, m->constants.mipCount, 0, 1}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
    uint64_t offset = 0;
    for (uint32_t i = 0; i < m->constants.mipCount; i++) {
        VkBufferImageCopy copy = {.bufferOffset = offset,
                                  .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, i, 0, 1},
                                  .imageExtent = {level_size(m->constants.width, i),
                                                  level_size(m->constants.height, i), 1}};
        vkCmdCopyBufferToImage(commands, from, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &copy);
        offset += level_bytes(m, i, is_blocks);
    }
    barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

static bool upload_texture(const struct material *m, const struct gpu *gpu, bool is_blocks,
                           const struct gpu_buffer *staging, struct gpu_image *image)
{
    VkCommandBuffer commands;
    if (!gpu_create_texture(gpu, is_blocks ? VK_FORMAT_BC7_UNORM_BLOCK : VK_FORMAT_R8G8B8A8_UNORM,
                            m->constants.width, m->constants.height, m->constants.mipCount,
                            image) ||
        !commands_begin(gpu, &commands))
        return false;
    record_copies(m, commands, staging->buffer, image->image, is_blocks);
    return commands_run(gpu, commands);
}

/* Channels `first` to `first` + 3 as texels and as blocks. */
static bool create_textures(const struct material *m, const struct gpu *gpu, uint32_t first,
                            struct gpu_image *rgba8, struct gpu_image *bc7)
{
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    struct gpu_buffer texels = {0}, blocks = {0};
    bool done = gpu_create_buffer(gpu, chain_bytes(m, false), usage, &texels) &&
                gpu_create_buffer(gpu, chain_bytes(m, true), usage, &blocks) &&
                decode_chain(m, first, texels.mapped) &&
                upload_texture(m, gpu, false, &texels, rgba8);
    const struct chain chain = {texels.mapped, m->constants.width, m->constants.height,
                                m->constants.mipCount};
    if (done && baked_blocks_exist())
        done =
            baked_blocks_write(&chain, blocks.mapped) && upload_texture(m, gpu, true, &blocks, bc7);
    gpu_destroy_buffer(gpu, &texels);
    gpu_destroy_buffer(gpu, &blocks);
    return done;
}

/* Weights of a kind of the set; of random numbers without one. Owned by the caller. */
static uint8_t *get_weights(const struct material *m, const SluiceNeuralSet *set,
                            SluiceNeuralWeightKind kind, uint64_t *size)
{
    uint8_t *bytes = calloc(1, NEURAL_BENCH_WEIGHT_ROOM);
    *size = NEURAL_BENCH_WEIGHT_ROOM;
    if (bytes && !set) {
        memcpy(bytes, m->weights, (size_t)m->weight_size);
        *size = kind == SLUICE_NEURAL_WEIGHTS_FP8 ? 8608 : m->weight_size;
    } else if (bytes && !check(sluiceGetNeuralWeights(set, kind, NULL, size, bytes),
                               "sluiceGetNeuralWeights")) {
        free(bytes);
        return NULL;
    }
    return bytes;
}

/* Replaces weights by those in the device's layout. */
static bool convert_weights(const struct material *m, const struct gpu *gpu,
                            SluiceNeuralWeightKind kind, uint8_t *bytes, uint64_t size)
{
    uint8_t *made = calloc(1, NEURAL_BENCH_WEIGHT_ROOM);
    uint64_t room = NEURAL_BENCH_WEIGHT_ROOM;
    SluiceNeuralConvertInfo info = {.structSize = sizeof info,
                                    .device = gpu->device,
                                    .pfnGetDeviceProcAddr = vkGetDeviceProcAddr,
                                    .pConstants = &m->constants,
                                    .weightKind = kind,
                                    .pWeights = bytes,
                                    .weightSize = size};
    bool done =
        made && check(sluiceConvertNeuralWeights(&info, &room, made), "sluiceConvertNeuralWeights");
    if (done)
        memcpy(bytes, made, NEURAL_BENCH_WEIGHT_ROOM);
    free(made);
    return done;
}

static bool create_weights(struct material *m, const struct gpu *gpu, const SluiceNeuralSet *set,
                           enum weights weights)
{
    static const SluiceNeuralWeightKind kinds[WEIGHTS] = {[INT8] = SLUICE_NEURAL_WEIGHTS_INT8,
                                                          [FP8] = SLUICE_NEURAL_WEIGHTS_FP8,
                                                          [HALF] = SLUICE_NEURAL_WEIGHTS_HALF,
                                                          [VECTOR_INT8] =
                                                              SLUICE_NEURAL_WEIGHTS_INT8,
                                                          [VECTOR_FP8] = SLUICE_NEURAL_WEIGHTS_FP8};
    bool is_vector = weights == VECTOR_INT8 || weights == VECTOR_FP8;
    SluiceNeuralSetInfo info = {.structSize = sizeof info};
    uint64_t size;
    if (set && sluiceGetNeuralSetInfo(set, &info) == SLUICE_SUCCESS && !info.hasFp8 &&
        kinds[weights] != SLUICE_NEURAL_WEIGHTS_INT8)
        return true; /* paths without weights are left out */
    if ((weights == VECTOR_INT8 && !gpu->neural.vectorInt8) ||
        (weights == VECTOR_FP8 && !gpu->neural.vectorFp8))
        return true;
    uint8_t *bytes = get_weights(m, set, kinds[weights], &size);
    bool done = bytes && (!is_vector || convert_weights(m, gpu, kinds[weights], bytes, size)) &&
                fill_buffer(gpu, bytes, NEURAL_BENCH_WEIGHT_ROOM,
                            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, &m->storage[weights]) &&
                fill_buffer(gpu, bytes, NEURAL_BENCH_MAX_WEIGHTS,
                            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, &m->uniform[weights]);
    free(bytes);
    return done;
}

bool material_create(struct material *m, const struct gpu *gpu, const char *path, uint32_t size)
{
    const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    SluiceNeuralSetCreateInfo info = {.structSize = sizeof info, .pPath = path};
    SluiceNeuralSet *set = NULL;
    *m = (struct material){0};
    bool done = (path ? check(sluiceOpenNeuralSet(&info, &set), path) && read_material(m, set)
                      : make_material(m, size)) &&
                fill_buffer(gpu, &m->constants, sizeof m->constants, storage, &m->buffers[0]) &&
                fill_buffer(gpu, m->latents, m->latent_size, storage, &m->buffers[1]);
    for (int weights = 0; weights < WEIGHTS && done; weights++)
        done = create_weights(m, gpu, set, (enum weights)weights);
    sluiceDestroyNeuralSet(set);
    for (uint32_t i = 0; i < 2 && done; i++)
        done = create_textures(m, gpu, 4 * i, &m->rgba8[i], &m->bc7[i]);
    m->rgba8_size = 2 * chain_bytes(m, false);
    m->bc7_size = 2 * chain_bytes(m, true);
    return done;
}

bool material_time_host(const struct material *m)
{
    const SluiceNeuralConstants *k = &m->constants;
    float *texels = malloc(sizeof *texels * k->channelCount * k->width * k->height);
    const SluiceNeuralDecodeInfo info = {.structSize = sizeof info,
                                         .pConstants = k,
                                         .pLatents = m->latents,
                                         .latentSize = m->latent_size,
                                         .pWeights = m->weights,
                                         .weightSize = m->weight_size,
                                         .width = k->width,
                                         .height = k->height,
                                         .channelCount = k->channelCount,
                                         .pTexels = texels};
    bool done = texels != NULL;
    double decoded = 0, seconds = 0;
    for (clock_t begin = clock(); done && seconds < 0.2; decoded += (double)k->width * k->height) {
        done = check(sluiceDecodeNeuralTexels(&info), "sluiceDecodeNeuralTexels");
        seconds = (double)(clock() - begin) / CLOCKS_PER_SEC;
    }
    free(texels);
    if (done)
        figure("neural", "host.rate", 1e-6 * decoded / seconds, "Mtexel/s");
    return done;
}

void material_destroy(struct material *m, const struct gpu *gpu)
{
    for (uint32_t i = 0; i < 2; i++)
        gpu_destroy_buffer(gpu, &m->buffers[i]);
    for (uint32_t i = 0; i < WEIGHTS; i++) {
        gpu_destroy_buffer(gpu, &m->storage[i]);
        gpu_destroy_buffer(gpu, &m->uniform[i]);
    }
    for (uint32_t i = 0; i < 2; i++) {
        gpu_destroy_image(gpu, &m->rgba8[i]);
        gpu_destroy_image(gpu, &m->bc7[i]);
    }
    free(m->latents);
    free(m->weights);
    *m = (struct material){0};
}
