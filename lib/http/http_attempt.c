#include "http/http_attempt.h"

#include "http/http_header.h"
#include "platform/pipe_signal.h"
#include "platform/time_now.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

/* Most bytes to read of an error's body, so that the connection stays usable. */
#define MAX_SWALLOWED ((uint64_t)64 << 10)
#define MAX_REDIRECT_BODY ((uint64_t)1 << 20)
#define MAX_RETRY_AFTER 86400 /* seconds */
#define MIN_SPEED 500u        /* bytes per second, over the stall time-out */

struct attempt {
    const struct slc_http_request *request;
    struct slc_http_answer *answer;
    struct slc_http_header header;
    uint64_t expected; ///< bytes of the body; valid if is_checked
    bool is_checked, is_accepted, is_stalled;
    curl_off_t last_count; ///< bytes of the body at the last sufficient progress
    uint64_t last_time;
};

#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
static void
end_as(struct attempt *attempt, enum slc_http_outcome outcome, SluiceResult result,
       const char *format, ...)
{
    struct slc_http_answer *answer = attempt->answer;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(answer->why, sizeof answer->why, format, arguments);
    va_end(arguments);
    answer->outcome = outcome;
    answer->result = result;
}

static void end_changed(struct attempt *attempt, const char *field)
{
    end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_IO,
           "the file was changed on the server (%s differs); open it again", field);
    attempt->answer->is_changed = true;
}

static bool is_transient(uint32_t status)
{
    return status == 408 || status == 425 || status == 429 || status == 500 || status == 502 ||
           status == 503 || status == 504;
}

/* Handles a status other than 200 and 206. */
static void check_status(struct attempt *attempt, uint32_t status)
{
    bool is_missing = status == 404 || status == 410;
    attempt->answer->is_refused = is_missing || status == 401 || status == 403;
    attempt->answer->is_host_fault = status == 429 || status == 503;
    if (is_transient(status))
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO, "the server answers %u", status);
    else if (is_missing)
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_FILE_NOT_FOUND, "the server answers %u",
               status);
    else if (status == 412)
        end_changed(attempt, "its ETag or date");
    else if (status == 416 && attempt->request->file)
        end_changed(attempt, "its size");
    else if (status == 416)
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_IO, "the file is empty");
    else if (status == 401 || status == 403)
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_IO,
               "the server answers %u; check user, password, keys and the machine's clock", status);
    else
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_IO, "the server answers %u", status);
}

/* Tells whether a status is a redirect. A redirect is no failure: the caller follows. */
static bool is_redirect(uint32_t status)
{
    return status == 301 || status == 302 || status == 303 || status == 307 || status == 308;
}

/* Checks that an answer names the version in the same way as at opening. */
static bool check_version(struct attempt *attempt)
{
    const SluiceHttpFile *file = attempt->request->file;
    const struct slc_http_header *header = &attempt->header;
    if (!file)
        return true;
    bool have_etags = file->etag[0] && header->etag[0];
    bool have_dates = file->modified[0] && header->modified[0];
    if (header->total_size != UINT64_MAX && header->total_size != file->size)
        end_changed(attempt, "its size");
    else if (have_etags && strcmp(file->etag, header->etag) != 0)
        end_changed(attempt, "its ETag");
    else if (!have_etags && have_dates && strcmp(file->modified, header->modified) != 0)
        end_changed(attempt, "its date");
    else if ((file->etag[0] || file->modified[0]) && !have_etags && !have_dates)
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO,
               "the answer tells no ETag and no date, and the opened file had one");
    return attempt->answer->outcome == SLC_HTTP_OK;
}

