#include "demand_vulkan/tickets.h"

#include "base/alloc.h"
#include "base/checked.h"
#include "image/read_pool.h"
#include "platform/time_now.h"

#include <assert.h>

#define NONE UINT32_MAX
#define A_WHILE 1000000 /* ns */
#define KEPT 1024u      /* most done tickets whose status can still be queried */

/* Returns the time `timeout` ns from now. UINT64_MAX: never. */
static uint64_t find_deadline(uint64_t timeout)
{
    uint64_t now = slc_monotonic_time();
    return timeout <= (UINT64_MAX >> 1) - now ? now + timeout : UINT64_MAX;
}

SluiceResult slc_tickets_init(struct slc_tickets *tickets, const SluiceAllocationCallbacks *cb)
{
    *tickets = (struct slc_tickets){.cb = *cb, .first_done = NONE, .last_done = NONE};
    /* The lock is held often and briefly, by workers while they hold the tile loader's lock. */
    if (!slc_mutex_init_spinning(&tickets->mutex))
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    if (!slc_condition_init(&tickets->changed)) {
        slc_mutex_finish(&tickets->mutex);
        return SLUICE_ERROR_OUT_OF_HOST_MEMORY;
    }
    tickets->ready = true;
    return SLUICE_SUCCESS;
}

void slc_tickets_finish(struct slc_tickets *tickets)
{
    if (!tickets->ready)
        return;
    slc_condition_finish(&tickets->changed);
    slc_mutex_finish(&tickets->mutex);
    slc_free(&tickets->cb, tickets->slots, tickets->capacity, sizeof *tickets->slots);
    *tickets = (struct slc_tickets){0};
}

static uint32_t take_slot(struct slc_tickets *tickets)
{
    if (tickets->done_count > KEPT) {
        uint32_t slot = tickets->first_done;
        tickets->first_done = tickets->slots[slot].next;
        tickets->done_count--;
        return slot;
    }
    if (tickets->used == tickets->capacity) {
        uint32_t capacity = tickets->capacity ? 2 * tickets->capacity : 64;
        struct slc_ticket *slots =
            slc_regrow(&tickets->cb, tickets->slots, tickets->capacity, capacity, sizeof *slots);
        if (!slots)
            return NONE;
        tickets->slots = slots;
        tickets->capacity = capacity;
    }
    tickets->slots[tickets->used] = (struct slc_ticket){0};
    return tickets->used++;
}

SluiceResult slc_ticket_open(struct slc_tickets *tickets, SluiceDemandTicket *ticket)
{
    slc_mutex_lock(&tickets->mutex);
    uint32_t slot = take_slot(tickets);
    if (slot != NONE) {
        struct slc_ticket *new = &tickets->slots[slot];
        *new = (struct slc_ticket){.generation = new->generation + 1, .owners = 1};
        *ticket = (uint64_t) new->generation << 32 | (slot + 1);
    }
    slc_mutex_unlock(&tickets->mutex);
    return slot == NONE ? SLUICE_ERROR_OUT_OF_HOST_MEMORY : SLUICE_SUCCESS;
}

struct slc_ticket *slc_ticket_find(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                                   bool *known)
{
    uint32_t slot = (uint32_t)ticket - 1, generation = (uint32_t)(ticket >> 32);
    *known = ticket == 0;
    if (ticket == 0 || slot >= tickets->used || generation == 0 ||
        generation > tickets->slots[slot].generation)
        return NULL;
    *known = true;
    return generation == tickets->slots[slot].generation ? &tickets->slots[slot] : NULL;
}

static struct slc_ticket *find(struct slc_tickets *tickets, SluiceDemandTicket ticket)
{
    bool known;
    return slc_ticket_find(tickets, ticket, &known);
}

/* Queues a done ticket. Slots are reused in the order in which their tickets were done. */
static void check_done(struct slc_tickets *tickets, struct slc_ticket *ticket)
{
    uint32_t slot = (uint32_t)(ticket - tickets->slots);
    if (ticket->remaining || ticket->owners)
        return;
    ticket->next = NONE;
    if (tickets->done_count == 0)
        tickets->first_done = slot;
    else
        tickets->slots[tickets->last_done].next = slot;
    tickets->last_done = slot;
    tickets->done_count++;
}

SluiceDemandTicket slc_ticket_close(struct slc_tickets *tickets, SluiceDemandTicket ticket)
{
    slc_mutex_lock(&tickets->mutex);
    struct slc_ticket *found = find(tickets, ticket);
    bool empty = !found || found->task_count == 0;
    if (found) {
        assert(found->owners > 0);
        found->owners--;
        check_done(tickets, found);
        slc_condition_broadcast(&tickets->changed);
    }
    slc_mutex_unlock(&tickets->mutex);
    return empty ? 0 : ticket;
}

void slc_ticket_add(struct slc_tickets *tickets, SluiceDemandTicket ticket, uint32_t count)
{
    slc_mutex_lock(&tickets->mutex);
    struct slc_ticket *found = find(tickets, ticket);
    if (found) {
        assert(found->owners > 0);
        found->task_count += count;
        found->remaining += count;
    }
    slc_mutex_unlock(&tickets->mutex);
}

