/** Nine heaps of 16 slots in which defragmentation moves more tiles than there are. */
#ifndef TESTS_SUPPORT_THIN_HEAPS_H
#define TESTS_SUPPORT_THIN_HEAPS_H

#include <sluice/manager.h>

#define THIN_HEAPS_CAPACITY 16
#define THIN_HEAPS_TILES 12
/** Six tiles go to two heaps that are nearly full of retiring slots, all eight then to a third. */
#define THIN_HEAPS_MOVES 14

/**
 * Prepares a new manager with heaps of THIN_HEAPS_CAPACITY. The first heap has 4 tiles and free
 * slots. The next two have 1 tile and 12 slots that retire with value 5. The other six have 1 tile
 * each. So many requests wait that the manager has room for THIN_HEAPS_TILES more records.
 */
void thin_heaps_make(SluiceStreamedTextureManager *manager);

#endif /* TESTS_SUPPORT_THIN_HEAPS_H */
