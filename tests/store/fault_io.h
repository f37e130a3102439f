/**
 * Replaces the system's calls (-Wl,--wrap), and lets them fail, fall short or be interrupted. Not
 * thread-safe.
 */
#ifndef TESTS_STORE_FAULT_IO_H
#define TESTS_STORE_FAULT_IO_H

#include <stdbool.h>
#include <stdint.h>

enum fault_call { FAULT_READ, FAULT_WRITE, FAULT_SYNC, FAULT_RENAME, FAULT_CUT, FAULT_CALLS };

struct fault_io {
    /** Settings. */
    uint64_t fail_at[FAULT_CALLS]; ///< number, from 1, of the call to fail; 0: none
    int error;                     ///< errno of the failure
    bool is_lasting;               ///< true: later calls fail too
    bool writes_half;              ///< true: a failing write has written half of its bytes
    bool interrupts;  ///< true: every second read and write is interrupted before it begins
    uint32_t longest; ///< limit of bytes per read and write; 0: none
    uint64_t kill_at[FAULT_CALLS]; ///< the process kills itself before the call of this number
    /** Results. */
    uint64_t count[FAULT_CALLS];
    uint64_t read_size, largest_read;
};

extern struct fault_io fault_io;

#endif /* TESTS_STORE_FAULT_IO_H */
