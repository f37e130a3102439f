/* Files on a web server that delays, truncates and falsifies on request: faulty_server.py. */
#define _XOPEN_SOURCE 700

#include "base/alloc.h"
#include "base/shown_url.h"
#include "http/web_server.h"
#include "support/failing_allocator.h"
#include "support/test.h"

#include <sluice/http.h>

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define DEFAULT_SIZE ((uint64_t)1 << 20)
#define READ_AT ((uint64_t)500000) /* behind the part that opening keeps */
#define READ_SIZE ((size_t)65536)
#define KEPT_SIZE (READ_SIZE + 256) /* at most, in the cache folder */

static char logged[4096];
static pthread_mutex_t log_mutex = PTHREAD_MUTEX_INITIALIZER;

static void log_message(void *user, SluiceLogSeverity severity, const char *message)
{
    (void)user, (void)severity;
    pthread_mutex_lock(&log_mutex);
    size_t used = strlen(logged);
    snprintf(logged + used, sizeof logged - used, "%s\n", message);
    pthread_mutex_unlock(&log_mutex);
}

static unsigned char content(uint64_t i)
{
    return (unsigned char)((i * 2654435761u) >> 13);
}

static bool is_content(const unsigned char *bytes, uint64_t offset, size_t size)
{
    for (size_t i = 0; i < size; i++)
        if (bytes[i] != content(offset + i))
            return false;
    return true;
}

/* Settings with short delays, so that tests do not wait. */
static SluiceHttpClientCreateInfo quick(void)
{
    logged[0] = '\0';
    return (SluiceHttpClientCreateInfo){.structSize = sizeof(SluiceHttpClientCreateInfo),
                                        .maxAttemptCount = 3,
                                        .retryDelay = 2,
                                        .maxRetryDelay = 20,
                                        .stallTimeout = 1000,
                                        .log = {NULL, log_message}};
}

static SluiceHttpClient *create(const SluiceHttpClientCreateInfo *info)
{
    SluiceHttpClient *client = NULL;
    CHECK_OK(sluiceCreateHttpClient(info, &client));
    return client;
}

/* Valid until the next call. */
static const char *path_url(const char *path)
{
    static char url[512];
    snprintf(url, sizeof url, "http://127.0.0.1:%u/%s", web_server.ports[0], path);
    return url;
}

static SluiceResult open_path(SluiceHttpClient *client, const char *path, SluiceHttpFile **file)
{
    *file = NULL;
    return sluiceOpenHttpFile(client, path_url(path), file);
}

static SluiceInput input_of(SluiceHttpFile *file)
{
    SluiceInput input = {.structSize = sizeof input};
    CHECK_OK(sluiceGetHttpInput(file, &input));
    return input;
}

static SluiceResult read_at(SluiceHttpFile *file, uint64_t offset, size_t size)
{
    unsigned char *bytes = calloc(1, size);
    SluiceInput input = input_of(file);
    SluiceResult result = input.pfnRead(input.pUserData, offset, bytes, size);
    if (result == SLUICE_SUCCESS && !is_content(bytes, offset, size))
        fail_msg("wrong bytes at %llu", (unsigned long long)offset);
    free(bytes);
    return result;
}

static SluiceHttpStatistics statistics_of(SluiceHttpClient *client)
{
    SluiceHttpStatistics statistics = {.structSize = sizeof statistics};
    CHECK_OK(sluiceGetHttpStatistics(client, &statistics));
    return statistics;
}

/* Opens a path, reads once behind the head, and closes it. */
static SluiceResult read_path(const char *path, SluiceHttpStatistics *statistics)
{
    SluiceHttpClientCreateInfo info = quick();
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    SluiceResult result = open_path(client, path, &file);
    if (result == SLUICE_SUCCESS)
        result = read_at(file, READ_AT, READ_SIZE);
    *statistics = statistics_of(client);
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
    return result;
}

static void any_range_has_the_bytes_of_the_file(void **state)
{
    SluiceHttpClientCreateInfo info = quick();
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "plain/ranges", &file));
    assert_int_equal(input_of(file).size, DEFAULT_SIZE);
    const uint64_t edges[] = {0, 1, 131071, 131072, 131073, 300001, DEFAULT_SIZE - 1};
    for (size_t i = 0; i < sizeof edges / sizeof *edges; i++)
        for (size_t size = 1; size <= 70000 && edges[i] + size <= DEFAULT_SIZE; size *= 13)
            CHECK_OK(read_at(file, edges[i], size));
    CHECK_RESULT(read_at(file, DEFAULT_SIZE - 1, 2), SLUICE_ERROR_INVALID_ARGUMENT);
    SluiceHttpStatistics statistics = statistics_of(client);
    assert_int_equal(statistics.connectTotal, 1);
    assert_int_equal(statistics.keptTotal + statistics.requestTotal - 1, statistics.readTotal);
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

