/** Boxes that rays can hit. */
#ifndef SLC_PROXY_PROXY_BOX_H
#define SLC_PROXY_PROXY_BOX_H

#include <sluice/proxy.h>

/** Checks a box and widens its thin axes, as sluiceAddGeometryProxy says. Errors, logged:
 *  INVALID_ARGUMENT. */
SluiceResult slc_proxy_box_widen(const SluiceProxyBox *from, SluiceProxyBox *to,
                                 const SluiceLogCallback *log);
double slc_proxy_box_volume(const SluiceProxyBox *box);
/** Returns the squared distance to a point; 0 inside. */
double slc_proxy_box_distance(const SluiceProxyBox *box, const float point[3]);

#endif /* SLC_PROXY_PROXY_BOX_H */
