#include "http/http_fetch.h"
#include "http/http_target.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"

#include <stdio.h>
#include <string.h>

/* Fetches the first bytes on a connection, and sets the target to the final URL of redirects. */
static SluiceResult fetch_head(SluiceHttpFile *file, struct slc_http_connection *connection,
                               bool is_probe, unsigned char *head, struct slc_http_answer *answer)
{
    SluiceHttpClient *client = file->client;
    struct slc_http_part part = {0, client->settings.head_size, head};
    struct slc_http_fetch fetch = {
        .client = client, .url = &file->url, .parts = &part, .part_count = 1, .said = &file->said};
    struct slc_http_url landed = {0};
    bool is_moved;
    SluiceResult result =
        slc_http_fetch(&fetch, connection, is_probe ? 1 : client->settings.max_attempts, &landed,
                       &is_moved, answer);
    return result == SLUICE_SUCCESS ? slc_http_target_move(file, &landed) : result;
}

static SluiceResult keep_head(SluiceHttpFile *file, const unsigned char *head,
                              const struct slc_http_answer *answer)
{
    file->head = slc_alloc(&file->client->allocator, answer->received, 1);
    if (!file->head)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    file->head_size = answer->received;
    memcpy(file->head, head, file->head_size);
    file->size = answer->version.size;
    memcpy(file->etag, answer->version.etag, sizeof file->etag);
    memcpy(file->modified, answer->version.modified, sizeof file->modified);
    if ((file->etag[0] || file->modified[0]) && !answer->version.is_fresh)
        snprintf(file->version, sizeof file->version, "%s %s %llu", file->etag, file->modified,
                 (unsigned long long)file->size);
    return SLUICE_SUCCESS;
}

/* Gets a connection for an opening, which never shares a request. */
static SluiceResult get_connection(SluiceHttpFile *file, struct slc_http_connection **connection,
                                   bool *is_probe)
{
    struct slc_http_wait wait = {0};
    struct slc_http_host *host = slc_http_get_host(file->client, file->url.origin);
    if (!host)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    switch (slc_http_acquire(file->client, host, &wait, connection, is_probe)) {
    case SLC_HTTP_GO: return SLUICE_SUCCESS;
    case SLC_HTTP_NO_MEMORY: return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    default:
        if (!atomic_load(&file->client->is_cancelled))
            slc_log(&file->client->log, SLUICE_LOG_ERROR,
                    "%s: not asked, because its host did not answer a moment ago", file->url.shown);
        return SLUICE_ERROR_IO;
    }
}

static SluiceResult read_head(SluiceHttpFile *file, unsigned char *head)
{
    struct slc_http_connection *connection = NULL;
    struct slc_http_answer answer;
    bool is_probe = false;
    SluiceResult result = get_connection(file, &connection, &is_probe);
    if (result != SLUICE_SUCCESS)
        return result;
    result = fetch_head(file, connection, is_probe, head, &answer);
    if (result == SLUICE_SUCCESS)
        result = keep_head(file, head, &answer);
    slc_http_release(file->client, connection, slc_http_verdict_of(&answer), answer.retry_after);
    return result;
}

static SluiceResult open_file(SluiceHttpFile *file, const char *url)
{
    SluiceHttpClient *client = file->client;
    SluiceResult result =
        slc_http_url_parse(&file->url, url, &client->s3, &client->allocator, &client->log);
    if (result != SLUICE_SUCCESS)
        return result;
    unsigned char *head = slc_alloc(&client->allocator, client->settings.head_size, 1);
    result = head ? read_head(file, head) : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    slc_free(&client->allocator, head, client->settings.head_size, 1);
    return result;
}

SluiceResult sluiceOpenHttpFile(SluiceHttpClient *client, const char *pUrl, SluiceHttpFile **pFile)
{
    if (!client || !pUrl || !pFile)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceHttpFile *file = slc_calloc(&client->allocator, 1, sizeof *file);
    if (!file)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    file->client = client;
    SluiceResult result = open_file(file, pUrl);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyHttpFile(file);
        return result;
    }
    *pFile = file;
    return SLUICE_SUCCESS;
}

void sluiceDestroyHttpFile(SluiceHttpFile *file)
{
    if (!file)
        return;
    SluiceAllocationCallbacks cb = file->client->allocator;
    slc_http_url_free(&file->url, &cb);
    slc_http_target_finish(file);
    slc_free(&cb, file->head, file->head_size, 1);
    slc_free(&cb, file, 1, sizeof *file);
}

