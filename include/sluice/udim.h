/**
 * Finds the files of UDIM texture sets.
 *
 * A UDIM set is a grid of images, its cells. The cell in column u and row v has the number
 * 1001 + u + 10 * v, with u below 10, up to 1999. Texture coordinates run from (u, v) to
 * (u + 1, v + 1) in it. A pattern is the path of a cell's file with `<UDIM>` in place of the
 * number, such as "hero/skin.<UDIM>.exr", or with `<UVTILE>` in place of "u1_v1": u + 1 and v + 1.
 */
#ifndef SLUICE_UDIM_H
#define SLUICE_UDIM_H

#include <sluice/base.h>

#ifdef __cplusplus
extern "C" {
#endif

#define SLUICE_UDIM_FIRST 1001u ///< Number of the cell in column 0 and row 0.
#define SLUICE_UDIM_LAST 1999u  ///< Largest number: column 8, row 99.
#define SLUICE_UDIM_COLUMNS 10u ///< Cells in a row.

/**
 * Lists the numbers of the cells that have a file, in ascending order.
 *
 * Reads the folder of the pattern once and opens no file. Column and row of a number n are
 * (n - SLUICE_UDIM_FIRST) % SLUICE_UDIM_COLUMNS and (n - SLUICE_UDIM_FIRST) / SLUICE_UDIM_COLUMNS.
 * A pattern without a folder means the working directory. Names with other counts of digits, and
 * numbers out of range, are other files. Folders and devices are no files. `pLog` may be NULL.
 *
 * If `pNumbers` is NULL, `*pCount` becomes the number of cells. Otherwise `*pCount` is the capacity
 * of `pNumbers` and becomes the number written. Returns SLUICE_INCOMPLETE if there are more cells.
 * There are at most 999. Returns SLUICE_NOT_READY if no file descriptor is free.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, if the
 *         pattern has no placeholder, more than one, or one in a folder's name, or is longer than
 *         4095 bytes; SLUICE_ERROR_FILE_NOT_FOUND if the folder does not exist, or no cell has a
 *         file; SLUICE_ERROR_IO if the folder cannot be read; SLUICE_ERROR_OUT_OF_HOST_MEMORY.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceFindUdimFiles(const char *pPattern, const SluiceLogCallback *pLog,
                                            uint32_t *pCount, uint32_t *pNumbers);

/**
 * Writes the path of a cell's file. The file need not exist.
 *
 * strlen(pPattern) + 1 bytes are always enough. `pLog` may be NULL.
 *
 * Errors: SLUICE_ERROR_NULL_POINTER; SLUICE_ERROR_INVALID_ARGUMENT, with a log message, for a
 *         pattern that sluiceFindUdimFiles refuses, a number below SLUICE_UDIM_FIRST or above
 *         SLUICE_UDIM_LAST, or a path that does not fit into `pathSize` bytes.
 * Thread safety: any thread.
 */
SLUICE_API SluiceResult sluiceWriteUdimPath(const char *pPattern, uint32_t number,
                                            const SluiceLogCallback *pLog, size_t pathSize,
                                            char *pPath);

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_UDIM_H */
