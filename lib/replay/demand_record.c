#include "replay/demand_record.h"

#include "replay/hash.h"

#include <assert.h>
#include <string.h>

/* Fields of a record, in this order. */
enum field {
    FIELD_PAGE = 1,
    FIELD_PLACE = 2,
    FIELD_CLASS = 4,
    FIELD_LAUNCH = 8,
    FIELD_VALUE = 16,
    FIELD_COUNT = 32,
    FIELD_CAPACITY = 64,
    FIELD_FLAG = 128,
    FIELD_ANSWER = 256,
    FIELD_REQUEST = 512,
    FIELD_HASH = 1024
};

static const uint32_t call_fields[SLC_PAGE_CALL_KINDS] = {
    [SLC_PAGE_CALL_TAKE] = FIELD_PLACE,
    [SLC_PAGE_CALL_RETAKE] = FIELD_ANSWER,
    [SLC_PAGE_CALL_SET_CLASS] = FIELD_CLASS | FIELD_VALUE | FIELD_FLAG,
    [SLC_PAGE_CALL_BEGIN] = FIELD_LAUNCH,
    [SLC_PAGE_CALL_USE] = FIELD_PAGE,
    [SLC_PAGE_CALL_REQUEST] = FIELD_PAGE | FIELD_REQUEST,
    [SLC_PAGE_CALL_SETTLE] = FIELD_VALUE | FIELD_HASH,
    [SLC_PAGE_CALL_PREPARE] = FIELD_LAUNCH | FIELD_HASH,
    [SLC_PAGE_CALL_ABANDON] = FIELD_LAUNCH,
    [SLC_PAGE_CALL_LOADED] = FIELD_PAGE | FIELD_VALUE,
    [SLC_PAGE_CALL_FAILED] = FIELD_PAGE | FIELD_FLAG,
    [SLC_PAGE_CALL_RETRY] = FIELD_PAGE | FIELD_ANSWER,
    [SLC_PAGE_CALL_FORGET] = FIELD_PAGE | FIELD_COUNT,
    [SLC_PAGE_CALL_TAKE_CHANGES] = FIELD_CAPACITY | FIELD_COUNT | FIELD_HASH,
    [SLC_PAGE_CALL_TAKE_EVICTED] = FIELD_CAPACITY | FIELD_COUNT | FIELD_HASH,
    [SLC_PAGE_CALL_SET_SWITCHES] = FIELD_FLAG | FIELD_ANSWER,
};

bool slc_page_call_is_answer(enum slc_page_call_kind kind)
{
    return kind == SLC_PAGE_CALL_TAKE || kind == SLC_PAGE_CALL_RETAKE;
}

bool slc_page_call_has_hash(enum slc_page_call_kind kind)
{
    return call_fields[kind] & FIELD_HASH;
}

static void put_request(struct slc_bytes *out, const struct slc_page_call *call)
{
    slc_put_u8(out, call->request.class_index);
    slc_put_u8(out, call->request.rank);
    slc_put_u8(out, call->request.pinned != 0);
    slc_put_varint(out, call->request.kind);
    slc_put_signed(out, call->result);
    slc_put_u8(out, (uint8_t)call->request_answer);
}

void slc_put_demand_record(struct slc_bytes *out, const struct slc_page_call *call, uint64_t hash,
                           uint32_t *last_page)
{
    assert(call->request.kind < SLC_DEMAND_PAGE_KINDS);
    uint32_t fields = call_fields[call->kind];
    uint32_t page = call->kind == SLC_PAGE_CALL_REQUEST ? call->request.page : call->page;
    if (!fields)
        return;
    slc_put_u8(out, (uint8_t)call->kind);
    if (fields & FIELD_PAGE) {
        slc_put_signed(out, (int64_t)page - *last_page);
        *last_page = page;
    }
    if (fields & FIELD_PLACE)
        slc_put_varint(out, call->place == SLC_NO_PLACE ? 0 : call->place + 1);
    if (fields & FIELD_CLASS)
        slc_put_u8(out, call->class_index);
    if (fields & FIELD_LAUNCH)
        slc_put_varint(out, call->launch);
    if (fields & FIELD_VALUE)
        slc_put_varint(out, call->value);
    if (fields & FIELD_COUNT)
        slc_put_varint(out, call->count);
    if (fields & FIELD_CAPACITY)
        slc_put_varint(out, call->capacity);
    if (fields & FIELD_FLAG)
        slc_put_u8(out, call->flag);
    if (fields & FIELD_ANSWER)
        slc_put_u8(out, call->answer);
    if (fields & FIELD_REQUEST)
        put_request(out, call);
    if (fields & FIELD_HASH)
        slc_put_u64(out, hash);
}

static uint32_t get_page(struct slc_cursor *in, uint32_t *last_page)
{
    size_t start = in->pos;
    int64_t step = slc_get_signed(in);
    /* Check the step first, because the sum might overflow. */
    if (step < -(int64_t)UINT32_MAX || step > UINT32_MAX || *last_page + step < 0 ||
        *last_page + step > UINT32_MAX) {
        slc_cursor_fail(in, start, "a page does not fit 32 bits");
        return 0;
    }
    return *last_page = (uint32_t)(*last_page + step);
}

