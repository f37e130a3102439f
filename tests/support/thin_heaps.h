/** Nine heaps of 16 slots in which defragmentation moves more tiles than there are. */
#ifndef TESTS_SUPPORT_THIN_HEAPS_H
#define TESTS_SUPPORT_THIN_HEAPS_H

#include <sluice/manager.h>

#define THIN_HEAPS_CAPACITY 16
#define THIN_HEAPS_TILES 12
/** Six tiles go to two heaps that are nearly full of retiring slots, all eight then to a third. */
#define THIN_HEAPS_MOVES 14

/**
 * For a new manager with heaps of THIN_HEAPS_CAPACITY: 4 tiles in the first heap, the rest free; 1
 * tile and 12 slots that retire with value 5 in the next two; 1 tile in each of the other six. As
 * many requests wait as leave the manager room for THIN_HEAPS_TILES more records.
 */
void thin_heaps_make(SluiceStreamedTextureManager *manager);

#endif /* TESTS_SUPPORT_THIN_HEAPS_H */
