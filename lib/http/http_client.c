#include "http/http_client.h"

#include "base/alloc.h"
#include "base/log.h"
#include "base/struct_size.h"
#include "platform/pipe_signal.h"

#include <stdio.h>
#include <string.h>

static void free_string(SluiceHttpClient *client, char *string)
{
    if (string)
        slc_free(&client->allocator, string, strlen(string) + 1, 1);
}

/* Copies a string that may be NULL. */
static bool copy_string(SluiceHttpClient *client, char **to, const char *from)
{
    *to = from ? slc_strdup(&client->allocator, from) : NULL;
    return *to || !from;
}

/* Replaces 0 by the default and checks the range. */
static SluiceResult take_setting(const SluiceHttpClient *client, const char *name, uint32_t *to,
                                 uint32_t value, uint32_t usual, uint32_t most)
{
    *to = value ? value : usual;
    if (*to > most)
        return slc_log_refusal(&client->log, "SluiceHttpClientCreateInfo::%s is %u, above %u", name,
                               value, most);
    return SLUICE_SUCCESS;
}

static SluiceResult take_settings(SluiceHttpClient *client, const SluiceHttpClientCreateInfo *info)
{
    struct slc_http_settings *s = &client->settings;
    const struct {
        const char *name;
        uint32_t *to, value, usual, most;
    } rows[] = {
        {"maxConnectionsPerHost", &s->max_connections, info->maxConnectionsPerHost,
         SLUICE_HTTP_DEFAULT_CONNECTIONS_PER_HOST, 1024},
        {"headSize", &s->head_size, info->headSize, SLUICE_HTTP_DEFAULT_HEAD_SIZE, 1u << 26},
        {"maxJoinedSize", &s->max_joined_size, info->maxJoinedSize, 1u << 20, 1u << 26},
        {"connectTimeout", &s->connect_timeout, info->connectTimeout, 10000, 1u << 30},
        {"stallTimeout", &s->stall_timeout, info->stallTimeout, 10000, 1u << 30},
        {"maxAttemptCount", &s->max_attempts, info->maxAttemptCount, 4, 100},
        {"retryDelay", &s->retry_delay, info->retryDelay, 100, 1u << 30},
        {"maxRetryDelay", &s->max_retry_delay, info->maxRetryDelay, 5000, 1u << 30},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        SluiceResult result = take_setting(client, rows[i].name, rows[i].to, rows[i].value,
                                           rows[i].usual, rows[i].most);
        if (result != SLUICE_SUCCESS)
            return result;
    }
    return SLUICE_SUCCESS;
}

/* Appends a line to a list of libcurl. */
static bool append_line(struct curl_slist **list, const char *line)
{
    struct curl_slist *grown = curl_slist_append(*list, line);
    if (grown)
        *list = grown;
    return grown;
}