/* The first requests of a read fail. A later one succeeds. */
static void faults_that_pass_cost_attempts_alone(void **state)
{
    static const char *const faults[] = {"status-500", "status-502", "status-503", "status-504",
                                         "status-429", "status-408", "cut",        "short",
                                         "long",       "reset",      "shifted",    "norange",
                                         "whole",      "garbage"};
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        char path[128];
        SluiceHttpStatistics statistics;
        snprintf(path, sizeof path, "%s/passing?from=1&count=2", faults[i]);
        SluiceResult result = read_path(path, &statistics);
        /* libcurl repeats a request by itself if a kept connection turns out to be closed. */
        uint64_t by_curl = strcmp(faults[i], "reset") == 0 ? 1 : 0;
        if (result != SLUICE_SUCCESS || statistics.retryTotal != 2 - by_curl)
            fail_msg("%s: %s after %u retries: %s", faults[i], sluiceGetResultName(result),
                     (unsigned)statistics.retryTotal, logged);
        assert_string_equal(logged, "");
    }
}

static void faults_that_stay_are_io_and_name_url_and_range(void **state)
{
    static const struct {
        const char *fault, *words;
        uint32_t retries;
    } rows[] = {
        {"status-503", "3 attempts: the server answers 503", 2},
        {"status-403", "1 attempt: the server answers 403", 0},
        {"status-404", "1 attempt: the server answers 404", 0},
        {"status-418", "1 attempt: the server answers 418", 0},
        {"cut", "bytes remaining", 2},
        {"short", "the body ends after 32767 of 65536 bytes", 2},
        {"long", "the body is longer than 65536 bytes", 2},
        {"shifted", "the server sends bytes 500001 to 565536, not 500000 to 565535", 2},
        {"norange", "lacks a Content-Range", 2},
        {"whole", "200 with the whole file", 2},
        {"gzip", "Content-Encoding", 0},
        {"untagged", "tells no ETag and no date", 2},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char path[128];
        SluiceHttpStatistics statistics;
        snprintf(path, sizeof path, "%s/staying?from=1&secret=x", rows[i].fault);
        CHECK_RESULT(read_path(path, &statistics), SLUICE_ERROR_IO);
        if (!strstr(logged, rows[i].words) || !strstr(logged, "/staying: ") ||
            !strstr(logged, "500000 to 565535") || strstr(logged, "secret"))
            fail_msg("%s: %s", rows[i].fault, logged);
        assert_int_equal(statistics.retryTotal, rows[i].retries);
        assert_int_equal(statistics.failureTotal, 1);
    }
}

static void opening_tells_what_is_wrong_with_the_server(void **state)
{
    static const struct {
        const char *path, *words;
        SluiceResult result;
    } rows[] = {
        {"status-404/x", "answers 404", SLUICE_ERROR_FILE_NOT_FOUND},
        {"status-410/x", "answers 410", SLUICE_ERROR_FILE_NOT_FOUND},
        {"status-401/x", "check user, password", SLUICE_ERROR_IO},
        {"plain/empty?size=0", "is empty", SLUICE_ERROR_IO},
        {"whole/x", "ignores ranges", SLUICE_ERROR_UNSUPPORTED},
        {"star/x", "does not tell the size", SLUICE_ERROR_UNSUPPORTED},
        {"redirect-loop/x", "more than 5 redirects", SLUICE_ERROR_IO},
        {"redirect-file/x", "no http or https URL", SLUICE_ERROR_IO},
        {"reset/x", "3 attempts", SLUICE_ERROR_IO},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        SluiceHttpStatistics statistics;
        CHECK_RESULT(read_path(rows[i].path, &statistics), rows[i].result);
        if (!strstr(logged, rows[i].words))
            fail_msg("%s: %s", rows[i].path, logged);
    }
}

static void a_small_file_may_come_whole_or_shorter_than_asked(void **state)
{
    static const char *const paths[] = {"plain/small?size=1000", "whole/small?size=1000"};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        SluiceHttpClientCreateInfo info = quick();
        SluiceHttpClient *client = create(&info);
        SluiceHttpFile *file;
        CHECK_OK(open_path(client, paths[i], &file));
        assert_int_equal(input_of(file).size, 1000);
        CHECK_OK(read_at(file, 0, 1000));
        assert_int_equal(statistics_of(client).requestTotal, 1);
        sluiceDestroyHttpFile(file);
        sluiceDestroyHttpClient(client);
    }
}

