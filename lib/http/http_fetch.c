#include "http/http_fetch.h"

#include "base/checked.h"

#include <stdio.h>
#include <string.h>

#define MAX_REDIRECTS 5u

enum slc_http_verdict slc_http_verdict_of(const struct slc_http_answer *answer)
{
    if (answer->outcome == SLC_HTTP_CANCELLED || answer->result == SLUICE_ERROR_OUT_OF_HOST_MEMORY)
        return SLC_HTTP_UNKNOWN;
    return answer->outcome == SLC_HTTP_AGAIN && answer->is_host_fault ? SLC_HTTP_OUT_OF_ORDER
                                                                      : SLC_HTTP_IN_ORDER;
}

static void fail(struct slc_http_answer *answer, SluiceResult result, const char *why)
{
    answer->outcome = SLC_HTTP_FAILED;
    answer->result = result;
    snprintf(answer->why, sizeof answer->why, "%s", why);
}

/* Replaces `at` by the location in the answer. */
static bool follow(const struct slc_http_fetch *fetch, struct slc_http_url *at, bool was_secure,
                   struct slc_http_answer *answer)
{
    const SluiceHttpClient *client = fetch->client;
    const struct slc_s3_access none = {0};
    struct slc_http_url next;
    SluiceResult result =
        slc_http_url_parse(&next, answer->redirect, &none, &client->allocator, NULL);
    if (result == SLUICE_SUCCESS && was_secure && !slc_http_is_secure(&next)) {
        result = SLUICE_ERROR_IO;
        fail(answer, result, "the server redirects from https to http");
    } else if (result == SLUICE_ERROR_OUT_OF_HOST_MEMORY) {
        fail(answer, result, "no memory");
    } else if (result != SLUICE_SUCCESS) {
        result = SLUICE_ERROR_IO;
        fail(answer, result, "the server redirects to something that is no http or https URL");
    }
    if (result != SLUICE_SUCCESS) {
        slc_http_url_free(&next, &client->allocator);
        return false;
    }
    next.is_s3 = fetch->url->is_s3;
    slc_http_url_free(at, &client->allocator);
    *at = next;
    return true;
}

static struct slc_http_request make_request(const struct slc_http_fetch *fetch, CURL *easy,
                                            const struct slc_http_url *url)
{
    const struct slc_http_part *last = &fetch->parts[fetch->part_count - 1];
    return (struct slc_http_request){
        .client = fetch->client,
        .easy = easy,
        .url = url,
        .file = fetch->file,
        .is_own = slc_http_same_origin(url, fetch->url),
        .parts = fetch->parts,
        .part_count = fetch->part_count,
        .offset = fetch->parts[0].offset,
        .size = last->offset + last->size - fetch->parts[0].offset,
    };
}

/* Makes one attempt from `begin`, following redirects. `landed` (may be NULL) receives the final
 * URL, zeroed if there was no redirect. */
static void attempt_along(const struct slc_http_fetch *fetch, CURL *easy,
                          const struct slc_http_url *begin, struct slc_http_url *landed,
                          struct slc_http_answer *answer)
{
    struct slc_http_url at = {0};
    for (uint32_t hop = 0;; hop++) {
        const struct slc_http_url *url = hop == 0 ? begin : &at;
        struct slc_http_request request = make_request(fetch, easy, url);
        slc_http_attempt(&request, answer);
        if (answer->outcome != SLC_HTTP_OK || !answer->redirect)
            break;
        if (hop == MAX_REDIRECTS) {
            fail(answer, SLUICE_ERROR_IO, "more than 5 redirects");
            break;
        }
        if (!follow(fetch, &at, slc_http_is_secure(url), answer))
            break;
    }
    answer->redirect = NULL;
    if (landed && answer->outcome == SLC_HTTP_OK)
        *landed = at;
    else
        slc_http_url_free(&at, &fetch->client->allocator);
}

/* Makes an attempt at the target. If a redirect's target has expired, tries the opened URL. */
static void attempt(const struct slc_http_fetch *fetch, CURL *easy, struct slc_http_url *landed,
                    bool *is_moved, struct slc_http_answer *answer)
{
    if (fetch->target) {
        attempt_along(fetch, easy, fetch->target, NULL, answer);
        if (!answer->is_refused)
            return;
    }
    attempt_along(fetch, easy, fetch->url, landed, answer);
    *is_moved = answer->outcome == SLC_HTTP_OK;
}

static SluiceResult log_failure(const struct slc_http_fetch *fetch, uint32_t attempts,
                                const struct slc_http_answer *answer)
{
    char message[512];
    const struct slc_http_part *last = &fetch->parts[fetch->part_count - 1];
    if (answer->outcome == SLC_HTTP_CANCELLED || (fetch->is_check && answer->is_changed))
        return SLUICE_ERROR_IO;
    snprintf(message, sizeof message, "cannot read bytes %llu to %llu in %u attempt%s: %s",
             (unsigned long long)fetch->parts[0].offset,
             (unsigned long long)(last->offset + last->size - 1), attempts,
             attempts == 1 ? "" : "s", answer->why);
    slc_said_log(fetch->said, &fetch->client->log, fetch->url->shown, slc_said_key(answer->why),
                 message);
    return answer->result;
}

SluiceResult slc_http_fetch(const struct slc_http_fetch *fetch,
                            struct slc_http_connection *connection, uint32_t max_attempts,
                            struct slc_http_url *landed, bool *is_moved,
                            struct slc_http_answer *answer)
{
    SluiceHttpClient *client = fetch->client;
    const struct slc_http_settings *settings = &client->settings;
    uint64_t delay = settings->retry_delay;
    uint32_t done = 0;
    *is_moved = false;
    for (;;) {
        attempt(fetch, connection->easy, landed, is_moved, answer);
        done++;
        if (answer->outcome != SLC_HTTP_AGAIN || done == max_attempts ||
            answer->retry_after > settings->max_retry_delay)
            break;
        delay = slc_min_u64(delay, settings->max_retry_delay);
        if (!slc_http_pause(client, answer->retry_after, delay)) {
            answer->outcome = SLC_HTTP_CANCELLED;
            break;
        }
        atomic_fetch_add(&client->counts.retries, 1);
        delay *= 2;
    }
    if (answer->outcome == SLC_HTTP_OK)
        return SLUICE_SUCCESS;
    if (answer->outcome != SLC_HTTP_CANCELLED && !(fetch->is_check && answer->is_changed))
        atomic_fetch_add(&client->counts.failures, 1);
    return log_failure(fetch, done, answer);
}