static void check_range(struct attempt *attempt)
{
    const struct slc_http_request *request = attempt->request;
    struct slc_http_header *header = &attempt->header;
    uint64_t end = request->offset + request->size;
    if (!header->has_range) {
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO, "the answer 206 lacks a Content-Range");
        return;
    }
    if (!request->file && header->total_size == UINT64_MAX) {
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_UNSUPPORTED,
               "the server does not tell the size of the file");
        return;
    }
    if (!check_version(attempt))
        return;
    if (!request->file && end > header->total_size)
        end = header->total_size;
    if (header->first != request->offset || header->last + 1 != end) {
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO,
               "the server sends bytes %llu to %llu, not %llu to %llu",
               (unsigned long long)header->first, (unsigned long long)header->last,
               (unsigned long long)request->offset, (unsigned long long)(end - 1));
        return;
    }
    attempt->expected = end - request->offset;
    attempt->is_accepted = true;
}

/* Checks an answer with the whole file, which a server may send for a small file at opening. */
static void check_whole(struct attempt *attempt)
{
    const struct slc_http_request *request = attempt->request;
    struct slc_http_header *header = &attempt->header;
    if (request->file && request->file->size > request->file->head_size) {
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO,
               "the server answers 200 with the whole file, not 206 with a range");
    } else if (header->length == 0) {
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_IO, "the file is empty");
    } else if (header->length > request->size) {
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_UNSUPPORTED,
               "the server ignores ranges: it answers 200 with the whole file");
    } else {
        header->total_size = header->length;
        attempt->expected = header->length;
        attempt->is_accepted = true;
    }
}

/* Judges an answer after its header. */
static void check_header(struct attempt *attempt)
{
    const struct slc_http_header *header = &attempt->header;
    if (attempt->is_checked)
        return;
    attempt->is_checked = true;
    if (is_redirect(header->status))
        return;
    if (header->status != 200 && header->status != 206)
        check_status(attempt, header->status);
    else if (header->is_encoded)
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_UNSUPPORTED,
               "the server compresses the file (Content-Encoding), so its bytes have no offsets");
    else if (header->status == 206)
        check_range(attempt);
    else
        check_whole(attempt);
}

/* Copies bytes, which begin at `at` in the file, to the parts that contain them. */
static void scatter(const struct slc_http_request *request, uint64_t at, const char *bytes,
                    size_t size)
{
    for (uint32_t i = 0; i < request->part_count; i++) {
        const struct slc_http_part *part = &request->parts[i];
        uint64_t first = part->offset > at ? part->offset : at;
        uint64_t end =
            part->offset + part->size < at + size ? part->offset + part->size : at + size;
        if (first < end)
            memcpy(part->bytes + (first - part->offset), bytes + (first - at),
                   (size_t)(end - first));
    }
}

/* Tells whether to read the body of an answer without the range: only if short. libcurl reports the
 * location of a redirect only after its body. */
static bool is_worth_reading(const struct attempt *attempt)
{
    uint64_t most = is_redirect(attempt->header.status) ? MAX_REDIRECT_BODY : MAX_SWALLOWED;
    uint64_t length = attempt->header.length;
    return attempt->answer->received <= most && (length == UINT64_MAX || length <= most);
}

static size_t write_body(char *bytes, size_t size, size_t count, void *user)
{
    struct attempt *attempt = user;
    struct slc_http_answer *answer = attempt->answer;
    size *= count;
    check_header(attempt);
    if (!attempt->is_accepted) {
        answer->received += size;
        return is_worth_reading(attempt) ? size : 0;
    }
    if (size > attempt->expected - answer->received) {
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO, "the body is longer than %llu bytes",
               (unsigned long long)attempt->expected);
        attempt->is_accepted = false;
        return 0;
    }
    scatter(attempt->request, attempt->request->offset + answer->received, bytes, size);
    answer->received += size;
    return size;
}

static size_t write_header(char *line, size_t size, size_t count, void *user)
{
    struct attempt *attempt = user;
    if (!attempt->is_checked) /* otherwise the line is a trailer behind the body */
        slc_http_header_line(&attempt->header, line, size * count);
    return size * count;
}

