/* A program from outside: uses the installed headers and every library that is there. */
#include <sluice/sluice.h>
#ifdef WITH_EXR
#include <sluice/exr.h>
#endif
#ifdef WITH_STORE
#include <sluice/store.h>
#endif
#ifdef WITH_VULKAN
#include <sluice/vulkan.h>
#include <vulkan/vulkan.h> /* behind it: the application's Vulkan is as it was */
#endif

#include <stdio.h>
#include <string.h>

int main(void)
{
    if (strcmp(sluiceResultString(SLUICE_SUCCESS), "SLUICE_SUCCESS") != 0)
        return 1;
    if (sluiceFormatTexelSize(SLUICE_FORMAT_R8G8B8A8_SRGB) != 4)
        return 2;
#ifdef WITH_EXR
    SluiceExrImageSourceCreateInfo info = {.pPath = "there is no such file"};
    SluiceImageSource *source = NULL;
    if (sluiceCreateExrImageSource(&info, &source) != SLUICE_ERROR_FILE_NOT_FOUND)
        return 3;
#endif
#ifdef WITH_STORE
    SluiceStoreImageSourceCreateInfo store = {.pPath = "there is no such file"};
    SluiceImageSource *tiles = NULL;
    if (sluiceCreateStoreImageSource(&store, &tiles) != SLUICE_ERROR_FILE_NOT_FOUND)
        return 4;
#endif
#ifdef WITH_VULKAN
    (void)sizeof(&vkGetInstanceProcAddr); /* declared; not linked with */
    sluiceDestroyVulkanStreamer(NULL);
#endif
    printf("sluice %d.%d.%d\n", SLUICE_VERSION_MAJOR, SLUICE_VERSION_MINOR, SLUICE_VERSION_PATCH);
    return 0;
}
