#include "base/said.h"

#include "base/log.h"

#include <stdatomic.h>

/* FNV-1a. */
uint64_t slc_said_key(const char *text)
{
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (; *text; text++)
        hash = (hash ^ (unsigned char)*text) * UINT64_C(0x100000001B3);
    return hash;
}

enum slc_say slc_said_note(struct slc_said *said, uint64_t key)
{
    if (!said)
        return SLC_SAY_IT;
    key += key == 0;
    for (uint32_t i = 0; i < SLC_SAID_MAX; i++) {
        uint64_t there = atomic_load_explicit(&said->keys[i], memory_order_relaxed);
        if (there == 0 && atomic_compare_exchange_strong(&said->keys[i], &there, key))
            return i + 1 < SLC_SAID_MAX ? SLC_SAY_IT : SLC_SAY_IT_LAST;
        if (there == key) /* another thread may have added it */
            return SLC_SAY_NOTHING;
    }
    return SLC_SAY_NOTHING;
}

void slc_said_log(struct slc_said *said, const SluiceLogCallback *log, const char *path,
                  uint64_t key, const char *message)
{
    enum slc_say say = slc_said_note(said, key);
    if (say != SLC_SAY_NOTHING)
        slc_log(log, SLUICE_LOG_ERROR, "%s: %s%s", path, message,
                say == SLC_SAY_IT_LAST ? "; further faults of this file are counted, not logged"
                                       : "");
}
