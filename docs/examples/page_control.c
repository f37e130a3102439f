/* Lines that docs/control.md shows. Compiled, not run. */
#include <sluice/vulkan_explain.h>
#include <sluice/vulkan_strict.h>

#include <stdio.h>

/* Before a level begins: a loading screen draws a frame between two calls. */
SluiceResult showSavedFile(SluiceVulkanStreamer *streamer, SluiceTextureId texture,
                           SluiceImageSource *opened);
void destroyWhenUnused(const SluiceVulkanStreamer *streamer, SluiceImageSource **pOld);
SluiceVulkanWaitStatus loadNow(SluiceVulkanStreamer *streamer, SluiceTextureRequestId request,
                               void (*drawFrame)(void *user), void *user);
void reportMisuse(void *pUserData, const SluiceMisuse *pMisuse);
SluiceResult addDetailMap(SluiceVulkanStreamer *streamer, SluiceImageSource *source,
                          SluiceTextureId base, SluiceVulkanTexture *pDetail);
SluiceResult requestHero(SluiceVulkanStreamer *streamer, SluiceTextureId hero,
                         SluiceTextureRequestId *pRequest);
bool isReady(const SluiceVulkanStreamer *streamer, SluiceTextureRequestId request);
void explain(const SluiceVulkanStreamer *streamer, SluiceTextureId texture,
             const SluiceTextureRect *pRect);
void printEvents(const SluiceStreamedTextureManager *manager, uint64_t *pCursor);

SluiceResult requestHero(SluiceVulkanStreamer *streamer, SluiceTextureId hero,
                         SluiceTextureRequestId *pRequest)
{
    const SluiceVulkanTextureRequest pin = {
        .structSize = sizeof pin, .level = 0, .until = UINT64_MAX};
    return sluiceRequestVulkanTexture(streamer, hero, &pin, pRequest);
}

bool isReady(const SluiceVulkanStreamer *streamer, SluiceTextureRequestId request)
{
    SluiceVulkanRequestProgress progress = {.structSize = sizeof progress};
    if (sluiceGetVulkanRequestProgress(streamer, request, &progress) != SLUICE_SUCCESS)
        return true;
    return progress.over || progress.ready ||
           progress.residentTileCount + progress.givenUpTileCount == progress.tileCount;
}

void explain(const SluiceVulkanStreamer *streamer, SluiceTextureId texture,
             const SluiceTextureRect *pRect)
{
    SluiceVulkanExplanation why = {.structSize = sizeof why};
    if (sluiceExplainVulkanTexture(streamer, texture, pRect, &why) == SLUICE_SUCCESS)
        printf("%s\n", why.sentence);
}

void printEvents(const SluiceStreamedTextureManager *manager, uint64_t *pCursor)
{
    SluiceTileEvent events[64];
    uint64_t lost;
    SluiceResult more = SLUICE_INCOMPLETE;
    while (more == SLUICE_INCOMPLETE) {
        uint32_t count = 64;
        more = sluiceReadTileEvents(manager, pCursor, &count, events, &lost);
        for (uint32_t i = 0; more >= 0 && i < count; i++)
            printf("frame %llu: tile %u, state %d to %d, reason %d\n",
                   (unsigned long long)events[i].mark, events[i].tileIndex, (int)events[i].from,
                   (int)events[i].to, (int)events[i].reason);
    }
}

SluiceResult addDetailMap(SluiceVulkanStreamer *streamer, SluiceImageSource *source,
                          SluiceTextureId base, SluiceVulkanTexture *pDetail)
{
    const SluiceUvTransform eight = {.scaleU = 8, .scaleV = 8};
    const SluiceVulkanTextureCreateInfo info = {
        .structSize = sizeof info, .source = source, .primaryId = base, .pUvTransform = &eight};
    return sluiceAddVulkanTexture(streamer, &info, pDetail);
}

SluiceResult showSavedFile(SluiceVulkanStreamer *streamer, SluiceTextureId texture,
                           SluiceImageSource *opened)
{
    SluiceResult result = sluiceReplaceVulkanSource(streamer, texture, opened);
    if (result == SLUICE_ERROR_INVALID_ARGUMENT)
        printf("other size or format: remove the texture and add a new one\n");
    return result;
}

void destroyWhenUnused(const SluiceVulkanStreamer *streamer, SluiceImageSource **pOld)
{
    bool inUse = true;
    if (*pOld && sluiceIsVulkanSourceInUse(streamer, *pOld, &inUse) == SLUICE_SUCCESS && !inUse) {
        sluiceDestroyImageSource(*pOld);
        *pOld = NULL;
    }
}

SluiceVulkanWaitStatus loadNow(SluiceVulkanStreamer *streamer, SluiceTextureRequestId request,
                               void (*drawFrame)(void *user), void *user)
{
    const uint64_t second = 1000000000;
    SluiceVulkanWaitStatus status = SLUICE_VULKAN_WAIT_FRAME;
    while (status == SLUICE_VULKAN_WAIT_FRAME) {
        if (sluiceWaitVulkanRequest(streamer, request, 5 * second, &status) != SLUICE_SUCCESS)
            return SLUICE_VULKAN_WAIT_OVER;
        if (status == SLUICE_VULKAN_WAIT_FRAME)
            drawFrame(user); /* begins, ends and submits a streaming frame */
    }
    return status;
}

void reportMisuse(void *pUserData, const SluiceMisuse *pMisuse)
{
    fprintf(stderr, "%s: misuse %d: %s\n", (const char *)pUserData, (int)pMisuse->kind,
            pMisuse->pMessage);
}

SluiceResult page_record_stutter(SluiceVulkanStreamer *streamer, SluiceRecorder **pRecorder);
SluiceResult page_record_stutter(SluiceVulkanStreamer *streamer, SluiceRecorder **pRecorder)
{
    SluiceStreamedTextureManager *manager;
    SluiceResult result = sluiceGetVulkanStreamerManager(streamer, &manager);
    if (result == SLUICE_SUCCESS)
        result = sluiceBeginRecordingToFile(manager, "stutter.trace", NULL, pRecorder);
    return result;
}