static void a_changed_file_is_never_mixed_with_its_old_version(void **state)
{
    static const char *const paths[] = {"etag/strict?from=2", "etag/careless?from=2&careless=1",
                                        "size/x?from=2", "dated/x?late=2", "status-412/x?from=2"};
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        SluiceHttpClientCreateInfo info = quick();
        SluiceHttpClient *client = create(&info);
        SluiceHttpFile *file;
        CHECK_OK(open_path(client, paths[i], &file));
        CHECK_OK(read_at(file, READ_AT, READ_SIZE));
        CHECK_RESULT(read_at(file, READ_AT, READ_SIZE), SLUICE_ERROR_IO);
        if (!strstr(logged, "changed on the server"))
            fail_msg("%s: %s", paths[i], logged);
        uint64_t asked = statistics_of(client).requestTotal;
        CHECK_RESULT(read_at(file, READ_AT, READ_SIZE), SLUICE_ERROR_IO);
        CHECK_RESULT(read_at(file, 0, 10), SLUICE_ERROR_IO);
        assert_int_equal(statistics_of(client).requestTotal, asked);
        sluiceDestroyHttpFile(file);
        sluiceDestroyHttpClient(client);
    }
}

/* Each check makes a request, although the byte is in memory. A change of the file logs no
 * message. */
static void a_check_says_whether_the_file_was_changed(void **state)
{
    static const char *const paths[] = {"etag/checked?from=3", "size/checked?from=3",
                                        "dated/checked?late=3"};
    (void)state;
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        SluiceHttpClientCreateInfo info = quick();
        SluiceHttpClient *client = create(&info);
        SluiceInput input = {.structSize = sizeof input};
        void *opened;
        CHECK_OK(sluiceOpenHttpPath(client, path_url(paths[i]), &input, &opened));
        CHECK_OK(sluiceCheckHttpPath(client, opened));
        CHECK_OK(sluiceCheckHttpPath(client, opened));
        CHECK_RESULT(sluiceCheckHttpPath(client, opened), SLUICE_ERROR_IO);
        assert_int_equal(statistics_of(client).requestTotal, 4);
        assert_int_equal(statistics_of(client).failureTotal, 0);
        CHECK_RESULT(sluiceCheckHttpPath(client, opened), SLUICE_ERROR_IO);
        assert_int_equal(statistics_of(client).requestTotal, 4);
        assert_string_equal(logged, "");
        sluiceCloseHttpPath(client, opened);
        sluiceDestroyHttpClient(client);
    }
}

/* Another version may have the size of the opened one. */
static void a_check_cannot_tell_where_the_server_tells_no_version(void **state)
{
    (void)state;
    SluiceHttpClientCreateInfo info = quick();
    SluiceHttpClient *client = create(&info);
    SluiceInput input = {.structSize = sizeof input};
    void *opened;
    CHECK_OK(sluiceOpenHttpPath(client, path_url("untagged/x"), &input, &opened));
    CHECK_RESULT(sluiceCheckHttpPath(client, opened), SLUICE_ERROR_UNSUPPORTED);
    assert_int_equal(statistics_of(client).requestTotal, 2);
    sluiceCloseHttpPath(client, opened);
    sluiceDestroyHttpClient(client);
}

static void headers_of_the_application_stay_with_its_host(void **state)
{
    const char *lines[] = {"X-Key: secret"};
    SluiceHttpClientCreateInfo info = quick();
    info.ppHeaders = lines;
    info.headerCount = 1;
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "key/x", &file));
    CHECK_OK(read_at(file, READ_AT, READ_SIZE));
    sluiceDestroyHttpFile(file);
    CHECK_OK(open_path(client, "redirect-away/x", &file)); /* 400 if they came along */
    CHECK_OK(read_at(file, READ_AT, READ_SIZE));
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

static void a_redirect_may_have_a_body_of_unknown_length(void **state)
{
    SluiceHttpStatistics statistics;
    (void)state;
    CHECK_OK(read_path("redirect-chunked/x", &statistics));
    assert_int_equal(statistics.connectTotal, 1);
}

static void names_in_messages_have_no_password_and_no_query(void **state)
{
    static const char *const rows[][2] = {
        {"https://u:p@h:1/a/b.store?X-Amz-Signature=s#f", "https://h:1/a/b.store"},
        {"https://h/a@b?x", "https://h/a@b"},
        {"http://u@h", "http://h"},
        {"/folder/file?@#", "/folder/file?@#"}};
    SluiceAllocationCallbacks cb = slc_allocator(NULL);
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *shown = slc_shown_url(&cb, rows[i][0]);
        assert_string_equal(shown, rows[i][1]);
        slc_free(&cb, shown, strlen(shown) + 1, 1);
    }
}

