/** Sharing of reads among devices: the value of --read-pool. */
#ifndef SAMPLES_COMMON_READ_SHARING_H
#define SAMPLES_COMMON_READ_SHARING_H

#include <sluice/loader.h>

#include <stdbool.h>

enum read_sharing {
    READ_SHARING_AUTO, ///< a pool if there are several devices
    READ_SHARING_ON,
    READ_SHARING_OFF, ///< each device reads for itself
};

#define READ_SHARING_WORDS "auto|on|off"
#define READ_SHARING_HELP                                                                          \
    "devices share threads that read, and what was read: each tile is read once; off: each reads " \
    "for itself; auto: on with several devices"

/** Creates the pool. `*pool` stays NULL without sharing. Reports errors on stderr. */
bool read_sharing_create(enum read_sharing sharing, uint32_t device_count, uint32_t thread_count,
                         SluiceReadPool **pool);

/** Prints the pool's statistics with `print`. Prints nothing without a pool. */
void read_sharing_print(SluiceReadPool *pool,
                        void (*print)(const char *name, const char *unit, double value, bool json),
                        bool json);

#endif /* SAMPLES_COMMON_READ_SHARING_H */
