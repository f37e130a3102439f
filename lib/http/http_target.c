#include "http/http_target.h"

#include "base/alloc.h"

/* Ends a use of a target, with the client's mutex held. Returns a target to free, or NULL. */
static struct slc_http_target *leave(struct slc_http_target *target)
{
    return target && --target->user_count == 0 ? target : NULL;
}

static void free_target(SluiceHttpClient *client, struct slc_http_target *target)
{
    if (!target)
        return;
    slc_http_url_free(&target->url, &client->allocator);
    slc_free(&client->allocator, target, 1, sizeof *target);
}

struct slc_http_target *slc_http_target_use(SluiceHttpFile *file)
{
    slc_mutex_lock(&file->client->mutex);
    struct slc_http_target *target = file->target;
    target->user_count++;
    slc_mutex_unlock(&file->client->mutex);
    return target;
}

void slc_http_target_leave(SluiceHttpFile *file, struct slc_http_target *target)
{
    slc_mutex_lock(&file->client->mutex);
    target = leave(target);
    slc_mutex_unlock(&file->client->mutex);
    free_target(file->client, target);
}

SluiceResult slc_http_target_move(SluiceHttpFile *file, struct slc_http_url *landed)
{
    SluiceHttpClient *client = file->client;
    struct slc_http_target *target = slc_calloc(&client->allocator, 1, sizeof *target), *old;
    const char *origin = landed->full ? landed->origin : file->url.origin;
    struct slc_http_host *host = target ? slc_http_get_host(client, origin) : NULL;
    if (!host) {
        slc_http_url_free(landed, &client->allocator);
        slc_free(&client->allocator, target, 1, sizeof *target);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    *target = (struct slc_http_target){*landed, host, 1};
    slc_mutex_lock(&client->mutex);
    old = leave(file->target);
    file->target = target;
    slc_mutex_unlock(&client->mutex);
    free_target(client, old);
    return SLUICE_SUCCESS;
}

void slc_http_target_finish(SluiceHttpFile *file)
{
    free_target(file->client, file->target);
    file->target = NULL;
}
