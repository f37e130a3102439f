/* Scheduling of requests per host, and back-off from hosts that are down. */
#include "http/http_client.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "platform/time_now.h"

#include <string.h>

#define NANOSECONDS_PER_MILLISECOND ((uint64_t)1000000)

/* Returns a pseudorandom number from time and count, so that clients do not retry in step. */
static uint64_t roll(SluiceHttpClient *client)
{
    uint64_t x = slc_monotonic_time() ^ (atomic_load(&client->counts.requests) << 32) ^
                 (uint64_t)(uintptr_t)client;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

static uint64_t with_jitter(SluiceHttpClient *client, uint64_t nanoseconds)
{
    return nanoseconds - roll(client) % (nanoseconds / 2 + 1);
}

bool slc_http_pause(SluiceHttpClient *client, uint64_t least, uint64_t delay)
{
    uint64_t end = slc_monotonic_time() + least * NANOSECONDS_PER_MILLISECOND +
                   with_jitter(client, delay * NANOSECONDS_PER_MILLISECOND);
    slc_mutex_lock(&client->mutex);
    while (!atomic_load(&client->is_cancelled) &&
           slc_condition_wait_until(&client->cancelled, &client->mutex, end))
        continue;
    slc_mutex_unlock(&client->mutex);
    return !atomic_load(&client->is_cancelled);
}

struct slc_http_host *slc_http_get_host(SluiceHttpClient *client, const char *origin)
{
    slc_mutex_lock(&client->mutex);
    struct slc_http_host *host = client->hosts;
    while (host && strcmp(host->origin, origin) != 0)
        host = host->next;
    if (!host) {
        host = slc_calloc(&client->allocator, 1, sizeof *host);
        char *copy = host ? slc_strdup(&client->allocator, origin) : NULL;
        if (copy) {
            *host = (struct slc_http_host){.origin = copy, .next = client->hosts};
            client->hosts = host;
        } else {
            slc_free(&client->allocator, host, 1, sizeof *host);
            host = NULL;
        }
    }
    slc_mutex_unlock(&client->mutex);
    return host;
}

/* The functions below are called with the mutex held. */

static void push_wait(struct slc_http_host *host, struct slc_http_wait *wait)
{
    if (host->last_wait)
        host->last_wait->next = wait;
    else
        host->first_wait = wait;
    host->last_wait = wait;
}

static void remove_wait(struct slc_http_host *host, struct slc_http_wait *wait)
{
    struct slc_http_wait *before = NULL;
    for (struct slc_http_wait *w = host->first_wait; w != wait; w = w->next)
        before = w;
    if (before)
        before->next = wait->next;
    else
        host->first_wait = wait->next;
    if (host->last_wait == wait)
        host->last_wait = before;
    wait->next = NULL;
}

static void finish_wait(struct slc_http_wait *wait, SluiceResult result)
{
    wait->is_done = true;
    wait->result = result;
    slc_condition_signal(&wait->changed);
}

/* Refuses all waiting reads at once, because the host is down. */
static void refuse_waiting(SluiceHttpClient *client, struct slc_http_host *host)
{
    while (host->first_wait) {
        struct slc_http_wait *wait = host->first_wait;
        remove_wait(host, wait);
        atomic_fetch_add(&client->counts.refused, 1);
        finish_wait(wait, SLUICE_ERROR_IO);
    }
}

/* Creates a connection. NULL: failure. */
static struct slc_http_connection *add_connection(SluiceHttpClient *client,
                                                  struct slc_http_host *host)
{
    struct slc_http_connection *connection = slc_calloc(&client->allocator, 1, sizeof *connection);
    if (!connection)
        return NULL;
    connection->easy = curl_easy_init();
    if (!connection->easy) {
        slc_free(&client->allocator, connection, 1, sizeof *connection);
        return NULL;
    }
    connection->host = host;
    host->connection_count++;
    client->connection_count++;
    return connection;
}

static bool is_refused(SluiceHttpClient *client, struct slc_http_host *host, bool *is_probe)
{
    *is_probe = false;
    if (atomic_load(&client->is_cancelled))
        return true;
    if (host->down_until == 0)
        return false;
    if (host->is_probed || slc_monotonic_time() < host->down_until)
        return true;
    host->is_probed = *is_probe = true;
    return false;
}

static enum slc_http_turn wait_for_turn(SluiceHttpClient *client, struct slc_http_host *host,
                                        struct slc_http_wait *wait,
                                        struct slc_http_connection **connection)
{
    if (!slc_condition_init(&wait->changed))
        return SLC_HTTP_NO_MEMORY;
    push_wait(host, wait);
    client->waiting++;
    while (!wait->is_done && !wait->connection)
        slc_condition_wait(&wait->changed, &client->mutex);
    client->waiting--;
    slc_condition_finish(&wait->changed);
    *connection = wait->connection;
    return wait->is_done ? SLC_HTTP_DONE : SLC_HTTP_GO;
}

static enum slc_http_turn take_turn(SluiceHttpClient *client, struct slc_http_host *host,
                                    struct slc_http_wait *wait,
                                    struct slc_http_connection **connection, bool *is_probe)
{
    if (is_refused(client, host, is_probe)) {
        atomic_fetch_add(&client->counts.refused, 1);
        return SLC_HTTP_REFUSED;
    }
    *connection = host->idle;
    if (host->idle)
        host->idle = host->idle->next;
    else if (host->connection_count < client->settings.max_connections)
        *connection = add_connection(client, host);
    else
        return wait_for_turn(client, host, wait, connection);
    return *connection ? SLC_HTTP_GO : SLC_HTTP_NO_MEMORY;
}

enum slc_http_turn slc_http_acquire(SluiceHttpClient *client, struct slc_http_host *host,
                                    struct slc_http_wait *wait,
                                    struct slc_http_connection **connection, bool *is_probe)
{
    slc_mutex_lock(&client->mutex);
    enum slc_http_turn turn = take_turn(client, host, wait, connection, is_probe);
    if (turn == SLC_HTTP_GO)
        client->in_flight++;
    else if (*is_probe && turn == SLC_HTTP_NO_MEMORY)
        host->is_probed = false;
    slc_mutex_unlock(&client->mutex);
    return turn;
}

/* Returns the position for a part among sorted adjacent parts; -1: not adjacent. */
static int64_t place_beside(const struct slc_http_part *parts, uint32_t count,
                            const struct slc_http_part *part, uint32_t max_size)
{
    uint64_t first = parts[0].offset, end = parts[count - 1].offset + parts[count - 1].size;
    if (part->size > max_size || end - first > max_size - part->size)
        return -1;
    if (part->offset == end)
        return count;
    return part->offset + part->size == first ? 0 : -1;
}

static void insert_part(struct slc_http_part *parts, struct slc_http_wait **waits, uint32_t count,
                        uint32_t place, struct slc_http_wait *wait)
{
    memmove(parts + place + 1, parts + place, (count - place) * sizeof *parts);
    memmove(waits + place + 1, waits + place, (count - place) * sizeof *waits);
    parts[place] = wait->part;
    waits[place] = wait;
}

static bool join_one(const SluiceHttpClient *client, struct slc_http_host *host,
                     const SluiceHttpFile *file, struct slc_http_part *parts,
                     struct slc_http_wait **waits, uint32_t count)
{
    for (struct slc_http_wait *wait = host->first_wait; wait; wait = wait->next) {
        int64_t place = wait->file == file ? place_beside(parts, count, &wait->part,
                                                          client->settings.max_joined_size)
                                           : -1;
        if (place < 0)
            continue;
        remove_wait(host, wait);
        insert_part(parts, waits, count, (uint32_t)place, wait);
        return true;
    }
    return false;
}

uint32_t slc_http_join(SluiceHttpClient *client, struct slc_http_host *host,
                       const SluiceHttpFile *file, struct slc_http_part *parts,
                       struct slc_http_wait **waits)
{
    uint32_t count = 1;
    waits[0] = NULL;
    if (!file || parts[0].size > client->settings.max_joined_size)
        return count;
    slc_mutex_lock(&client->mutex);
    while (count < SLC_HTTP_MAX_PARTS && join_one(client, host, file, parts, waits, count))
        count++;
    slc_mutex_unlock(&client->mutex);
    atomic_fetch_add(&client->counts.joined, count - 1);
    return count;
}

void slc_http_finish_joined(SluiceHttpClient *client, struct slc_http_wait *const *waits,
                            uint32_t count, SluiceResult result)
{
    if (count == 1)
        return;
    slc_mutex_lock(&client->mutex);
    for (uint32_t i = 0; i < count; i++)
        if (waits[i])
            finish_wait(waits[i], result);
    slc_mutex_unlock(&client->mutex);
}

/* Marks the host as down. `least`: milliseconds, requested by the server. */
static void set_down(SluiceHttpClient *client, struct slc_http_host *host, uint64_t least)
{
    uint64_t delay = client->settings.retry_delay;
    if (slc_monotonic_time() < host->down_until) { /* concurrent requests count as one failure */
        refuse_waiting(client, host);
        return;
    }
    for (uint32_t i = 0; i < host->failures && delay < client->settings.max_retry_delay; i++)
        delay *= 2;
    delay = slc_min_u64(delay, client->settings.max_retry_delay);
    delay = delay > least ? delay : least;
    host->failures++;
    host->down_until =
        slc_monotonic_time() + with_jitter(client, delay * NANOSECONDS_PER_MILLISECOND);
    refuse_waiting(client, host);
}

static void note_verdict(SluiceHttpClient *client, struct slc_http_host *host,
                         enum slc_http_verdict verdict, uint64_t least)
{
    host->is_probed = false;
    if (verdict == SLC_HTTP_OUT_OF_ORDER) {
        set_down(client, host, least);
    } else if (verdict == SLC_HTTP_IN_ORDER) {
        host->failures = 0;
        host->down_until = 0;
    }
}

void slc_http_release(SluiceHttpClient *client, struct slc_http_connection *connection,
                      enum slc_http_verdict verdict, uint64_t least_delay)
{
    struct slc_http_host *host = connection->host;
    slc_mutex_lock(&client->mutex);
    client->in_flight--;
    note_verdict(client, host, verdict, least_delay);
    if (atomic_load(&client->is_cancelled))
        refuse_waiting(client, host);
    struct slc_http_wait *wait = host->first_wait;
    if (wait) {
        remove_wait(host, wait);
        wait->connection = connection;
        slc_condition_signal(&wait->changed);
    } else {
        connection->next = host->idle;
        host->idle = connection;
    }
    slc_mutex_unlock(&client->mutex);
}
