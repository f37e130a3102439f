/* Settings that can change while a loader runs. */
#include "demand_vulkan/loader.h"

#include "base/struct_size.h"
#include "vulkan/create_checks.h"

SluiceResult sluiceGetDemandLoaderSettings(const SluiceDemandLoader *loader,
                                           SluiceDemandLoaderSettings *pSettings)
{
    if (!loader || !pSettings)
        return SLUICE_ERROR_NULL_POINTER;
    const struct slc_struct *type = SLC_STRUCT(SluiceDemandLoaderSettings);
    SluiceResult result = slc_struct_check(type, pSettings, &loader->vk.log);
    if (result == SLUICE_SUCCESS)
        slc_struct_write(type, pSettings, &loader->settings);
    return result;
}

SluiceResult sluiceSetDemandLoaderSettings(SluiceDemandLoader *loader,
                                           const SluiceDemandLoaderSettings *pSettings)
{
    if (!loader || !pSettings)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceDemandLoaderSettings settings;
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceDemandLoaderSettings), &settings,
                                          pSettings, &loader->vk.log);
    if (result != SLUICE_SUCCESS)
        return result;
    const struct slc_limit limits[] = {{"maxRequestsPerLaunch", settings.maxRequestsPerLaunch, 1,
                                        loader->info.maxRequestsPerLaunch}};
    result = slc_check_limits(&loader->vk.log, limits, 1);
    if (result == SLUICE_SUCCESS)
        loader->settings = settings;
    return result;
}

void slc_loader_settings_apply(SluiceDemandLoader *loader)
{
    const SluiceDemandLoaderSettings *settings = &loader->settings;
    loader->requests_per_launch = settings->maxRequestsPerLaunch;
    loader->info.failureRetryDelayNs = settings->failureRetryDelayNs;
    loader->info.forgetAfterLaunches = settings->forgetAfterLaunches;
    if (loader->info.noEviction == settings->noEviction &&
        loader->info.noLodBias == settings->noLodBias)
        return;
    loader->info.noEviction = settings->noEviction;
    loader->info.noLodBias = settings->noLodBias;
    slc_residency_set_switches(loader->residency, settings->noEviction, settings->noLodBias);
}
