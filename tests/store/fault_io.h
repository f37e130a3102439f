/**
 * Stands between the library and the system's calls (-Wl,--wrap) and makes them fail, fall short or
 * be interrupted. One thread.
 */
#ifndef TESTS_STORE_FAULT_IO_H
#define TESTS_STORE_FAULT_IO_H

#include <stdbool.h>
#include <stdint.h>

enum fault_call { FAULT_READ, FAULT_WRITE, FAULT_SYNC, FAULT_RENAME, FAULT_CUT, FAULT_CALLS };

struct fault_io {
    /** What to do. */
    uint64_t fail_at[FAULT_CALLS]; ///< the call of this number, from 1, fails; 0: none
    int error;                     ///< with this errno
    bool is_lasting;               ///< and so do all later ones
    bool writes_half;              ///< a write that fails has written half of its bytes
    bool interrupts;               ///< every other read and write is interrupted before it begins
    uint32_t longest;              ///< reads and writes are cut to so many bytes; 0: none
    uint64_t kill_at[FAULT_CALLS]; ///< before the call of this number the process kills itself
    /** What happened. */
    uint64_t count[FAULT_CALLS];
    uint64_t read_size, largest_read;
};

extern struct fault_io fault_io;

#endif /* TESTS_STORE_FAULT_IO_H */
