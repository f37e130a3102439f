/**
 * Tickets count the tasks of a call, so that threads can wait for them. Their lock also guards
 * fields of jobs that are shared with the threads that end them (loader.h). All functions: any
 * thread.
 */
#ifndef SLC_DEMAND_VULKAN_TICKETS_H
#define SLC_DEMAND_VULKAN_TICKETS_H

#include <sluice/demand.h>
#include <sluice/loader.h>

#include "platform/thread.h"

#include <time.h>

struct slc_ticket {
    uint32_t generation; ///< generation of the slot, from 1 on
    uint32_t task_count, remaining, failed;
    uint32_t running; ///< remaining tasks that have begun
    uint32_t owners;  ///< owners, who may still add tasks
    bool canceled;
    uint32_t next; ///< done: next of the list of done tickets, longest done first
};

struct slc_tickets {
    SluiceAllocationCallbacks cb;
    struct slc_mutex mutex; ///< guards all fields
    struct slc_condition
        changed; ///< signaled when a ticket has no running task, a job has ended, or all end
    bool ready;  ///< mutex and condition exist
    bool aborted;
    SluiceTileLoader *reader; ///< loader whose jobs waiting threads help with; or NULL
    uint32_t job_waiters;     ///< threads that wait for the end of any job
    struct slc_ticket *slots; ///< owned
    uint32_t capacity, used;
    uint32_t first_done, last_done, done_count;
    uint64_t latency[24]; ///< SluiceDemandStatistics.latencyHistogram
};

/** Creates the lock. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_tickets_init(struct slc_tickets *tickets, const SluiceAllocationCallbacks *cb);
/** Frees the tickets. No thread may wait. `tickets` may be zeroed. */
void slc_tickets_finish(struct slc_tickets *tickets);

/** Opens a ticket without tasks. The caller is its owner. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_ticket_open(struct slc_tickets *tickets, SluiceDemandTicket *ticket);
/** Ends the ownership: no task is added any more. Returns the ticket, or 0 if it never had a task.
 */
SluiceDemandTicket slc_ticket_close(struct slc_tickets *tickets, SluiceDemandTicket ticket);

/** Adds tasks. Does nothing for ticket 0. */
void slc_ticket_add(struct slc_tickets *tickets, SluiceDemandTicket ticket, uint32_t count);
/** Removes added tasks that are not necessary after all. */
void slc_ticket_drop(struct slc_tickets *tickets, SluiceDemandTicket ticket, uint32_t count);
bool slc_ticket_is_canceled(struct slc_tickets *tickets, SluiceDemandTicket ticket);

/** Adds and begins a task; ends a task; withdraws a task that did not begin. The lock is held. */
void slc_ticket_task_begins(struct slc_tickets *tickets, SluiceDemandTicket ticket);
void slc_ticket_task_ends(struct slc_tickets *tickets, SluiceDemandTicket ticket, bool failed);
void slc_ticket_task_withdraw(struct slc_tickets *tickets, SluiceDemandTicket ticket);
/** Finds a ticket, with the lock held. NULL for 0, and for tickets done long ago (`*known` tells).
 */
struct slc_ticket *slc_ticket_find(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                                   bool *known);

/** Waits for a change, or for some time. The lock must be held; it is released while waiting.
 * False: slc_monotonic_time() has reached `until`; UINT64_MAX: never. */
bool slc_tickets_wait(struct slc_tickets *tickets, uint64_t until);

/** Implement sluiceGetDemandTicketStatus and sluiceWaitDemandTicket. */
SluiceResult slc_ticket_get_status(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                                   SluiceDemandTicketStatus *status);
SluiceResult slc_ticket_wait(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                             uint64_t timeout, SluiceDemandTicketStatus *status);

#endif /* SLC_DEMAND_VULKAN_TICKETS_H */
