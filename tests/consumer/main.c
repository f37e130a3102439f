/* A program from outside: uses the installed headers and every library that is there. */
#include <sluice/sluice.h>
#ifdef WITH_EXR
#include <sluice/exr.h>
#endif
#ifdef WITH_STORE
#include <sluice/store.h>
#endif
#ifdef WITH_CONTAINER
#include <sluice/dds.h>
#include <sluice/ktx2.h>
#endif
#ifdef WITH_BAKE
#include <sluice/bake.h>
#endif
#ifdef WITH_VULKAN
#include <sluice/demand.h>
#include <sluice/vulkan.h>
#include <vulkan/vulkan.h> /* behind it: the application's Vulkan is as it was */
#endif

#include <stdio.h>
#include <string.h>

int main(void)
{
    if (strcmp(sluiceGetResultName(SLUICE_SUCCESS), "SLUICE_SUCCESS") != 0)
        return 1;
    if (sluiceGetFormatTexelSize(SLUICE_FORMAT_R8G8B8A8_SRGB) != 4)
        return 2;
#ifdef WITH_EXR
    SluiceExrImageSourceCreateInfo info = {.structSize = sizeof info,
                                           .pPath = "there is no such file"};
    SluiceImageSource *source = NULL;
    if (sluiceCreateExrImageSource(&info, &source) != SLUICE_ERROR_FILE_NOT_FOUND)
        return 3;
#endif
#ifdef WITH_STORE
    SluiceStoreImageSourceCreateInfo store = {.structSize = sizeof store,
                                              .pPath = "there is no such file"};
    SluiceImageSource *tiles = NULL;
    if (sluiceCreateStoreImageSource(&store, &tiles) != SLUICE_ERROR_FILE_NOT_FOUND)
        return 6;
#endif
#ifdef WITH_CONTAINER
    SluiceDdsImageSourceCreateInfo dds = {.structSize = sizeof dds,
                                          .pPath = "there is no such file"};
    SluiceKtx2ImageSourceCreateInfo ktx2 = {.structSize = sizeof ktx2,
                                            .pPath = "there is no such file"};
    SluiceImageSource *files[2] = {NULL, NULL};
    SluiceImageInfo image = {.structSize = sizeof image};
    if (sluiceCreateDdsImageSource(&dds, &files[0]) != SLUICE_SUCCESS ||
        sluiceCreateKtx2ImageSource(&ktx2, &files[1]) != SLUICE_SUCCESS)
        return 4;
    for (int i = 0; i < 2; i++) {
        if (sluiceGetImageInfo(files[i], &image) != SLUICE_ERROR_FILE_NOT_FOUND)
            return 5;
        sluiceDestroyImageSource(files[i]);
    }
#endif
#ifdef WITH_BAKE
    SluiceBakeSettings settings = {.structSize = sizeof settings, .cutout = 0.5f};
    uint64_t hash = 0;
    if (sluiceHashBakeSettings(&settings, &hash) != SLUICE_SUCCESS || hash == 0)
        return 7;
#endif
#ifdef WITH_VULKAN
    (void)sizeof(&vkGetInstanceProcAddr); /* declared; not linked with */
    sluiceDestroyVulkanStreamer(NULL);
    sluiceDestroyDemandLoader(NULL);
#endif
    printf("sluice %d.%d.%d\n", SLUICE_VERSION_MAJOR, SLUICE_VERSION_MINOR, SLUICE_VERSION_PATCH);
    return 0;
}
