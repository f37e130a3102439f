/* stochastic_stream.comp in HLSL. */
#include "probe_bindings.hlsl"
#include "stochastic_stream_shared.h"
#include "stochastic_stream_body.glsl"

[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{
    if (id.x < params.count)
        sampleStochastic(id.x);
}