static void a_redirect_is_followed_once_and_again_when_its_target_is_gone(void **state)
{
    SluiceHttpClientCreateInfo info = quick();
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "redirect-here/x", &file));
    assert_int_equal(statistics_of(client).requestTotal, 2);
    CHECK_OK(read_at(file, READ_AT, READ_SIZE));
    assert_int_equal(statistics_of(client).requestTotal, 3);
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

/* Each target answers two requests, then 403. */
static void reads_go_to_the_new_target_when_the_old_one_has_expired(void **state)
{
    SluiceHttpClientCreateInfo info = quick();
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "redirect-expiring/x", &file));
    const uint64_t requests[] = {3, 6, 7, 10, 11};
    for (size_t i = 0; i < sizeof requests / sizeof *requests; i++) {
        CHECK_OK(read_at(file, READ_AT, READ_SIZE));
        assert_int_equal(statistics_of(client).requestTotal, requests[i]);
    }
    assert_string_equal(logged, "");
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

static void a_host_that_is_down_is_left_alone_until_its_back_off_has_passed(void **state)
{
    SluiceHttpClientCreateInfo info = quick();
    info.retryDelay = 200;
    info.maxRetryDelay = 200;
    info.maxAttemptCount = 1;
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "status-503/down?from=1&count=1", &file));
    CHECK_RESULT(read_at(file, READ_AT, READ_SIZE), SLUICE_ERROR_IO);
    uint64_t asked = statistics_of(client).requestTotal;
    for (int i = 0; i < 5; i++)
        CHECK_RESULT(read_at(file, READ_AT, READ_SIZE), SLUICE_ERROR_IO);
    assert_int_equal(statistics_of(client).requestTotal, asked);
    assert_int_equal(statistics_of(client).refusedTotal, 5);
    nanosleep(&(struct timespec){0, 210000000}, NULL);
    CHECK_OK(read_at(file, READ_AT, READ_SIZE));
    CHECK_OK(read_at(file, READ_AT, READ_SIZE));
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

static uint64_t milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000 + (uint64_t)now.tv_nsec / 1000000;
}

static void retry_after_is_obeyed_up_to_the_limit(void **state)
{
    SluiceHttpClientCreateInfo info = quick();
    info.maxRetryDelay = 1500;
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "status-429/one?from=1&count=1&after=1", &file));
    uint64_t begin = milliseconds();
    CHECK_OK(read_at(file, READ_AT, READ_SIZE));
    assert_true(milliseconds() - begin >= 1000);
    sluiceDestroyHttpFile(file);
    CHECK_OK(open_path(client, "status-503/long?from=1&count=1&after=100", &file));
    CHECK_RESULT(read_at(file, READ_AT, READ_SIZE), SLUICE_ERROR_IO);
    assert_int_equal(statistics_of(client).retryTotal, 1);
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

static void a_body_that_stalls_is_given_up(void **state)
{
    SluiceHttpStatistics statistics;
    (void)state;
    CHECK_OK(read_path("stall/x?from=1&count=1", &statistics));
    assert_int_equal(statistics.retryTotal, 1);
    assert_int_equal(statistics.connectTotal, 2);
}

static void a_body_that_drips_is_given_up(void **state)
{
    SluiceHttpStatistics statistics;
    (void)state;
    CHECK_OK(read_path("drip/x?from=1&count=1", &statistics)); /* 50 bytes per second */
    assert_int_equal(statistics.retryTotal, 1);
}

struct reader {
    pthread_t thread;
    SluiceHttpFile *file;
    uint64_t offset;
    SluiceResult result;
};

static void *read_on_thread(void *argument)
{
    struct reader *reader = argument;
    unsigned char *bytes = malloc(READ_SIZE);
    SluiceInput input = {.structSize = sizeof input};
    reader->result = sluiceGetHttpInput(reader->file, &input);
    if (reader->result == SLUICE_SUCCESS)
        reader->result = input.pfnRead(input.pUserData, reader->offset, bytes, READ_SIZE);
    if (reader->result == SLUICE_SUCCESS && !is_content(bytes, reader->offset, READ_SIZE))
        reader->result = SLUICE_ERROR_CORRUPT_DATA;
    free(bytes);
    return NULL;
}

static void start_readers(struct reader *readers, uint32_t count, SluiceHttpFile *file)
{
    for (uint32_t i = 0; i < count; i++) {
        readers[i] = (struct reader){.file = file, .offset = (uint64_t)(3 + i * 7 % count) << 16};
        assert_int_equal(pthread_create(&readers[i].thread, NULL, read_on_thread, &readers[i]), 0);
    }
}

