/** Stands between the page and malloc and calloc, where the program is linked with --wrap. */
#ifndef TESTS_TRADEOFF_REFUSED_MEMORY_H
#define TESTS_TRADEOFF_REFUSED_MEMORY_H

#include <stdint.h>

/** So many calls succeed, all later ones do not; UINT64_MAX: all do. Returns how many there were.
 */
uint64_t refuse_memory_after(uint64_t calls);

#endif /* TESTS_TRADEOFF_REFUSED_MEMORY_H */
