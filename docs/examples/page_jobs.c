/* Lines that integrating.md and images.md show. Compiled, not run. */
#include <sluice/vulkan_context.h>

#include <stdlib.h>

/* Functions of the engine. */
struct engine;
bool engine_add_task(struct engine *engine, void (*pfnRun)(void *), void *argument);
void engine_lock_queues(struct engine *engine);
void engine_unlock_queues(struct engine *engine);
bool engine_start_read(struct engine *engine, const SluiceImageRegion *region, void *texels,
                       size_t rowPitch, void (*pfnDone)(void *, bool), void *argument);

static SluiceResult submit_job(void *pUserData, void (*pfnRun)(void *pJob), void *pJob)
{
    /* NOT_READY refuses the job: Sluice submits one again later. */
    return engine_add_task(pUserData, pfnRun, pJob) ? SLUICE_SUCCESS : SLUICE_NOT_READY;
}

static void lock_queue(void *pUserData, VkQueue queue)
{
    (void)queue; /* VK_NULL_HANDLE: all queues */
    engine_lock_queues(pUserData);
}

static void unlock_queue(void *pUserData, VkQueue queue)
{
    (void)queue;
    engine_unlock_queues(pUserData);
}

SluiceResult create_context(struct engine *engine, SluiceVulkanContextCreateInfo info,
                            SluiceVulkanContext **pContext);
SluiceResult create_context(struct engine *engine, SluiceVulkanContextCreateInfo info,
                            SluiceVulkanContext **pContext)
{
    const SluiceJobSystem jobs = {engine, submit_job};
    const SluiceVulkanQueueLockCallbacks lock = {engine, lock_queue, unlock_queue};
    info.pJobSystem = &jobs; /* both are copied */
    info.pQueueLock = &lock;
    return sluiceCreateVulkanContext(&info, pContext);
}

/* A source whose engine reads asynchronously. */
struct async_source {
    SluiceImageSource base; /* must be first */
    struct engine *engine;
};

/* Called on a thread of the engine, once the texels are written. */
static void end_read(void *argument, bool is_read)
{
    const SluiceImageReadToken token = *(const SluiceImageReadToken *)argument;
    free(argument);
    sluiceCompleteImageRead(&token, is_read ? SLUICE_SUCCESS : SLUICE_ERROR_IO);
}

SluiceResult start_read(SluiceImageSource *source, const SluiceImageRegion *pRegion, void *pTexels,
                        size_t rowPitch, const SluiceImageReadToken *pToken);
SluiceResult start_read(SluiceImageSource *source, const SluiceImageRegion *pRegion, void *pTexels,
                        size_t rowPitch, const SluiceImageReadToken *pToken)
{
    const struct async_source *async = (const struct async_source *)source;
    SluiceImageReadToken *token = malloc(sizeof *token);
    if (!token)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    *token = *pToken;
    if (engine_start_read(async->engine, pRegion, pTexels, rowPitch, end_read, token))
        return SLUICE_SUCCESS;
    free(token);
    return SLUICE_ERROR_UNSUPPORTED; /* pfnReadRegion reads instead */
}