static void join_readers(struct reader *readers, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        pthread_join(readers[i].thread, NULL);
}

static void reads_that_wait_side_by_side_share_requests(void **state)
{
    struct reader readers[12];
    SluiceHttpClientCreateInfo info = quick();
    info.maxConnectionsPerHost = 1;
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "plain/joined?slow=0.05", &file));
    start_readers(readers, 12, file);
    join_readers(readers, 12);
    for (int i = 0; i < 12; i++)
        CHECK_OK(readers[i].result);
    SluiceHttpStatistics statistics = statistics_of(client);
    assert_true(statistics.joinedTotal >= 4);
    assert_int_equal(statistics.joinedTotal + statistics.requestTotal - 1, 12);
    assert_int_equal(statistics.connectionCount, 1);
    assert_int_equal(statistics.requestsInFlight + statistics.waitingReadCount, 0);
    assert_int_equal(statistics.bodyBytes, 131072 + 12 * READ_SIZE);
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

static void connections_are_bounded_and_failures_reach_every_reader(void **state)
{
    struct reader readers[12];
    SluiceHttpClientCreateInfo info = quick();
    info.maxConnectionsPerHost = 3;
    info.maxJoinedSize = 1;
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "plain/many?slow=0.01", &file));
    start_readers(readers, 12, file);
    join_readers(readers, 12);
    for (int i = 0; i < 12; i++)
        CHECK_OK(readers[i].result);
    assert_int_equal(statistics_of(client).connectionCount, 3);
    assert_int_equal(statistics_of(client).joinedTotal, 0);
    sluiceDestroyHttpFile(file);
    CHECK_OK(open_path(client, "cut/many?from=1", &file));
    start_readers(readers, 12, file);
    join_readers(readers, 12);
    for (int i = 0; i < 12; i++)
        CHECK_RESULT(readers[i].result, SLUICE_ERROR_IO);
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

static void cancelling_ends_reads_under_way_and_those_that_wait(void **state)
{
    struct reader readers[4];
    SluiceHttpClientCreateInfo info = quick();
    info.maxConnectionsPerHost = 2;
    info.maxJoinedSize = 1;
    info.stallTimeout = 15000;
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    CHECK_OK(open_path(client, "stall/cancelled?from=1", &file));
    start_readers(readers, 4, file);
    while (statistics_of(client).requestsInFlight < 2 || statistics_of(client).waitingReadCount < 2)
        nanosleep(&(struct timespec){0, 1000000}, NULL);
    uint64_t begin = milliseconds();
    sluiceCancelHttpReads(client);
    join_readers(readers, 4);
    assert_true(milliseconds() - begin < 5000); /* far from the stall's end */
    for (int i = 0; i < 4; i++)
        CHECK_RESULT(readers[i].result, SLUICE_ERROR_IO);
    CHECK_RESULT(read_at(file, READ_AT, READ_SIZE), SLUICE_ERROR_IO);
    assert_string_equal(logged, "");
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
}

static void certificates_are_checked(void **state)
{
    char url[128];
    SluiceHttpFile *file;
    (void)state;
    if (!web_server.ports[2])
        SKIP_TEST("the program openssl is missing");
    snprintf(url, sizeof url, "https://127.0.0.1:%u/plain/x", web_server.ports[2]);
    for (int is_trusted = 0; is_trusted < 2; is_trusted++) {
        SluiceHttpClientCreateInfo info = quick();
        info.pCertificateFile = is_trusted ? web_server.certificate : NULL;
        SluiceHttpClient *client = create(&info);
        SluiceResult result = sluiceOpenHttpFile(client, url, &file);
        CHECK_RESULT(result, is_trusted ? SLUICE_SUCCESS : SLUICE_ERROR_IO);
        if (is_trusted) {
            CHECK_OK(read_at(file, READ_AT, READ_SIZE));
            sluiceDestroyHttpFile(file);
        } else {
            assert_non_null(strstr(logged, "certificate"));
            assert_int_equal(statistics_of(client).retryTotal, 0);
        }
        sluiceDestroyHttpClient(client);
    }
}

