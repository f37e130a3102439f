/**
 * What waits for the tasks of a call: counts behind a lock. The same lock guards what jobs share
 * with the threads that end them, see jobs.h. All functions: any thread.
 */
#ifndef SLC_DEMAND_VULKAN_TICKETS_H
#define SLC_DEMAND_VULKAN_TICKETS_H

#include <sluice/demand.h>
#include <sluice/loader.h>

#include "platform/thread.h"

#include <time.h>

struct slc_ticket {
    uint32_t generation; ///< of the slot, from 1 on
    uint32_t task_count, remaining, failed;
    uint32_t running; ///< of those that remain: begun, and not over
    uint32_t owners;  ///< who may add tasks yet
    bool canceled;
    uint32_t next; ///< done: in the list of those, the longest done first
};

struct slc_tickets {
    SluiceAllocationCallbacks cb;
    struct slc_mutex mutex; ///< around everything here
    struct slc_condition
        changed; ///< a ticket has nothing running any more, a job is over, or all end
    bool ready;  ///< mutex and condition exist
    bool aborted;
    SluiceTileLoader *reader; ///< reads in jobs of the application, which waiters help; or NULL
    uint32_t job_waiters;     ///< threads that wait for the end of any job
    struct slc_ticket *slots; ///< owned
    uint32_t capacity, used;
    uint32_t first_done, last_done, done_count;
    uint64_t latency[24]; ///< as SluiceDemandStatistics.latencyHistogram
};

/** Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_tickets_init(struct slc_tickets *tickets, const SluiceAllocationCallbacks *cb);
/** Nobody waits. Of a zeroed one: nothing to do. */
void slc_tickets_finish(struct slc_tickets *tickets);

/** A ticket without tasks, whose owner is the caller. Errors: OUT_OF_HOST_MEMORY. */
SluiceResult slc_ticket_open(struct slc_tickets *tickets, SluiceDemandTicket *ticket);
/** The owner adds nothing any more; 0 if nothing was ever added. */
SluiceDemandTicket slc_ticket_close(struct slc_tickets *tickets, SluiceDemandTicket ticket);

/** Ticket 0 has no tasks: nothing happens. */
void slc_ticket_add(struct slc_tickets *tickets, SluiceDemandTicket ticket, uint32_t count);
/** Tasks that were added and turned out to be none. */
void slc_ticket_drop(struct slc_tickets *tickets, SluiceDemandTicket ticket, uint32_t count);
bool slc_ticket_is_canceled(struct slc_tickets *tickets, SluiceDemandTicket ticket);

/** With the lock held: another task is there and begins; it is over; it did not begin after all. */
void slc_ticket_task_begins(struct slc_tickets *tickets, SluiceDemandTicket ticket);
void slc_ticket_task_ends(struct slc_tickets *tickets, SluiceDemandTicket ticket, bool failed);
void slc_ticket_task_withdraw(struct slc_tickets *tickets, SluiceDemandTicket ticket);
/** With the lock held: NULL for 0, and for what is long over; `*known` says which. */
struct slc_ticket *slc_ticket_find(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                                   bool *known);

/** With the lock held, which is given up meanwhile: waits for a change, or for some time. False:
 *  slc_monotonic_time() is `until`; UINT64_MAX: never. */
bool slc_tickets_wait(struct slc_tickets *tickets, uint64_t until);

/** As sluiceGetDemandTicketStatus and sluiceWaitDemandTicket. */
SluiceResult slc_ticket_get_status(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                                   SluiceDemandTicketStatus *status);
SluiceResult slc_ticket_wait(struct slc_tickets *tickets, SluiceDemandTicket ticket,
                             uint64_t timeout, SluiceDemandTicketStatus *status);

#endif /* SLC_DEMAND_VULKAN_TICKETS_H */
