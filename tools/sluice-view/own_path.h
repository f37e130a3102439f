/** Path of this program. */
#ifndef SLUICE_VIEW_OWN_PATH_H
#define SLUICE_VIEW_OWN_PATH_H

#include <stdbool.h>
#include <stddef.h>

/** Writes the path of this program's file. False if the system does not tell. */
bool own_path(char *path, size_t size);
/** Writes the folder of this program's file. */
bool own_folder(char *folder, size_t size);

#endif /* SLUICE_VIEW_OWN_PATH_H */
