/** Where this program is. */
#ifndef SLUICE_VIEW_OWN_PATH_H
#define SLUICE_VIEW_OWN_PATH_H

#include <stdbool.h>
#include <stddef.h>

/** The file of this program. False if the system does not say. */
bool own_path(char *path, size_t size);
/** Its folder. */
bool own_folder(char *folder, size_t size);

#endif /* SLUICE_VIEW_OWN_PATH_H */
