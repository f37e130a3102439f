#include "proxy/proxy_box.h"

#include "base/log.h"

#include <math.h>

#define LARGEST 0x1p100f
#define SMALLEST 0x1p-100f
#define THINNEST 0x1p-20f /* least extent per largest coordinate: at least 8 float steps */

static SluiceResult check_axis(const SluiceProxyBox *box, uint32_t axis,
                               const SluiceLogCallback *log)
{
    float min = box->min[axis], max = box->max[axis];
    if (!(fabsf(min) <= LARGEST) || !(fabsf(max) <= LARGEST))
        return slc_log_refusal(log, "box of a proxy: axis %u is %g to %g; the limit is 2^100", axis,
                               (double)min, (double)max);
    if (min > max)
        return slc_log_refusal(log, "box of a proxy: min[%u] is %g, max[%u] is %g", axis,
                               (double)min, axis, (double)max);
    return SLUICE_SUCCESS;
}

SluiceResult slc_proxy_box_widen(const SluiceProxyBox *from, SluiceProxyBox *to,
                                 const SluiceLogCallback *log)
{
    float largest = 0;
    bool point = true;
    for (uint32_t axis = 0; axis < 3; axis++) {
        SluiceResult result = check_axis(from, axis, log);
        if (result != SLUICE_SUCCESS)
            return result;
        largest = fmaxf(largest, fmaxf(fabsf(from->min[axis]), fabsf(from->max[axis])));
        point = point && from->min[axis] == from->max[axis];
    }
    if (point || largest < SMALLEST)
        return slc_log_refusal(log, "box of a proxy: largest coordinate is %g: %s", (double)largest,
                               point ? "it is a point" : "below 2^-100");
    *to = *from;
    for (uint32_t axis = 0; axis < 3; axis++) {
        float lacks = largest * THINNEST - (from->max[axis] - from->min[axis]);
        if (lacks <= 0)
            continue;
        to->min[axis] -= largest * (THINNEST / 2);
        to->max[axis] += largest * (THINNEST / 2);
    }
    return SLUICE_SUCCESS;
}

double slc_proxy_box_volume(const SluiceProxyBox *box)
{
    double volume = 1;
    for (uint32_t axis = 0; axis < 3; axis++)
        volume *= (double)box->max[axis] - (double)box->min[axis];
    return volume;
}

double slc_proxy_box_distance(const SluiceProxyBox *box, const float point[3])
{
    double sum = 0;
    for (uint32_t axis = 0; axis < 3; axis++) {
        double at = point[axis], min = box->min[axis], max = box->max[axis];
        double distance = at < min ? min - at : at > max ? at - max : 0;
        sum += distance * distance;
    }
    return sum;
}