static void objects_are_asked_for_with_signatures_that_a_server_accepts(void **state)
{
    static const struct {
        const char *secret, *key;
        SluiceResult result;
    } rows[] = {{"test/secret", "a/b c+d.store", SLUICE_SUCCESS},
                {"test/secret", "colon:and=\xc3\xa9.store", SLUICE_SUCCESS},
                {"wrong", "a/b.store", SLUICE_ERROR_IO}};
    char endpoint[64], url[128];
    (void)state;
    snprintf(endpoint, sizeof endpoint, "http://127.0.0.1:%u/", web_server.ports[0]);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        SluiceS3Access access = {.structSize = sizeof access,
                                 .pEndpoint = endpoint,
                                 .pRegion = "mars-1",
                                 .pAccessKey = "test:access",
                                 .pSecretKey = rows[i].secret,
                                 .pSessionToken = "token-1"};
        SluiceHttpClientCreateInfo info = quick();
        info.pS3 = &access;
        SluiceHttpClient *client = create(&info);
        SluiceHttpFile *file = NULL;
        snprintf(url, sizeof url, "s3://bucket/%s", rows[i].key);
        SluiceResult result = sluiceOpenHttpFile(client, url, &file);
        if (result == SLUICE_SUCCESS)
            result = read_at(file, READ_AT, READ_SIZE);
        if (result != rows[i].result)
            fail_msg("%s: %s: %s", url, sluiceGetResultName(result), logged);
        assert_null(strstr(logged, rows[i].secret));
        sluiceDestroyHttpFile(file);
        sluiceDestroyHttpClient(client);
    }
}

static void urls_of_other_kinds_and_bad_settings_are_refused(void **state)
{
    static const char *const urls[] = {
        "", "ftp://127.0.0.1/x", "file:///etc/passwd", "/local/file", "http://", "s3://bucket/key"};
    SluiceHttpClientCreateInfo info = quick();
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    (void)state;
    for (size_t i = 0; i < sizeof urls / sizeof *urls; i++)
        CHECK_RESULT(sluiceOpenHttpFile(client, urls[i], &file), SLUICE_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(sluiceOpenHttpFile(client, "http://user:hush@127.0.0.1:1/x?token=hush", &file),
                 SLUICE_ERROR_IO);
    assert_null(strstr(logged, "hush"));
    sluiceDestroyHttpClient(client);
    info.maxConnectionsPerHost = 1025;
    CHECK_RESULT(sluiceCreateHttpClient(&info, &client), SLUICE_ERROR_INVALID_ARGUMENT);
    info = quick();
    info.ppHeaders = (const char *[]){"two\r\nlines: x"};
    info.headerCount = 1;
    CHECK_RESULT(sluiceCreateHttpClient(&info, &client), SLUICE_ERROR_INVALID_ARGUMENT);
}

/* Opens a path with a cache folder, and reads `count` ranges of 64 KiB. */
static SluiceHttpStatistics read_cached(const char *folder, uint64_t max_size, const char *path,
                                        uint32_t count)
{
    SluiceHttpClientCreateInfo info = quick();
    info.pCacheFolder = folder;
    info.maxCacheSize = max_size;
    SluiceHttpClient *client = create(&info);
    SluiceHttpFile *file;
    CHECK_OK(open_path(client, path, &file));
    for (uint32_t i = 0; i < count; i++)
        CHECK_OK(read_at(file, (3 + i) * READ_SIZE, READ_SIZE));
    SluiceHttpStatistics statistics = statistics_of(client);
    sluiceDestroyHttpFile(file);
    sluiceDestroyHttpClient(client);
    return statistics;
}

/* Runs shell commands in a folder. */
static void shell(const char *folder, const char *commands)
{
    char line[512];
    snprintf(line, sizeof line, "cd '%s' && %s", folder, commands);
    assert_int_equal(system(line), 0);
}

static void remove_folder(const char *folder)
{
    char line[128];
    snprintf(line, sizeof line, "rm -r '%s'", folder);
    assert_int_equal(system(line), 0);
}

static void a_second_start_reads_no_range_twice(void **state)
{
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    (void)state;
    assert_non_null(mkdtemp(folder));
    assert_int_equal(read_cached(folder, 0, "plain/kept", 8).requestTotal, 9);
    SluiceHttpStatistics again = read_cached(folder, 0, "plain/kept", 8);
    assert_int_equal(again.requestTotal, 1);
    assert_int_equal(again.cacheHitTotal, 8);
    assert_in_range(again.cacheSize, 8 * READ_SIZE, 8 * KEPT_SIZE);
    /* Another version, another file, a version that is too new, and one without ETag and date. */
    assert_int_equal(read_cached(folder, 0, "etag/kept?careless=1", 8).requestTotal, 9);
    assert_int_equal(read_cached(folder, 0, "plain/kept?size=1048575", 8).requestTotal, 9);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(read_cached(folder, 0, "fresh/kept?age=1", 2).requestTotal, 3);
        assert_int_equal(read_cached(folder, 0, "fresh/kept?age=2", 2).requestTotal, i ? 1 : 3);
    }
    assert_int_equal(read_cached(folder, 0, "untagged/kept", 2).requestTotal, 3);
    assert_int_equal(read_cached(folder, 0, "untagged/kept", 2).requestTotal, 3);
    remove_folder(folder);
}

