/** The index that stands for none. */
#ifndef SLC_BASE_NONE_H
#define SLC_BASE_NONE_H

#include <stdint.h>

#define SLC_NONE UINT32_MAX

#endif /* SLC_BASE_NONE_H */
