/* Lines that remote.md shows. Compiled, not run. */
#include <sluice/http.h>
#include <sluice/open.h>
#include <sluice/store.h>

SluiceResult open_remote_store(SluiceHttpClient *client, const char *url, SluiceHttpFile **file,
                               SluiceImageSource **source);

SluiceResult open_remote_store(SluiceHttpClient *client, const char *url, SluiceHttpFile **file,
                               SluiceImageSource **source)
{
    SluiceInput input = {.structSize = sizeof input};
    SluiceStoreImageSourceCreateInfo info = {
        .structSize = sizeof info, .pPath = url, .pInput = &input};
    SluiceResult result = sluiceOpenHttpFile(client, url, file);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetHttpInput(*file, &input);
    if (result == SLUICE_SUCCESS)
        result = sluiceCreateStoreImageSource(&info, source);
    return result;
}

SluiceResult create_url_opener(SluiceHttpClient *client, SluiceImageOpener **opener);

SluiceResult create_url_opener(SluiceHttpClient *client, SluiceImageOpener **opener)
{
    SluiceImageOpenerCreateInfo info = {
        .structSize = sizeof info,
        .pathOpener = {client, sluiceOpenHttpPath, sluiceCloseHttpPath},
        .pfnCheckPath = sluiceCheckHttpPath};
    SluiceResult result = sluiceCreateImageOpener(&info, opener);
    return result;
}