static void damaged_and_cut_ranges_are_asked_for_again(void **state)
{
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    (void)state;
    assert_non_null(mkdtemp(folder));
    read_cached(folder, 0, "plain/hurt", 4);
    shell(folder,
          "set -- *.range && truncate -s 100 $1 && : >$2 && : >$1-1-2-3.part && echo >notes && "
          "printf x | dd of=$3 bs=1 seek=5000 conv=notrunc 2>/dev/null");
    assert_int_equal(read_cached(folder, 0, "plain/hurt", 4).cacheHitTotal, 1);
    assert_int_equal(read_cached(folder, 0, "plain/hurt", 4).cacheHitTotal, 4);
    shell(folder, "[ -e notes ] && [ \"$(ls | wc -l)\" = 6 ]");
    remove_folder(folder);
}

/* Kills processes at any moment while they fill the folder and evict from it. */
static void a_folder_survives_processes_that_are_killed(void **state)
{
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    (void)state;
    assert_non_null(mkdtemp(folder));
    for (int i = 0; i < 12; i++) {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            for (;;) {
                read_cached(folder, 5 * KEPT_SIZE, "plain/killed", 8);
                read_cached(folder, 5 * KEPT_SIZE, "plain/killed?again=1", 8);
            }
        nanosleep(&(struct timespec){0, 10000000 + 7000000 * i}, NULL);
        assert_int_equal(kill(child, SIGKILL), 0);
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
        read_cached(folder, 0, "plain/killed", 8); /* compares all bytes */
    }
    assert_int_equal(read_cached(folder, 0, "plain/killed", 8).cacheHitTotal, 8);
    remove_folder(folder);
}

static void the_folder_stays_within_its_limit_and_keeps_what_was_read_last(void **state)
{
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    const uint64_t limit = 6 * KEPT_SIZE;
    (void)state;
    assert_non_null(mkdtemp(folder));
    assert_in_range(read_cached(folder, limit, "plain/limit", 6).cacheSize, 6 * READ_SIZE, limit);
    nanosleep(&(struct timespec){0, 20000000}, NULL);
    assert_int_equal(read_cached(folder, limit, "plain/limit", 3).cacheHitTotal, 3);
    assert_true(read_cached(folder, limit, "plain/other", 2).cacheSize <= limit);
    assert_int_equal(read_cached(folder, limit, "plain/limit", 3).cacheHitTotal, 3);
    remove_folder(folder);
}

