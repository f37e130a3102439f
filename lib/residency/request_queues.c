#include "residency/request_queues.h"

#include "base/bits.h"
#include "residency/node_list.h"

static uint8_t weighted(uint8_t need, int32_t weight)
{
    int32_t sum = need + weight;
    return (uint8_t)(sum < 0 ? 0 : sum < SLC_REQUEST_NEEDS ? sum : SLC_REQUEST_NEEDS - 1);
}

void slc_request_append(struct slc_machine *r, uint32_t node)
{
    struct slc_requests *q = &r->requests;
    struct slc_node *n = slc_node_at(r, node);
    if (r->user.weight)
        n->need = weighted(n->need, r->user.weight(r->user.user, n->owner));
    n->order = q->next_sequence++;
    slc_list_append(r, &q->lists[n->level][n->need], node);
    q->needs[n->level] |= 1u << n->need;
    q->classes |= 1u << n->level;
    q->count++;
    q->counts[n->level]++;
    r->user.requested(r->user.user, n->owner, true);
}

void slc_request_remove(struct slc_machine *r, uint32_t node)
{
    struct slc_requests *q = &r->requests;
    const struct slc_node *n = slc_node_at(r, node);
    struct slc_list *list = &q->lists[n->level][n->need];
    slc_list_remove(r, list, node);
    if (list->count == 0)
        q->needs[n->level] &= ~(1u << n->need);
    if (q->needs[n->level] == 0)
        q->classes &= ~(1u << n->level);
    q->count--;
    q->counts[n->level]--;
    r->user.requested(r->user.user, n->owner, false);
}

static uint32_t last_bit(uint32_t bits)
{
    return slc_highest_bit(bits);
}

static uint32_t first_of(const struct slc_requests *q, uint32_t classes)
{
    if (!classes)
        return 0;
    uint32_t class = last_bit(classes);
    return q->lists[class][last_bit(q->needs[class])].head;
}

uint32_t slc_first_request(const struct slc_machine *r)
{
    return first_of(&r->requests, r->requests.classes);
}

uint32_t slc_next_request(const struct slc_machine *r, uint32_t node)
{
    const struct slc_requests *q = &r->requests;
    const struct slc_node *n = slc_node_at(r, node);
    if (n->next)
        return n->next;
    uint32_t needs = q->needs[n->level] & ((1u << n->need) - 1);
    if (needs)
        return q->lists[n->level][last_bit(needs)].head;
    return first_of(q, q->classes & ((1u << n->level) - 1));
}
