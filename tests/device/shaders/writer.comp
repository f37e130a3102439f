/* Writes the feedback of given samples. Built for each encoding, and with WRITER_TURNS. */
#version 450
#extension GL_GOOGLE_include_directive : require

#include "writer.glsl"

layout(local_size_x = 64) in;

void main()
{
    uint at = params.first + gl_GlobalInvocationID.x;
    if (gl_GlobalInvocationID.x >= params.count)
        return;
    if ((params.flags & WRITER_COPY_WORDS) != 0u) {
        outputs[gl_GlobalInvocationID.x] = feedback.words[at];
        return;
    }
    WriterInput i = inputs[at];
    sluiceWriteFeedback(i.tableIndex, vec2(i.uv[0], i.uv[1]), vec2(i.dx[0], i.dx[1]),
                        vec2(i.dy[0], i.dy[1]), 0.0, i.maxAnisotropy);
}