static void a_folder_that_cannot_be_written_is_said_once_and_reads_go_on(void **state)
{
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    struct rlimit limit, small;
    (void)state;
    assert_non_null(mkdtemp(folder));
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    small = (struct rlimit){30000, limit.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    fflush(stdout);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    SluiceHttpStatistics statistics = read_cached(folder, 0, "plain/full", 3);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    assert_int_equal(statistics.requestTotal, 4);
    char *first = strstr(logged, "cannot keep what was read");
    assert_non_null(first);
    assert_null(strstr(first + 1, "cannot keep what was read"));
    assert_int_equal(rmdir(folder), 0); /* the folder must be empty */
    SluiceHttpClientCreateInfo info = quick();
    info.pCacheFolder = "/dev/null/cache";
    SluiceHttpClient *client;
    CHECK_RESULT(sluiceCreateHttpClient(&info, &client), SLUICE_ERROR_IO);
}

static void a_folder_that_everybody_may_write_is_refused(void **state)
{
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    SluiceHttpClientCreateInfo info = quick();
    SluiceHttpClient *client;
    (void)state;
    assert_non_null(mkdtemp(folder));
    shell(folder, "chmod 777 .");
    info.pCacheFolder = folder;
    CHECK_RESULT(sluiceCreateHttpClient(&info, &client), SLUICE_ERROR_IO);
    assert_non_null(strstr(logged, "everybody"));
    assert_int_equal(rmdir(folder), 0);
}

/* Gives both files the same hash. */
static void a_range_of_another_file_is_not_taken(void **state)
{
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    (void)state;
    assert_non_null(mkdtemp(folder));
    read_cached(folder, 0, "plain/two", 1);
    assert_int_equal(read_cached(folder, 0, "plain/two", 1).cacheHitTotal, 1);
    shell(folder, "grep -q plain/two *.range && LC_ALL=C sed -i s,plain/two,plain/one, *.range");
    assert_int_equal(read_cached(folder, 0, "plain/two", 1).cacheHitTotal, 0);
    assert_int_equal(read_cached(folder, 0, "plain/two", 1).cacheHitTotal, 1);
    remove_folder(folder);
}

/* Each allocation fails once in turn. */
static void out_of_memory_is_an_ordinary_result(void **state)
{
    SluiceResult result = SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    char folder[] = "/tmp/sluice-http-cache-XXXXXX";
    (void)state;
    assert_non_null(mkdtemp(folder));
    for (uint64_t n = 0; result != SLUICE_SUCCESS && n < 100; n++) {
        struct failing_allocator allocator;
        SluiceHttpClientCreateInfo info = quick();
        SluiceHttpClient *client = NULL;
        SluiceHttpFile *file = NULL;
        void *opened = NULL;
        SluiceInput input = {.structSize = sizeof input};
        SluiceS3Access access = {.structSize = sizeof access,
                                 .pEndpoint = "http://127.0.0.1:1",
                                 .pAccessKey = "a",
                                 .pSecretKey = "b",
                                 .pSessionToken = "c"};
        failing_allocator_init(&allocator, n);
        info.pAllocator = &allocator.callbacks;
        info.pS3 = &access;
        info.pCertificateFile = "x";
        info.pCacheFolder = folder;
        result = sluiceCreateHttpClient(&info, &client);
        if (result == SLUICE_SUCCESS)
            result = open_path(client, "redirect-here/x?from=0", &file);
        if (result == SLUICE_SUCCESS)
            result = read_at(file, READ_AT, READ_SIZE);
        if (result == SLUICE_SUCCESS)
            result = sluiceOpenHttpPath(client, path_url("plain/x"), &input, &opened);
        if (result == SLUICE_SUCCESS)
            result = sluiceCheckHttpPath(client, opened);
        if (result != SLUICE_SUCCESS)
            CHECK_RESULT(result, SLUICE_ERROR_OUT_OF_HOST_MEMORY);
        sluiceCloseHttpPath(client, opened);
        sluiceDestroyHttpFile(file);
        sluiceDestroyHttpClient(client);
        assert_int_equal(allocator.live_count, 0);
    }
    CHECK_OK(result);
    remove_folder(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_range_has_the_bytes_of_the_file),
        cmocka_unit_test(faults_that_pass_cost_attempts_alone),
        cmocka_unit_test(faults_that_stay_are_io_and_name_url_and_range),
        cmocka_unit_test(opening_tells_what_is_wrong_with_the_server),
        cmocka_unit_test(a_small_file_may_come_whole_or_shorter_than_asked),
        cmocka_unit_test(a_changed_file_is_never_mixed_with_its_old_version),
        cmocka_unit_test(a_check_says_whether_the_file_was_changed),
        cmocka_unit_test(a_check_cannot_tell_where_the_server_tells_no_version),
        cmocka_unit_test(headers_of_the_application_stay_with_its_host),
        cmocka_unit_test(a_redirect_may_have_a_body_of_unknown_length),
        cmocka_unit_test(names_in_messages_have_no_password_and_no_query),
        cmocka_unit_test(a_redirect_is_followed_once_and_again_when_its_target_is_gone),
        cmocka_unit_test(reads_go_to_the_new_target_when_the_old_one_has_expired),
        cmocka_unit_test(a_host_that_is_down_is_left_alone_until_its_back_off_has_passed),
        cmocka_unit_test(retry_after_is_obeyed_up_to_the_limit),
        cmocka_unit_test(a_body_that_stalls_is_given_up),
        cmocka_unit_test(a_body_that_drips_is_given_up),
        cmocka_unit_test(reads_that_wait_side_by_side_share_requests),
        cmocka_unit_test(connections_are_bounded_and_failures_reach_every_reader),
        cmocka_unit_test(cancelling_ends_reads_under_way_and_those_that_wait),
        cmocka_unit_test(certificates_are_checked),
        cmocka_unit_test(objects_are_asked_for_with_signatures_that_a_server_accepts),
        cmocka_unit_test(urls_of_other_kinds_and_bad_settings_are_refused),
        cmocka_unit_test(a_second_start_reads_no_range_twice),
        cmocka_unit_test(damaged_and_cut_ranges_are_asked_for_again),
        cmocka_unit_test(a_folder_survives_processes_that_are_killed),
        cmocka_unit_test(the_folder_stays_within_its_limit_and_keeps_what_was_read_last),
        cmocka_unit_test(a_folder_that_cannot_be_written_is_said_once_and_reads_go_on),
        cmocka_unit_test(a_folder_that_everybody_may_write_is_refused),
        cmocka_unit_test(a_range_of_another_file_is_not_taken),
        cmocka_unit_test(out_of_memory_is_an_ordinary_result),
    };
    tap_filter_stdout();
    return cmocka_run_group_tests_name(__FILE__, tests, web_server_start, web_server_stop);
}