/* Returns the bytes that must arrive within the stall time-out. A limit of 1 would allow hours. */
static curl_off_t least_count(const SluiceHttpClient *client)
{
    curl_off_t count = (curl_off_t)client->settings.stall_timeout * MIN_SPEED / 1000;
    return count > 0 ? count : 1;
}

/* Checks progress at least once a second. libcurl's speed limit is a mean over five seconds. */
static int progress(void *user, curl_off_t a, curl_off_t received, curl_off_t b, curl_off_t c)
{
    struct attempt *attempt = user;
    const SluiceHttpClient *client = attempt->request->client;
    uint64_t now = slc_monotonic_time();
    (void)a, (void)b, (void)c;
    if (received - attempt->last_count >= least_count(client) || attempt->last_time == 0) {
        attempt->last_count = received;
        attempt->last_time = now;
    }
    attempt->is_stalled =
        now - attempt->last_time >= (uint64_t)client->settings.stall_timeout * 1000000;
    return attempt->is_stalled || atomic_load(&client->is_cancelled);
}

/* Tells whether a failure of libcurl would repeat. */
static bool is_lasting(CURLcode code)
{
    return code == CURLE_PEER_FAILED_VERIFICATION || code == CURLE_SSL_CACERT_BADFILE ||
           code == CURLE_URL_MALFORMAT || code == CURLE_UNKNOWN_OPTION ||
           code == CURLE_NOT_BUILT_IN || code == CURLE_SSL_CERTPROBLEM ||
           code == CURLE_SSL_ENGINE_NOTFOUND;
}

static void check_failure(struct attempt *attempt, CURLcode code, const char *text)
{
    struct slc_http_answer *answer = attempt->answer;
    if (code == CURLE_ABORTED_BY_CALLBACK && attempt->is_stalled) {
        answer->is_host_fault = true;
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO, "fewer than %llu bytes came in %u ms",
               (unsigned long long)least_count(attempt->request->client),
               attempt->request->client->settings.stall_timeout);
    } else if (code == CURLE_ABORTED_BY_CALLBACK) {
        answer->outcome = SLC_HTTP_CANCELLED;
        answer->result = SLUICE_ERROR_IO;
    } else if (code == CURLE_WRITE_ERROR) {
        if (answer->outcome == SLC_HTTP_OK)
            end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_IO,
                   "the server redirects with a body of more than 1 MiB");
    } else if (code == CURLE_OUT_OF_MEMORY) {
        end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_OUT_OF_HOST_MEMORY, "libcurl: no memory");
    } else {
        const char *words = text[0] ? text : curl_easy_strerror(code);
        bool is_cut = code == CURLE_PARTIAL_FILE || code == CURLE_GOT_NOTHING;
        answer->is_host_fault = !is_cut && !is_lasting(code);
        end_as(attempt, is_lasting(code) ? SLC_HTTP_FAILED : SLC_HTTP_AGAIN, SLUICE_ERROR_IO, "%s",
               words);
    }
}

static void check_end(struct attempt *attempt)
{
    struct slc_http_answer *answer = attempt->answer;
    check_header(attempt); /* for an answer without a body */
    if (!attempt->is_accepted || answer->outcome != SLC_HTTP_OK)
        return;
    if (answer->received != attempt->expected)
        end_as(attempt, SLC_HTTP_AGAIN, SLUICE_ERROR_IO, "the body ends after %llu of %llu bytes",
               (unsigned long long)answer->received, (unsigned long long)attempt->expected);
}

/* Tells whether a version is too new to be identified by its date: dates have whole seconds. */
static bool is_fresh(const struct slc_http_header *header)
{
    time_t modified = header->modified[0] ? curl_getdate(header->modified, NULL) : -1;
    time_t date = header->date[0] ? curl_getdate(header->date, NULL) : -1;
    return modified != -1 && date != -1 && date - modified < 2;
}

