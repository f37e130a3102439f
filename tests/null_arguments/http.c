/* NULL and zero in every argument of the functions of sluice-http. */
#include "null_arguments/calls.h"

#include "http/web_server.h"

#include <sluice/http.h>

#include <stdio.h>

/* clang-format off */
/* CALLS
sluiceCreateHttpClient(?&f->create, &f->out.client) => sluiceDestroyHttpClient(f->out.client)
!sluiceDestroyHttpClient(f->client)
~sluiceCancelHttpReads(f->other)
sluiceOpenHttpFile(f->client, f->url, &f->out.file) => sluiceDestroyHttpFile(f->out.file)
!sluiceDestroyHttpFile(f->file)
sluiceGetHttpInput(f->file, &f->out.input)
sluiceOpenHttpPath(f->client, f->url, &f->out.input, &f->out.opened) => sluiceCloseHttpPath(f->client, f->out.opened)
sluiceCheckHttpPath(f->client, f->opened)
~sluiceCloseHttpPath(f->client, f->nothing)
sluiceGetHttpStatistics(f->client, &f->out.statistics)
*/
/* clang-format on */

struct fixture {
    SluiceHttpClientCreateInfo create;
    SluiceHttpClient *client, *other;
    SluiceHttpFile *file;
    char url[64];
    void *nothing, *opened;
    struct {
        SluiceHttpClient *client;
        SluiceHttpFile *file;
        SluiceInput input;
        void *opened;
        SluiceHttpStatistics statistics;
    } out;
};

CALLS_FUNCTIONS

static void fixture_init(struct fixture *f, void **state)
{
    (void)state;
    snprintf(f->url, sizeof f->url, "http://127.0.0.1:%u/plain/x", web_server.ports[0]);
    f->create.structSize = sizeof f->create;
    f->create.maxAttemptCount = 1;
    CHECK_OK(sluiceCreateHttpClient(&f->create, &f->client));
    CHECK_OK(sluiceCreateHttpClient(&f->create, &f->other));
    CHECK_OK(sluiceOpenHttpFile(f->client, f->url, &f->file));
    f->opened = f->file;
}

static void fixture_finish(struct fixture *f)
{
    sluiceDestroyHttpFile(f->file);
    sluiceDestroyHttpClient(f->client);
    sluiceDestroyHttpClient(f->other);
}

#include "http_calls.h"

int main(void)
{
    const struct CMUnitTest tests[] = {CALLS_TESTS};
    tap_filter_stdout();
    return cmocka_run_group_tests_name(__FILE__, tests, web_server_start, web_server_stop);
}
