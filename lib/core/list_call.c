#include "core/list_call.h"

#include "core/lookup.h"
#include "core/observer.h"
#include "core/refusal.h"

static SluiceResult get_list(slc_manager *m, const struct slc_list_call *call,
                             slc_list_function *get)
{
    struct slc_managed_texture *scope;
    SluiceResult result = slc_find_scope(m, call->function, call->texture_id, &scope);
    return result == SLUICE_SUCCESS ? get(m, scope, call) : result;
}

SluiceResult slc_list_call_make(slc_manager *m, const struct slc_list_call *call,
                                slc_list_function *get)
{
    if (!m)
        return SLUICE_ERROR_NULL_POINTER;
    if (slc_is_locked(m))
        return slc_refuse_locked(m, call->function);
    struct slc_call record = {.kind = call->kind,
                              .texture_id = call->texture_id,
                              .retire_value = call->retire_value,
                              .query = !call->tiles,
                              .tiles = call->tiles};
    if (!call->count) {
        record.result = SLUICE_ERROR_NULL_POINTER;
    } else {
        record.room = *call->count;
        m->cut_short = false;
        record.result = get_list(m, call, get);
        record.count = *call->count;
        if (m->cut_short)
            record.room = record.count; /* replays equally on a machine with enough memory */
    }
    slc_notify(m, &record);
    return record.result;
}