static bool get_flag(struct slc_cursor *in)
{
    size_t start = in->pos;
    uint8_t value = slc_get_u8(in);
    if (value > 1)
        slc_cursor_fail(in, start, "a flag is neither 0 nor 1");
    return value == 1;
}

static void get_request(struct slc_cursor *in, struct slc_page_call *call)
{
    call->request.page = call->page;
    call->request.class_index = slc_get_u8(in);
    call->request.rank = slc_get_u8(in);
    call->request.pinned = get_flag(in);
    size_t start = in->pos;
    call->request.kind = slc_get_varint32(in);
    if (call->request.kind >= SLC_DEMAND_PAGE_KINDS)
        slc_cursor_fail(in, start, "a kind of pages is above 255");
    call->result = (SluiceResult)slc_get_signed32(in);
    start = in->pos;
    uint8_t answer = slc_get_u8(in);
    if (answer > SLC_REQUEST_POSTPONED)
        slc_cursor_fail(in, start, "no request has this answer");
    call->request_answer = (enum slc_request_answer)answer;
}

void slc_get_demand_record(struct slc_cursor *in, struct slc_demand_record *record,
                           uint32_t *last_page)
{
    memset(record, 0, sizeof *record);
    struct slc_page_call *call = &record->call;
    size_t start = in->pos;
    uint8_t kind = slc_get_u8(in);
    uint32_t fields = kind < SLC_PAGE_CALL_KINDS ? call_fields[kind] : 0;
    if (!fields)
        slc_cursor_fail(in, start, "no call has this number");
    call->kind = (enum slc_page_call_kind)kind;
    if (fields & FIELD_PAGE)
        call->page = get_page(in, last_page);
    if (fields & FIELD_PLACE)
        call->place = slc_get_varint32(in) - 1; /* 0 is SLC_NO_PLACE */
    if (fields & FIELD_CLASS)
        call->class_index = slc_get_u8(in);
    if (fields & FIELD_LAUNCH)
        call->launch = slc_get_varint(in);
    if (fields & FIELD_VALUE)
        call->value = slc_get_varint(in);
    if (fields & FIELD_COUNT)
        call->count = slc_get_varint(in);
    if (fields & FIELD_CAPACITY)
        call->capacity = slc_get_varint32(in);
    if (fields & FIELD_FLAG)
        call->flag = get_flag(in);
    if (fields & FIELD_ANSWER)
        call->answer = get_flag(in);
    if (fields & FIELD_REQUEST)
        get_request(in, call);
    if (fields & FIELD_HASH)
        record->hash = slc_get_u64(in);
}

/* Decisions --------------------------------------------------------------------------------- */

static uint64_t hash_lists(uint64_t hash, const struct slc_page_call *call)
{
    for (uint64_t i = 0; call->changes && i < call->count; i++) {
        const struct slc_page_change *change = &call->changes[i];
        hash = slc_hash_u32(hash, change->page);
        hash = slc_hash_u8(hash, change->class_index);
        hash = slc_hash_u8(hash, (uint8_t)change->shown);
        hash = slc_hash_u64(hash, change->shown == SLC_SHOW_RESIDENT ? change->value : 0);
    }
    for (uint64_t i = 0; call->evicted && i < call->count; i++) {
        hash = slc_hash_u32(hash, call->evicted[i].page);
        hash = slc_hash_u8(hash, call->evicted[i].class_index);
        hash = slc_hash_u64(hash, call->evicted[i].value);
    }
    return slc_hash_u32(hash, (uint32_t)call->count);
}

uint64_t slc_hash_page_call(uint64_t hash, const struct slc_page_call *call)
{
    hash = slc_hash_u8(hash, (uint8_t)call->kind);
    switch (call->kind) {
    case SLC_PAGE_CALL_TAKE:
        hash = slc_hash_u32(hash, call->page_kind);
        return slc_hash_u32(hash, call->place);
    case SLC_PAGE_CALL_RETAKE:
        hash = slc_hash_u32(hash, call->place);
        hash = slc_hash_u32(hash, call->page);
        return slc_hash_u8(hash, call->answer);
    case SLC_PAGE_CALL_GIVE:
        hash = slc_hash_u32(hash, call->place);
        return slc_hash_u32(hash, call->page);
    case SLC_PAGE_CALL_REQUEST:
        hash = slc_hash_u32(hash, (uint32_t)call->result);
        return slc_hash_u8(hash, (uint8_t)call->request_answer);
    case SLC_PAGE_CALL_PREPARE: return slc_hash_u32(hash, (uint32_t)(4 * call->bias));
    case SLC_PAGE_CALL_RETRY: return slc_hash_u8(hash, call->answer);
    case SLC_PAGE_CALL_TAKE_CHANGES:
    case SLC_PAGE_CALL_TAKE_EVICTED: return hash_lists(hash, call);
    default: return hash;
    }
}
