#include "http/http_url.h"

#include "base/alloc.h"
#include "base/log.h"

#include <curl/curl.h>
#include <stdio.h>
#include <string.h>

static void free_string(char **string, const SluiceAllocationCallbacks *cb)
{
    if (*string)
        slc_free(cb, *string, strlen(*string) + 1, 1);
    *string = NULL;
}

void slc_http_url_free(struct slc_http_url *url, const SluiceAllocationCallbacks *cb)
{
    free_string(&url->full, cb);
    free_string(&url->origin, cb);
    free_string(&url->shown, cb);
}

bool slc_http_same_origin(const struct slc_http_url *a, const struct slc_http_url *b)
{
    return strcmp(a->origin, b->origin) == 0;
}

bool slc_http_is_secure(const struct slc_http_url *url)
{
    return strncmp(url->origin, "https:", 6) == 0;
}

/* Copies a string of libcurl to the caller's memory, and frees the original. */
static char *take_part(char *part, const SluiceAllocationCallbacks *cb)
{
    char *copy = part ? slc_strdup(cb, part) : NULL;
    curl_free(part);
    return copy;
}

static char *get_part(CURLU *parts, CURLUPart part, unsigned flags)
{
    char *text = NULL;
    return curl_url_get(parts, part, &text, flags) == CURLUE_OK ? text : NULL;
}

/* Returns "SCHEME://HOST:PORT", allocated. */
static char *make_origin(CURLU *parts, const SluiceAllocationCallbacks *cb)
{
    char *scheme = get_part(parts, CURLUPART_SCHEME, 0), *host = get_part(parts, CURLUPART_HOST, 0);
    char *port = get_part(parts, CURLUPART_PORT, CURLU_DEFAULT_PORT);
    char *origin = NULL;
    if (scheme && host && port) {
        size_t size = strlen(scheme) + strlen(host) + strlen(port) + 5;
        origin = slc_alloc(cb, size, 1);
        if (origin)
            snprintf(origin, size, "%s://%s:%s", scheme, host, port);
    }
    curl_free(scheme);
    curl_free(host);
    curl_free(port);
    return origin;
}

static SluiceResult take_apart(struct slc_http_url *url, CURLU *parts, const char *text,
                               const SluiceAllocationCallbacks *cb, const SluiceLogCallback *log)
{
    CURLUcode code =
        curl_url_set(parts, CURLUPART_URL, text, CURLU_NON_SUPPORT_SCHEME | CURLU_PATH_AS_IS);
    if (code == CURLUE_OUT_OF_MEMORY)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    char *scheme = code == CURLUE_OK ? get_part(parts, CURLUPART_SCHEME, 0) : NULL;
    bool is_web = scheme && (strcmp(scheme, "http") == 0 || strcmp(scheme, "https") == 0);
    curl_free(scheme);
    if (!is_web)
        return slc_log_refusal(log, "a URL is no valid http://, https:// or s3:// URL: %s",
                               code == CURLUE_OK ? "its scheme is another"
                                                 : curl_url_strerror(code));
    curl_url_set(parts, CURLUPART_FRAGMENT, NULL, 0);
    url->full = take_part(get_part(parts, CURLUPART_URL, 0), cb);
    url->origin = make_origin(parts, cb);
    const CURLUPart secret[] = {CURLUPART_USER, CURLUPART_PASSWORD, CURLUPART_OPTIONS,
                                CURLUPART_QUERY};
    for (size_t i = 0; i < sizeof secret / sizeof *secret; i++)
        curl_url_set(parts, secret[i], NULL, 0);
    url->shown = take_part(get_part(parts, CURLUPART_URL, 0), cb);
    return url->full && url->origin && url->shown ? SLUICE_SUCCESS
                                                  : SLUICE_ERROR_OUT_OF_HOST_MEMORY;
}

static bool is_plain_in_keys(unsigned char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           strchr("/-_.~", c);
}

/* Appends an object's name, escaped for signatures: up to three bytes per byte. */
static void append_escaped(char *to, const char *key)
{
    to += strlen(to);
    for (; *key; key++) {
        if (is_plain_in_keys((unsigned char)*key))
            *to++ = *key;
        else
            to += sprintf(to, "%%%02X", (unsigned char)*key);
    }
    *to = '\0';
}

static SluiceResult parse_s3(struct slc_http_url *url, CURLU *parts, const char *name,
                             const struct slc_s3_access *s3, const SluiceAllocationCallbacks *cb,
                             const SluiceLogCallback *log)
{
    const char *slash = strchr(name, '/');
    if (!s3->endpoint)
        return slc_log_refusal(log, "s3://%s: SluiceHttpClientCreateInfo::pS3 is NULL", name);
    if (!slash || slash == name || !slash[1])
        return slc_log_refusal(log, "s3://%s: is not s3://BUCKET/KEY", name);
    size_t size = strlen(s3->endpoint) + 1 + 3 * strlen(name) + 1;
    char *text = slc_alloc(cb, size, 1);
    if (!text)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    size_t end = strlen(s3->endpoint);
    while (end > 0 && s3->endpoint[end - 1] == '/')
        end--;
    snprintf(text, size, "%.*s/", (int)end, s3->endpoint);
    append_escaped(text, name);
    SluiceResult result = take_apart(url, parts, text, cb, log);
    slc_free(cb, text, size, 1);
    url->is_s3 = true;
    return result;
}

SluiceResult slc_http_url_parse(struct slc_http_url *url, const char *text,
                                const struct slc_s3_access *s3, const SluiceAllocationCallbacks *cb,
                                const SluiceLogCallback *log)
{
    *url = (struct slc_http_url){0};
    CURLU *parts = curl_url();
    if (!parts)
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    SluiceResult result = strncmp(text, "s3://", 5) == 0
                              ? parse_s3(url, parts, text + 5, s3, cb, log)
                              : take_apart(url, parts, text, cb, log);
    curl_url_cleanup(parts);
    return result;
}
