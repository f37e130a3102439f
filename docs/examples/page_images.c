/* Lines that images.md shows. Compiled, not run. */
#include <sluice/open.h>

SluiceResult open_any_file(const char *cacheFolder, const char *path, SluiceImageOpener **pOpener,
                           SluiceImageSource **pSource);

SluiceResult open_any_file(const char *cacheFolder, const char *path, SluiceImageOpener **pOpener,
                           SluiceImageSource **pSource)
{
    SluiceImageOpenerCreateInfo info = {.structSize = sizeof info, .pCacheFolder = cacheFolder};
    SluiceResult result = sluiceCreateImageOpener(&info, pOpener);
    if (result == SLUICE_SUCCESS)
        result = sluiceOpenImageSource(*pOpener, path, pSource);
    return result;
}

SluiceResult open_albedo(SluiceImageOpener *opener, const char *path, SluiceImageSource **pSource);

SluiceResult open_albedo(SluiceImageOpener *opener, const char *path, SluiceImageSource **pSource)
{
    return sluiceOpenNamedImageSource(opener, path, "albedo", pSource);
}
