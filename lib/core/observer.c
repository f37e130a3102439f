#include "core/observer.h"

#include "core/state.h"

void slc_manager_set_observer(SluiceStreamedTextureManager *manager, struct slc_observer observer)
{
    manager->observer = observer;
}

bool slc_manager_is_used(const SluiceStreamedTextureManager *manager)
{
    return manager->used;
}

bool slc_manager_is_observed(const SluiceStreamedTextureManager *manager)
{
    return manager->observer.notify;
}

const SluiceStreamedTextureManagerCreateInfo *
slc_manager_create_info(const SluiceStreamedTextureManager *manager)
{
    return &manager->info;
}

const SluiceStreamedTextureManagerConfig *
slc_manager_config(const SluiceStreamedTextureManager *manager)
{
    return &manager->config;
}

uint64_t slc_manager_config_count(const SluiceStreamedTextureManager *manager)
{
    return manager->config_count;
}

void slc_notify(slc_manager *m, const struct slc_call *call)
{
    /* The configuration can be asked for at any time, so it alone hides nothing from a recorder. */
    m->used |= call->kind != SLC_CALL_SET_CONFIG;
    if (m->observer.notify)
        m->observer.notify(m->observer.user, m, call);
}