/* Makes one request for this read and for waiting adjacent reads. */
static SluiceResult read_on(SluiceHttpFile *file, const struct slc_http_target *target,
                            const struct slc_http_part *part,
                            struct slc_http_connection *connection, bool is_probe, bool is_check)
{
    SluiceHttpClient *client = file->client;
    struct slc_http_part parts[SLC_HTTP_MAX_PARTS] = {*part};
    struct slc_http_wait *waits[SLC_HTTP_MAX_PARTS];
    struct slc_http_answer answer;
    struct slc_http_url landed = {0};
    bool is_moved;
    uint32_t count = slc_http_join(client, target->host, file, parts, waits);
    struct slc_http_fetch fetch = {.client = client,
                                   .file = file,
                                   .url = &file->url,
                                   .target = target->url.full ? &target->url : NULL,
                                   .parts = parts,
                                   .part_count = count,
                                   .said = &file->said,
                                   .is_check = is_check};
    SluiceResult result =
        slc_http_fetch(&fetch, connection, is_probe ? 1 : client->settings.max_attempts, &landed,
                       &is_moved, &answer);
    if (is_moved && (fetch.target || landed.full))
        (void)slc_http_target_move(file, &landed); /* out of memory: the old target stays */
    else
        slc_http_url_free(&landed, &client->allocator);
    if (answer.is_changed)
        atomic_store(&file->is_stale, true);
    /* An opened file that is missing now is an IO error, not FILE_NOT_FOUND. */
    if (result == SLUICE_ERROR_FILE_NOT_FOUND || result == SLUICE_ERROR_UNSUPPORTED)
        result = SLUICE_ERROR_IO;
    slc_http_finish_joined(client, waits, count, result);
    slc_http_release(client, connection, slc_http_verdict_of(&answer), answer.retry_after);
    return result;
}

static SluiceResult read_far(SluiceHttpFile *file, const struct slc_http_part *part, bool is_check)
{
    struct slc_http_wait wait = {.file = file, .part = *part};
    struct slc_http_connection *connection = NULL;
    struct slc_http_target *target = slc_http_target_use(file);
    bool is_probe = false;
    SluiceResult result = SLUICE_ERROR_IO;
    switch (slc_http_acquire(file->client, target->host, &wait, &connection, &is_probe)) {
    case SLC_HTTP_GO: result = read_on(file, target, part, connection, is_probe, is_check); break;
    case SLC_HTTP_DONE: result = wait.result; break;
    case SLC_HTTP_NO_MEMORY: result = SLUICE_ERROR_OUT_OF_HOST_MEMORY; break;
    case SLC_HTTP_REFUSED: break;
    }
    slc_http_target_leave(file, target);
    return result;
}

/* Reads from the cache folder, or from the server and then writes the cache. */
static SluiceResult read_through(SluiceHttpFile *file, const struct slc_http_part *part)
{
    struct slc_http_cache *cache = &file->client->cache;
    if (!cache->folder || !file->version[0])
        return read_far(file, part, false);
    struct slc_http_key key = slc_http_cache_key(file->url.full, file->url.shown, file->version,
                                                 part->offset, part->size);
    if (slc_http_cache_read(cache, key, part->bytes, (size_t)part->size))
        return SLUICE_SUCCESS;
    SluiceResult result = read_far(file, part, false);
    if (result == SLUICE_SUCCESS)
        slc_http_cache_write(cache, key, part->bytes, (size_t)part->size);
    return result;
}

static SluiceResult read_input(void *user, uint64_t offset, void *bytes, size_t size)
{
    SluiceHttpFile *file = user;
    struct slc_http_counts *counts = &file->client->counts;
    SluiceResult result = SLUICE_SUCCESS;
    if (offset > file->size || size > file->size - offset || size == 0)
        return slc_log_refusal(&file->client->log, "%s: %llu bytes at %llu of %llu were asked for",
                               file->url.shown, (unsigned long long)size,
                               (unsigned long long)offset, (unsigned long long)file->size);
    if (atomic_load(&file->is_stale))
        return SLUICE_ERROR_IO;
    if (offset + size <= file->head_size) {
        memcpy(bytes, file->head + offset, size);
        atomic_fetch_add(&counts->kept, 1);
    } else {
        struct slc_http_part part = {offset, size, bytes};
        result = read_through(file, &part);
    }
    if (result == SLUICE_SUCCESS) {
        atomic_fetch_add(&counts->reads, 1);
        atomic_fetch_add(&counts->asked, size);
    }
    return result;
}

SluiceResult sluiceGetHttpInput(SluiceHttpFile *file, SluiceInput *pInput)
{
    if (!file || !pInput)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = slc_struct_check(SLC_STRUCT(SluiceInput), pInput, &file->client->log);
    if (result != SLUICE_SUCCESS)
        return result;
    SluiceInput input = {.size = file->size, .pUserData = file, .pfnRead = read_input};
    slc_struct_write(SLC_STRUCT(SluiceInput), pInput, &input);
    return SLUICE_SUCCESS;
}

SluiceResult sluiceOpenHttpPath(void *pClient, const char *path, SluiceInput *pInput,
                                void **ppOpened)
{
    SluiceHttpFile *file = NULL;
    if (!pInput || !ppOpened)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result = sluiceOpenHttpFile(pClient, path, &file);
    if (result == SLUICE_SUCCESS)
        result = sluiceGetHttpInput(file, pInput);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyHttpFile(file);
        return result;
    }
    *ppOpened = file;
    return SLUICE_SUCCESS;
}

void sluiceCloseHttpPath(void *pClient, void *pOpened)
{
    (void)pClient;
    sluiceDestroyHttpFile(pOpened);
}

SluiceResult sluiceCheckHttpPath(void *pClient, void *pOpened)
{
    SluiceHttpFile *file = pOpened;
    unsigned char byte;
    const struct slc_http_part part = {0, 1, &byte};
    if (!pClient || !file)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        atomic_load(&file->is_stale) ? SLUICE_ERROR_IO : read_far(file, &part, true);
    if (result == SLUICE_SUCCESS && !file->version[0])
        return SLUICE_ERROR_UNSUPPORTED; /* a file of this size may have other contents */
    return result;
}
