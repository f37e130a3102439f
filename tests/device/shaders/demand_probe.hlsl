/* demand_probe.comp in HLSL. */
#define DEMAND_PAGE_LOOP
#include "demand_probe.glsl"

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    if (id.x < push.count)
        probeDemand(id.x);
}