void slc_ticket_drop(struct slc_tickets *tickets, SluiceDemandTicket ticket, uint32_t count)
{
    slc_mutex_lock(&tickets->mutex);
    struct slc_ticket *found = find(tickets, ticket);
    if (found) {
        assert(found->remaining >= count && found->owners > 0);
        found->remaining -= count;
        found->task_count -= count;
    }
    slc_mutex_unlock(&tickets->mutex);
}

bool slc_ticket_is_canceled(struct slc_tickets *tickets, SluiceDemandTicket ticket)
{
    slc_mutex_lock(&tickets->mutex);
    struct slc_ticket *found = find(tickets, ticket);
    bool canceled = tickets->aborted || (found && found->canceled);
    slc_mutex_unlock(&tickets->mutex);
    return canceled;
}

void slc_ticket_task_begins(struct slc_tickets *tickets, SluiceDemandTicket ticket)
{
    struct slc_ticket *found = find(tickets, ticket);
    if (!found)
        return;
    assert(found->owners > 0);
    found->task_count++;
    found->remaining++;
    found->running++;
}

void slc_ticket_task_withdraw(struct slc_tickets *tickets, SluiceDemandTicket ticket)
{
    struct slc_ticket *found = find(tickets, ticket);
    if (!found)
        return;
    found->task_count--;
    found->remaining--;
    found->running--;
}

void slc_ticket_task_ends(struct slc_tickets *tickets, SluiceDemandTicket ticket, bool failed)
{
    struct slc_ticket *found = find(tickets, ticket);
    if (!found)
        return;
    assert(found->running > 0 && found->remaining > 0);
    found->running--;
    found->remaining--;
    found->failed += failed;
    check_done(tickets, found);
    if (found->running == 0)
        slc_condition_broadcast(&tickets->changed);
}

static void write_status(const struct slc_ticket *ticket, SluiceDemandTicketStatus *status)
{
    if (!status)
        return;
    *status = (SluiceDemandTicketStatus){.structSize = sizeof(SluiceDemandTicketStatus)};
    if (ticket)
        *status = (SluiceDemandTicketStatus){.structSize = sizeof(SluiceDemandTicketStatus),
                                             .taskCount = ticket->task_count,
                                             .remainingCount = ticket->remaining,
                                             .failedCount = ticket->failed};
}

SluiceResult slc_ticket_get_status(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                                   SluiceDemandTicketStatus *status)
{
    bool known;
    slc_mutex_lock(&tickets->mutex);
    const struct slc_ticket *found = slc_ticket_find(tickets, ticket, &known);
    if (known)
        write_status(found, status);
    slc_mutex_unlock(&tickets->mutex);
    return known ? SLUICE_SUCCESS : SLUICE_ERROR_INVALID_ARGUMENT;
}

/* Gets the status of a ticket, with the lock held. NOT_READY: not done. */
static SluiceResult look(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                         SluiceDemandTicketStatus *status)
{
    bool known;
    const struct slc_ticket *found = slc_ticket_find(tickets, ticket, &known);
    if (!known)
        return SLUICE_ERROR_INVALID_ARGUMENT;
    write_status(found, status);
    if (tickets->aborted)
        return SLUICE_ERROR_CANCELED;
    return found && found->running ? SLUICE_NOT_READY : SLUICE_SUCCESS;
}

/* Runs jobs while waiting. Refused jobs and due retries do not change the awaited tickets. */
static void help_jobs(struct slc_tickets *tickets, uint64_t until)
{
    slc_mutex_unlock(&tickets->mutex);
    bool has_read = slc_loader_help(tickets->reader);
    uint64_t later = slc_monotonic_time() + A_WHILE;
    slc_mutex_lock(&tickets->mutex);
    if (!has_read)
        slc_condition_wait_until(&tickets->changed, &tickets->mutex, slc_min_u64(until, later));
}

bool slc_tickets_wait(struct slc_tickets *tickets, uint64_t until)
{
    if (tickets->reader) {
        help_jobs(tickets, until);
        return slc_monotonic_time() < until;
    }
    if (until < UINT64_MAX)
        return slc_condition_wait_until(&tickets->changed, &tickets->mutex, until);
    slc_condition_wait(&tickets->changed, &tickets->mutex);
    return true;
}

SluiceResult slc_ticket_wait(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                             uint64_t timeout, SluiceDemandTicketStatus *status)
{
    uint64_t until = find_deadline(timeout);
    bool over = timeout == 0;
    slc_mutex_lock(&tickets->mutex);
    SluiceResult result = look(tickets, ticket, status);
    while (result == SLUICE_NOT_READY && !over) {
        over = !slc_tickets_wait(tickets, until);
        result = look(tickets, ticket, status);
    }
    slc_mutex_unlock(&tickets->mutex);
    return result;
}