static void take_version(struct attempt *attempt)
{
    struct slc_http_version *version = &attempt->answer->version;
    version->size = attempt->header.total_size;
    memcpy(version->etag, attempt->header.etag, sizeof version->etag);
    memcpy(version->modified, attempt->header.modified, sizeof version->modified);
    version->is_fresh = !attempt->request->file && is_fresh(&attempt->header);
}

/* Returns the header line that asks for the opened version only. Weak ETags never match. */
static struct curl_slist *condition_header(const struct slc_http_request *request,
                                           struct curl_slist *list)
{
    char line[300];
    const SluiceHttpFile *file = request->file;
    if (!file || (!file->etag[0] && !file->modified[0]))
        return list;
    if (file->etag[0] == '"')
        snprintf(line, sizeof line, "If-Match: %s", file->etag);
    else if (file->modified[0])
        snprintf(line, sizeof line, "If-Unmodified-Since: %s", file->modified);
    else
        return list;
    return curl_slist_append(list, line);
}

static struct curl_slist *make_headers(const struct slc_http_request *request)
{
    const SluiceHttpClient *client = request->client;
    struct curl_slist *list = curl_slist_append(NULL, "Accept-Encoding: identity");
    struct curl_slist *grown = list ? condition_header(request, list) : NULL;
    for (const struct curl_slist *line = client->headers; grown && request->is_own && line;
         line = line->next)
        grown = curl_slist_append(list, line->data);
    for (const struct curl_slist *line = client->s3_headers;
         grown && request->is_own && request->url->is_s3 && line; line = line->next)
        grown = curl_slist_append(list, line->data);
    if (!grown)
        curl_slist_free_all(list);
    return grown;
}

/* Sets URL, credentials and certificates. The caller must not send after a failure: a password
 * could be sent in clear text, or a wrong certificate be trusted. */
static CURLcode set_target(CURL *easy, const struct slc_http_request *request, const char *range)
{
    const SluiceHttpClient *client = request->client;
    CURLcode code = curl_easy_setopt(easy, CURLOPT_URL, request->url->full);
    if (code == CURLE_OK)
        code = curl_easy_setopt(easy, CURLOPT_RANGE, range);
    if (code == CURLE_OK && client->certificate_file)
        code = curl_easy_setopt(easy, CURLOPT_CAINFO, client->certificate_file);
    if (code != CURLE_OK || !request->is_own || !request->url->is_s3 || !client->signature)
        return code;
    code = curl_easy_setopt(easy, CURLOPT_AWS_SIGV4, client->signature);
    if (code == CURLE_OK)
        code = curl_easy_setopt(easy, CURLOPT_USERNAME, client->s3.access_key);
    if (code == CURLE_OK)
        code = curl_easy_setopt(easy, CURLOPT_PASSWORD, client->s3.secret_key);
    return code;
}

