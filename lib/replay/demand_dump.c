#include "replay/demand_dump.h"

#include <inttypes.h>
#include <stdio.h>

static const char *const answer_names[] = {
    [SLC_REQUEST_LOAD] = "load",         [SLC_REQUEST_PENDING] = "pending",
    [SLC_REQUEST_RESIDENT] = "resident", [SLC_REQUEST_RESTORED] = "restored",
    [SLC_REQUEST_REFUSED] = "refused",   [SLC_REQUEST_POSTPONED] = "postponed",
};

static const char *const shown_names[] = {
    [SLC_SHOW_ABSENT] = "absent",
    [SLC_SHOW_RESIDENT] = "resident",
    [SLC_SHOW_REFUSED] = "refused",
};

static void dump_memory_call(struct slc_dump *dump, const struct slc_page_call *call)
{
    char place[16] = "none", page[16] = "none";
    if (call->place != SLC_NO_PLACE)
        snprintf(place, sizeof place, "%" PRIu32, call->place);
    if (call->page != SLC_NO_PAGE)
        snprintf(page, sizeof page, "%" PRIu32, call->page);
    if (call->kind == SLC_PAGE_CALL_TAKE)
        slc_dump_line(dump, "%" PRIu64 " take kind=%" PRIu32 " = place %s", dump->event,
                      call->page_kind, place);
    else if (call->kind == SLC_PAGE_CALL_RETAKE)
        slc_dump_line(dump, "%" PRIu64 " retake place=%s page=%s = %s", dump->event, place, page,
                      call->answer ? "yes" : "no");
    else
        slc_dump_line(dump, "%" PRIu64 " give place=%s page=%s", dump->event, place, page);
}

static void dump_request(struct slc_dump *dump, const struct slc_page_call *call)
{
    const struct slc_page_request *request = &call->request;
    slc_dump_line(
        dump, "%" PRIu64 " request page=%" PRIu32 " class=%u rank=%u%s kind=%" PRIu32 " = %s%s%s",
        dump->event, request->page, request->class_index, request->rank,
        request->pinned ? " pinned" : "", request->kind, answer_names[call->request_answer],
        call->result == SLUICE_SUCCESS ? "" : ", ",
        call->result == SLUICE_SUCCESS ? "" : sluiceGetResultName(call->result));
}

static void dump_changes(struct slc_dump *dump, const struct slc_page_call *call)
{
    slc_dump_line(dump, "%" PRIu64 " take-changes room=%" PRIu32 " = count %" PRIu64, dump->event,
                  call->capacity, call->count);
    for (uint64_t i = 0; i < call->count; i++) {
        const struct slc_page_change *change = &call->changes[i];
        char value[32] = "";
        if (change->shown == SLC_SHOW_RESIDENT)
            snprintf(value, sizeof value, " value=%" PRIu64, change->value);
        slc_dump_line(dump, "%" PRIu64 " change page=%" PRIu32 " class=%u %s%s", dump->event,
                      change->page, change->class_index, shown_names[change->shown], value);
    }
}

static void dump_evicted(struct slc_dump *dump, const struct slc_page_call *call)
{
    slc_dump_line(dump, "%" PRIu64 " take-evicted room=%" PRIu32 " = count %" PRIu64, dump->event,
                  call->capacity, call->count);
    for (uint64_t i = 0; i < call->count; i++)
        slc_dump_line(dump, "%" PRIu64 " evicted page=%" PRIu32 " class=%u value=%" PRIu64,
                      dump->event, call->evicted[i].page, call->evicted[i].class_index,
                      call->evicted[i].value);
}

void slc_dump_page_call(struct slc_dump *dump, const struct slc_page_call *call)
{
    uint64_t event = dump->event;
    if (!dump->line)
        return;
    switch (call->kind) {
    case SLC_PAGE_CALL_TAKE:
    case SLC_PAGE_CALL_RETAKE:
    case SLC_PAGE_CALL_GIVE: dump_memory_call(dump, call); break;
    case SLC_PAGE_CALL_SET_CLASS:
        slc_dump_line(dump, "%" PRIu64 " set-class class=%u limit=%" PRIu64 "%s", event,
                      call->class_index, call->value, call->flag ? " memory" : "");
        break;
    case SLC_PAGE_CALL_BEGIN:
        slc_dump_line(dump, "%" PRIu64 " begin launch=%" PRIu64, event, call->launch);
        break;
    case SLC_PAGE_CALL_USE:
        slc_dump_line(dump, "%" PRIu64 " use page=%" PRIu32, event, call->page);
        break;
    case SLC_PAGE_CALL_REQUEST: dump_request(dump, call); break;
    case SLC_PAGE_CALL_SETTLE:
        slc_dump_line(dump, "%" PRIu64 " settle missing=%" PRIu64, event, call->value);
        break;
    case SLC_PAGE_CALL_PREPARE:
        slc_dump_line(dump, "%" PRIu64 " prepare launch=%" PRIu64 " = bias %.2f", event,
                      call->launch, (double)call->bias);
        break;
    case SLC_PAGE_CALL_ABANDON:
        slc_dump_line(dump, "%" PRIu64 " abandon launch=%" PRIu64, event, call->launch);
        break;
    case SLC_PAGE_CALL_LOADED:
        slc_dump_line(dump, "%" PRIu64 " loaded page=%" PRIu32 " value=%" PRIu64, event, call->page,
                      call->value);
        break;
    case SLC_PAGE_CALL_FAILED:
        slc_dump_line(dump, "%" PRIu64 " failed page=%" PRIu32 "%s", event, call->page,
                      call->flag ? " refuse" : "");
        break;
    case SLC_PAGE_CALL_RETRY:
        slc_dump_line(dump, "%" PRIu64 " retry page=%" PRIu32 " = %s", event, call->page,
                      call->answer ? "yes" : "no");
        break;
    case SLC_PAGE_CALL_FORGET:
        slc_dump_line(dump, "%" PRIu64 " forget first=%" PRIu32 " count=%" PRIu64, event,
                      call->page, call->count);
        break;
    case SLC_PAGE_CALL_TAKE_CHANGES: dump_changes(dump, call); break;
    case SLC_PAGE_CALL_TAKE_EVICTED: dump_evicted(dump, call); break;
    case SLC_PAGE_CALL_SET_SWITCHES:
        slc_dump_line(dump, "%" PRIu64 " set-switches%s%s", event, call->flag ? " no-eviction" : "",
                      call->answer ? " no-lod-bias" : "");
        break;
    case SLC_PAGE_CALL_KINDS: break;
    }
}
