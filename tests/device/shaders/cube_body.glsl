/* One sample or mark of a cube map, after the bindings of cube.comp or cube.hlsl. */
#include "sluice/feedback_cube.glsl"
#include "sluice/sample_cube.glsl"

void probeCube(uint id)
{
    uint at = params.first + id;
    uint tableIndex = params.tableIndex;
    uint word = SLUICE_TEXTURE_ENTRY(tableIndex).feedbackOffset + id;
    if ((params.flags & CUBE_CLEAR) != 0u) {
        SLUICE_FEEDBACK_WORD(word) = SLUICE_MIP_UNTOUCHED;
        return;
    }
    if ((params.flags & CUBE_WORDS) != 0u) {
        outputs[at].level = SLUICE_FEEDBACK_WORD(word);
        return;
    }
    vec3 direction = vec3(inputs[at].direction[0], inputs[at].direction[1], inputs[at].direction[2]);
    vec3 dx = vec3(inputs[at].dx[0], inputs[at].dx[1], inputs[at].dx[2]);
    vec3 dy = vec3(inputs[at].dy[0], inputs[at].dy[1], inputs[at].dy[2]);
    float bias = inputs[at].lodBias, anisotropy = inputs[at].maxAnisotropy;
    if ((params.flags & CUBE_SAMPLE) != 0u) {
        uint missing;
        vec4 color;
        color = sluiceSampleCubeGrad(CUBE_FORM, tableIndex, direction, dx, dy, bias, anisotropy, missing);
        for (uint i = 0u; i < 4u; i++)
            outputs[at].color[i] = color[i];
        outputs[at].missingLevels = missing;
        SluiceCubePoint p = sluiceFindCubePoint(direction, dx, dy);
        SluiceSampling s = sluiceResolveCube(tableIndex, p, bias, anisotropy);
        outputs[at].level = s.level;
        outputs[at].wantedLevel = s.wantedLevel;
        outputs[at].lod = s.lod;
    }
    if ((params.flags & CUBE_FEEDBACK) != 0u)
        sluiceWriteCubeFeedback(tableIndex, direction, dx, dy, bias, anisotropy);
    for (uint i = 0u; i < 4u && (params.flags & CUBE_FEEDBACK_QUAD) != 0u; i++)
        sluiceWriteCubeQuadFeedback(tableIndex, direction, dx, dy, bias, anisotropy,
                                    (at & 1u) != 0u ? uvec2(3u, 6u) : uvec2(i, i >> 1u),
                                    (at & 1u) != 0u ? i : 5u);
    if ((params.flags & CUBE_FEEDBACK_LOD) != 0u)
        sluiceWriteCubeFeedbackLod(tableIndex, direction, inputs[at].lod);
}
