/** Common interface to the C APIs of Embree 3 and 4. */
#ifndef TESTS_ORACLE_EMBREE_H
#define TESTS_ORACLE_EMBREE_H

#if ORACLE_EMBREE == 4
#include <embree4/rtcore.h>
#elif ORACLE_EMBREE == 3
#include <embree3/rtcore.h>
#else
#error "ORACLE_EMBREE is the major version of Embree: 3 or 4"
#endif

/** Context that a filter function gets. */
#if ORACLE_EMBREE == 4
typedef struct RTCRayQueryContext oracle_context;
#else
typedef struct RTCIntersectContext oracle_context;
#endif

static inline void oracle_init_context(oracle_context *context)
{
#if ORACLE_EMBREE == 4
    rtcInitRayQueryContext(context);
#else
    rtcInitIntersectContext(context);
#endif
}

static inline void oracle_intersect(RTCScene scene, oracle_context *context,
                                    struct RTCRayHit *ray_hit)
{
#if ORACLE_EMBREE == 4
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = context;
    rtcIntersect1(scene, ray_hit, &arguments);
#else
    rtcIntersect1(scene, context, ray_hit);
#endif
}

#endif /* TESTS_ORACLE_EMBREE_H */