static CURLcode set_options(struct attempt *attempt, struct curl_slist *headers, char *error)
{
    const struct slc_http_request *request = attempt->request;
    const SluiceHttpClient *client = request->client;
    CURL *easy = request->easy;
    char range[64];
    snprintf(range, sizeof range, "%llu-%llu", (unsigned long long)request->offset,
             (unsigned long long)(request->offset + request->size - 1));
    curl_easy_reset(easy);
    curl_easy_setopt(easy, CURLOPT_HTTPHEADER, headers);
    curl_easy_setopt(easy, CURLOPT_PATH_AS_IS, 1L);
    curl_easy_setopt(easy, CURLOPT_HTTP_VERSION, (long)CURL_HTTP_VERSION_1_1);
    curl_easy_setopt(easy, CURLOPT_NOSIGNAL, 1L);
#if LIBCURL_VERSION_NUM >= 0x075700
    curl_easy_setopt(easy, CURLOPT_QUICK_EXIT, 1L); /* do not wait for a pending DNS lookup */
#endif
    curl_easy_setopt(easy, CURLOPT_CONNECTTIMEOUT_MS, (long)client->settings.connect_timeout);
    curl_easy_setopt(easy, CURLOPT_ERRORBUFFER, error);
    curl_easy_setopt(easy, CURLOPT_WRITEFUNCTION, write_body);
    curl_easy_setopt(easy, CURLOPT_WRITEDATA, attempt);
    curl_easy_setopt(easy, CURLOPT_HEADERFUNCTION, write_header);
    curl_easy_setopt(easy, CURLOPT_HEADERDATA, attempt);
    curl_easy_setopt(easy, CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(easy, CURLOPT_XFERINFOFUNCTION, progress);
    curl_easy_setopt(easy, CURLOPT_XFERINFODATA, attempt);
    curl_easy_setopt(easy, CURLOPT_BUFFERSIZE, 128L << 10);
    return set_target(easy, request, range);
}

static void count(SluiceHttpClient *client, CURL *easy)
{
    long connects = 0, header = 0;
    curl_off_t body = 0;
    curl_easy_getinfo(easy, CURLINFO_NUM_CONNECTS, &connects);
    curl_easy_getinfo(easy, CURLINFO_HEADER_SIZE, &header);
    curl_easy_getinfo(easy, CURLINFO_SIZE_DOWNLOAD_T, &body);
    atomic_fetch_add(&client->counts.requests, 1);
    atomic_fetch_add(&client->counts.connects, (uint64_t)connects);
    atomic_fetch_add(&client->counts.header, (uint64_t)header);
    atomic_fetch_add(&client->counts.body, (uint64_t)body);
}

static void take_answer(struct attempt *attempt, CURL *easy)
{
    struct slc_http_answer *answer = attempt->answer;
    curl_off_t seconds = 0;
    curl_easy_getinfo(easy, CURLINFO_RETRY_AFTER, &seconds);
    if (seconds > MAX_RETRY_AFTER)
        seconds = MAX_RETRY_AFTER;
    answer->retry_after = seconds > 0 ? (uint64_t)seconds * 1000 : 0;
    if (answer->outcome == SLC_HTTP_OK && !attempt->is_accepted) {
        curl_easy_getinfo(easy, CURLINFO_REDIRECT_URL, &answer->redirect);
        if (!answer->redirect)
            end_as(attempt, SLC_HTTP_FAILED, SLUICE_ERROR_IO,
                   "the server answers %u without a place to go to", attempt->header.status);
    }
    take_version(attempt);
}

void slc_http_attempt(const struct slc_http_request *request, struct slc_http_answer *answer)
{
    char error[CURL_ERROR_SIZE] = "";
    struct slc_pipe_signal pipes;
    struct attempt attempt = {.request = request, .answer = answer};
    *answer = (struct slc_http_answer){.outcome = SLC_HTTP_OK};
    slc_http_header_begin(&attempt.header);
    struct curl_slist *headers = make_headers(request);
    if (!headers) {
        end_as(&attempt, SLC_HTTP_FAILED, SLUICE_ERROR_OUT_OF_HOST_MEMORY, "libcurl: no memory");
        return;
    }
    CURLcode code = set_options(&attempt, headers, error);
    if (code == CURLE_OK) {
        /* libcurl leaves the signal alone with CURLOPT_NOSIGNAL, and OpenSSL raises it. */
        slc_pipe_signal_block(&pipes);
        code = curl_easy_perform(request->easy);
        slc_pipe_signal_restore(&pipes);
        count(request->client, request->easy);
    }
    if (code == CURLE_OK)
        check_end(&attempt);
    else
        check_failure(&attempt, code, error);
    take_answer(&attempt, request->easy);
    curl_easy_setopt(request->easy, CURLOPT_ERRORBUFFER, NULL);
    curl_easy_setopt(request->easy, CURLOPT_HTTPHEADER, NULL);
    curl_slist_free_all(headers);
}
