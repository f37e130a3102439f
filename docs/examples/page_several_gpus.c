/* Lines that several-gpus.md shows. Compiled, not run. */
#include <sluice/demand.h>

#include <stdio.h>

enum { MOST_DEVICES = 8 };

/* A device of the renderer. */
struct device {
    SluiceVulkanContextCreateInfo handles; /* instance, physical device, device, queues */
    SluiceVulkanContext *context;
    SluiceVulkanStreamer *streamer;
};

struct renderer {
    struct device devices[MOST_DEVICES];
    uint32_t device_count;
    SluiceReadPool *pool;
};

bool create_contexts(struct renderer *renderer, SluiceLogCallback log);
bool create_contexts(struct renderer *renderer, SluiceLogCallback log)
{
    const SluiceReadPoolCreateInfo pool = {
        .structSize = sizeof pool,
        .cacheSize = (uint64_t)1 << 30, /* texels for devices that ask later */
        .log = log};
    if (sluiceCreateReadPool(&pool, &renderer->pool) != SLUICE_SUCCESS)
        return false;
    for (uint32_t i = 0; i < renderer->device_count; i++) {
        struct device *device = &renderer->devices[i];
        SluiceVulkanContextCreateInfo context = device->handles;
        context.readPool = renderer->pool;
        context.log = log;
        if (sluiceCreateVulkanContext(&context, &device->context) != SLUICE_SUCCESS)
            return false;
    }
    return true;
}

bool add_texture(struct renderer *renderer, SluiceImageSource *source,
                 SluiceVulkanTexture textures[MOST_DEVICES]);
bool add_texture(struct renderer *renderer, SluiceImageSource *source,
                 SluiceVulkanTexture textures[MOST_DEVICES])
{
    const SluiceVulkanTextureCreateInfo create = {.structSize = sizeof create,
                                                  .source = source, /* one for all devices */
                                                  .primaryId = SLUICE_NO_TEXTURE};
    for (uint32_t i = 0; i < renderer->device_count; i++)
        if (sluiceAddVulkanTexture(renderer->devices[i].streamer, &create, &textures[i]) !=
            SLUICE_SUCCESS)
            return false;
    return true;
}

void destroy_contexts(struct renderer *renderer);
void destroy_contexts(struct renderer *renderer)
{
    for (uint32_t i = 0; i < renderer->device_count; i++) {
        sluiceDestroyVulkanStreamer(renderer->devices[i].streamer);
        sluiceDestroyVulkanContext(renderer->devices[i].context);
    }
    sluiceDestroyReadPool(renderer->pool); /* after all of its contexts */
}

void print_reads(const struct renderer *renderer);
void print_reads(const struct renderer *renderer)
{
    SluiceReadPoolStatistics reads = {.structSize = sizeof reads};
    if (sluiceGetReadPoolStatistics(renderer->pool, &reads) == SLUICE_SUCCESS)
        printf("%llu regions read, %llu joined, %llu copied later, %llu MB kept\n",
               (unsigned long long)reads.readCount, (unsigned long long)reads.joinedCount,
               (unsigned long long)reads.cachedCount, (unsigned long long)reads.keptSize >> 20);
}
