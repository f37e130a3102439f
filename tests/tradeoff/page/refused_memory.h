/** Stands between the page and malloc and calloc, where the program is linked with --wrap. */
#ifndef TESTS_TRADEOFF_REFUSED_MEMORY_H
#define TESTS_TRADEOFF_REFUSED_MEMORY_H

#include <stdint.h>

/** Lets so many calls succeed and refuses all later ones. UINT64_MAX: all succeed. Returns the
 * number of calls so far. */
uint64_t refuse_memory_after(uint64_t calls);

#endif /* TESTS_TRADEOFF_REFUSED_MEMORY_H */
