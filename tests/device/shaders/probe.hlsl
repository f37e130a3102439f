/* probe.comp in HLSL, without residency codes. */
#include "probe_bindings.hlsl"
#include "probe_body.glsl"

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    if (id.x < params.count)
        probe(id.x);
}
