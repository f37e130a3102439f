#include "traced_parts.h"

#include "../common/log.h"
#include "../common/text.h"

#include <pthread.h>
#include <stdlib.h>

static bool check(SluiceResult result, const char *what)
{
    if (result != SLUICE_SUCCESS)
        text_say("sluice-view: %s: %s", what, sluiceGetResultName(result));
    return result == SLUICE_SUCCESS;
}

static void note_failure(void *user_data, const SluiceTileReadFailure *failure)
{
    struct traced_parts *p = user_data;
    if (!failure->willRetry)
        atomic_fetch_add(&p->failed_reads, 1);
}

static bool create_loader(struct traced_parts *p, uint32_t threads)
{
    const struct gpu *gpu = p->gpu;
    const SluiceVulkanContextCreateInfo context = {
        .structSize = sizeof context,
        .queueFamilyIndex = gpu->family,
        .instance = gpu->instance,
        .physicalDevice = gpu->physical_device,
        .device = gpu->device,
        .pfnGetInstanceProcAddr = vkGetInstanceProcAddr,
        .log = {.pfnLog = log_say},
        .loaderThreadCount = threads,
    };
    if (!check(sluiceCreateVulkanContext(&context, &p->context), "sluiceCreateVulkanContext"))
        return false;
    const SluiceDemandLoaderCreateInfo info = {
        .structSize = sizeof info,
        .context = p->context,
        .pageCapacity = PBRT_PAGE_CAPACITY,
        .maxRequestsPerLaunch = PBRT_MOST_REQUESTS,
        .failure = {p, note_failure},
    };
    return check(sluiceCreateDemandLoader(&info, &p->loader), "sluiceCreateDemandLoader");
}

struct traced_parts *traced_parts_create(const struct gpu *gpu, uint32_t threads)
{
    struct traced_parts *p = calloc(1, sizeof *p);
    if (!p) {
        text_say("sluice-view: out of memory");
        return NULL;
    }
    p->gpu = gpu;
    p->threads = threads;
    if (!gpu->buffer_addresses || !gpu->byte_pages)
        text_say("sluice-view: %s cannot load on demand: scenes of pbrt need paged mode and "
                 "addresses of buffers",
                 gpu->properties.deviceName);
    else if (create_loader(p, threads) && tracing_create(gpu, p->loader, true, &p->tracing) &&
             traced_view_create(gpu, p->loader, &p->view) && traced_show_create(gpu, &p->show))
        return p;
    traced_parts_destroy(p);
    return NULL;
}

void traced_parts_destroy_loader(struct traced_parts *p)
{
    sluiceDestroyDemandLoader(p->loader);
    sluiceDestroyVulkanContext(p->context);
    p->loader = NULL;
    p->context = NULL;
}

void traced_parts_destroy(struct traced_parts *p)
{
    if (!p)
        return;
    traced_show_destroy(&p->show);
    traced_view_destroy(&p->view);
    tracing_destroy(p->gpu, &p->tracing);
    traced_parts_destroy_loader(p);
    free(p);
}

struct traced_parts_load {
    pthread_t thread;
    const struct gpu *gpu;
    uint32_t threads;
    struct traced_parts *parts;
    atomic_bool done;
};

static void *create_parts(void *user_data)
{
    struct traced_parts_load *load = user_data;
    load->parts = traced_parts_create(load->gpu, load->threads);
    atomic_store(&load->done, true);
    return NULL;
}

struct traced_parts_load *traced_parts_begin(const struct gpu *gpu, uint32_t threads)
{
    struct traced_parts_load *load = calloc(1, sizeof *load);
    if (!load)
        return NULL;
    load->gpu = gpu;
    load->threads = threads;
    if (pthread_create(&load->thread, NULL, create_parts, load) == 0)
        return load;
    free(load);
    return NULL;
}

bool traced_parts_done(const struct traced_parts_load *load)
{
    return atomic_load(&load->done);
}

struct traced_parts *traced_parts_end(struct traced_parts_load *load)
{
    pthread_join(load->thread, NULL);
    struct traced_parts *parts = load->parts;
    free(load);
    return parts;
}