static SluiceResult take_headers(SluiceHttpClient *client, const SluiceHttpClientCreateInfo *info)
{
    if (info->headerCount > 0 && !info->ppHeaders)
        return SLUICE_ERROR_NULL_POINTER;
    for (uint32_t i = 0; i < info->headerCount; i++) {
        const char *line = info->ppHeaders[i];
        if (!line)
            return SLUICE_ERROR_NULL_POINTER;
        if (!strchr(line, ':') || strpbrk(line, "\r\n"))
            return slc_log_refusal(&client->log,
                                   "SluiceHttpClientCreateInfo::ppHeaders[%u] is no single line "
                                   "\"NAME: VALUE\"",
                                   i);
        if (!append_line(&client->headers, line))
            return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    return SLUICE_SUCCESS;
}

/* Joins up to three strings in memory of the caller's allocator. */
static char *join(SluiceHttpClient *client, const char *a, const char *b, const char *c)
{
    size_t size = strlen(a) + strlen(b) + strlen(c) + 1;
    char *text = slc_alloc(&client->allocator, size, 1);
    if (text)
        snprintf(text, size, "%s%s%s", a, b, c);
    return text;
}

static bool copy_s3(SluiceHttpClient *client, const SluiceS3Access *from)
{
    struct slc_s3_access *s3 = &client->s3;
    const char *region = from->pRegion ? from->pRegion : "us-east-1";
    bool is_copied = copy_string(client, &s3->region, region) &&
                     copy_string(client, &s3->access_key, from->pAccessKey) &&
                     copy_string(client, &s3->secret_key, from->pSecretKey) &&
                     copy_string(client, &s3->session_token, from->pSessionToken);
    s3->endpoint = slc_strdup(&client->allocator, from->pEndpoint);
    if (from->pAccessKey)
        client->signature = join(client, "aws:amz:", region, ":s3");
    return is_copied && s3->endpoint && (client->signature || !from->pAccessKey);
}

/* Makes the headers of S3 requests. The text stands for the hash of an unsigned body. */
static bool make_s3_headers(SluiceHttpClient *client)
{
    if (!client->signature)
        return true;
    if (!append_line(&client->s3_headers, "x-amz-content-sha256: UNSIGNED-PAYLOAD"))
        return false;
    if (!client->s3.session_token)
        return true;
    char *line = join(client, "x-amz-security-token: ", client->s3.session_token, "");
    bool is_added = line && append_line(&client->s3_headers, line);
    free_string(client, line);
    return is_added;
}

static SluiceResult take_s3(SluiceHttpClient *client, const SluiceS3Access *given)
{
    SluiceS3Access access = {.structSize = sizeof access};
    if (!given)
        return SLUICE_SUCCESS;
    SluiceResult result = slc_struct_read(SLC_STRUCT(SluiceS3Access), &access, given, &client->log);
    if (result != SLUICE_SUCCESS)
        return result;
    if (!access.pEndpoint)
        return SLUICE_ERROR_NULL_POINTER;
    if (access.pAccessKey && !access.pSecretKey)
        return slc_log_refusal(&client->log,
                               "SluiceS3Access::pAccessKey is set, and pSecretKey is not");
    return copy_s3(client, &access) && make_s3_headers(client) ? SLUICE_SUCCESS
                                                               : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static SluiceResult start_curl(SluiceHttpClient *client)
{
    const curl_version_info_data *version = curl_version_info(CURLVERSION_NOW);
    if (!(version->features & CURL_VERSION_THREADSAFE) || !(version->features & CURL_VERSION_SSL)) {
        slc_log(&client->log, SLUICE_LOG_ERROR,
                "libcurl %s lacks HTTPS, or cannot be started on any thread; 7.84 or later with "
                "OpenSSL or GnuTLS is needed",
                version->version);
        return SLUICE_ERROR_UNSUPPORTED;
    }
    /* Never undone by curl_global_cleanup. An application that calls curl_easy_init alone, without
     * curl_global_init, uses this initialization and would lose it. */
    return curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK ? SLUICE_SUCCESS
                                                             : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static SluiceResult set_up(SluiceHttpClient *client, const SluiceHttpClientCreateInfo *info)
{
    SluiceResult result = take_settings(client, info);
    if (result == SLUICE_SUCCESS)
        result = start_curl(client);
    if (result == SLUICE_SUCCESS)
        result = take_headers(client, info);
    if (result == SLUICE_SUCCESS)
        result = take_s3(client, info->pS3);
    if (result == SLUICE_SUCCESS &&
        !copy_string(client, &client->certificate_file, info->pCertificateFile))
        result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (result == SLUICE_SUCCESS && info->pCacheFolder)
        result = slc_http_cache_init(&client->cache, info->pCacheFolder,
                                     info->maxCacheSize ? info->maxCacheSize
                                                        : SLUICE_HTTP_DEFAULT_CACHE_SIZE,
                                     &client->allocator, &client->log);
    return result;
}

SluiceResult sluiceCreateHttpClient(const SluiceHttpClientCreateInfo *pInfo,
                                    SluiceHttpClient **pClient)
{
    SluiceHttpClientCreateInfo info = {.structSize = sizeof info};
    if (!pClient)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        pInfo ? slc_struct_read(SLC_STRUCT(SluiceHttpClientCreateInfo), &info, pInfo, &pInfo->log)
              : SLUICE_SUCCESS;
    if (result != SLUICE_SUCCESS)
        return result;
    if (!slc_allocator_is_valid(info.pAllocator))
        return SLUICE_ERROR_NULL_POINTER;
    SluiceAllocationCallbacks cb = slc_allocator(info.pAllocator);
    SluiceHttpClient *client = slc_calloc(&cb, 1, sizeof *client);
    if (!client)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    client->allocator = cb;
    client->log = info.log;
    slc_mutex_init(&client->mutex);
    slc_condition_init(&client->cancelled);
    result = set_up(client, &info);
    if (result != SLUICE_SUCCESS) {
        sluiceDestroyHttpClient(client);
        return result;
    }
    *pClient = client;
    return SLUICE_SUCCESS;
}

static void free_hosts(SluiceHttpClient *client)
{
    struct slc_pipe_signal pipes;
    slc_pipe_signal_block(&pipes); /* OpenSSL writes to connections that may be closed */
    while (client->hosts) {
        struct slc_http_host *host = client->hosts;
        client->hosts = host->next;
        while (host->idle) {
            struct slc_http_connection *connection = host->idle;
            host->idle = connection->next;
            curl_easy_cleanup(connection->easy);
            slc_free(&client->allocator, connection, 1, sizeof *connection);
        }
        free_string(client, host->origin);
        slc_free(&client->allocator, host, 1, sizeof *host);
    }
    slc_pipe_signal_restore(&pipes);
}

void sluiceDestroyHttpClient(SluiceHttpClient *client)
{
    if (!client)
        return;
    SluiceAllocationCallbacks cb = client->allocator;
    free_hosts(client);
    slc_http_cache_finish(&client->cache);
    curl_slist_free_all(client->headers);
    curl_slist_free_all(client->s3_headers);
    char *strings[] = {client->s3.endpoint,     client->s3.region,        client->s3.access_key,
                       client->s3.secret_key,   client->s3.session_token, client->signature,
                       client->certificate_file};
    for (size_t i = 0; i < sizeof strings / sizeof *strings; i++)
        free_string(client, strings[i]);
    slc_condition_finish(&client->cancelled);
    slc_mutex_finish(&client->mutex);
    slc_free(&cb, client, 1, sizeof *client);
}

void sluiceCancelHttpReads(SluiceHttpClient *client)
{
    if (!client)
        return;
    slc_mutex_lock(&client->mutex);
    atomic_store(&client->is_cancelled, true);
    slc_condition_broadcast(&client->cancelled);
    slc_mutex_unlock(&client->mutex);
}

SluiceResult sluiceGetHttpStatistics(SluiceHttpClient *client, SluiceHttpStatistics *pStatistics)
{
    if (!client || !pStatistics)
        return SLUICE_ERROR_NULL_POINTER;
    SluiceResult result =
        slc_struct_check(SLC_STRUCT(SluiceHttpStatistics), pStatistics, &client->log);
    if (result != SLUICE_SUCCESS)
        return result;
    struct slc_http_counts *c = &client->counts;
    slc_mutex_lock(&client->mutex);
    SluiceHttpStatistics statistics = {.connectionCount = client->connection_count,
                                       .requestsInFlight = client->in_flight,
                                       .waitingReadCount = client->waiting};
    slc_mutex_unlock(&client->mutex);
    statistics.requestTotal = atomic_load(&c->requests);
    statistics.connectTotal = atomic_load(&c->connects);
    statistics.retryTotal = atomic_load(&c->retries);
    statistics.failureTotal = atomic_load(&c->failures);
    statistics.refusedTotal = atomic_load(&c->refused);
    statistics.readTotal = atomic_load(&c->reads);
    statistics.joinedTotal = atomic_load(&c->joined);
    statistics.keptTotal = atomic_load(&c->kept);
    statistics.askedBytes = atomic_load(&c->asked);
    statistics.bodyBytes = atomic_load(&c->body);
    statistics.headerBytes = atomic_load(&c->header);
    statistics.cacheHitTotal = atomic_load(&client->cache.hits);
    statistics.cacheSize = atomic_load(&client->cache.size);
    slc_struct_write(SLC_STRUCT(SluiceHttpStatistics), pStatistics, &statistics);
    return SLUICE_SUCCESS;
}
