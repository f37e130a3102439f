/** Handles and ids of demand loading. Part of `sluice-vulkan`. */
#ifndef SLUICE_DEMAND_TYPES_H
#define SLUICE_DEMAND_TYPES_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct SluiceDemandLoader SluiceDemandLoader;

/** Id of a texture. Never 0. The low 32 bits are the index for shaders. */
typedef uint64_t SluiceDemandTextureId;
/** Id of a resource. Never 0. */
typedef uint64_t SluiceDemandResourceId;
/** Ticket of the work that one call started. 0: no work, always complete. */
typedef uint64_t SluiceDemandTicket;

/** No texture. Value of an id in a zeroed struct. */
#define SLUICE_NO_DEMAND_TEXTURE ((SluiceDemandTextureId)0)
/** All textures of a loader, in calls that say so. Never the id of a texture. */
#define SLUICE_ALL_DEMAND_TEXTURES ((SluiceDemandTextureId)UINT64_MAX)

#ifdef __cplusplus
} /* extern "C" */
#endif

#endif /* SLUICE_DEMAND_TYPES_H */
