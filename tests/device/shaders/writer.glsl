/* Buffers of the shaders that only write feedback. */
#extension GL_GOOGLE_include_directive : require

#include "sluice/shared/texture_table.h"
#include "writer_shared.h"

layout(std430, binding = 0) readonly buffer Table { SluiceTextureEntry entries[]; } textureTable;
layout(std430, binding = 1) buffer Feedback { uint words[]; } feedback;
layout(std430, binding = 2) readonly buffer Turns { uint words[]; } turns;
layout(std430, binding = 3) readonly buffer Inputs { WriterInput inputs[]; };
layout(std430, binding = 4) buffer Outputs { uint outputs[]; };
layout(push_constant) uniform Push { WriterParams params; };

#define SLUICE_TEXTURE_ENTRY(i) textureTable.entries[i]
#define SLUICE_FEEDBACK_WORD(i) feedback.words[i]
#ifdef WRITER_TURNS
#define SLUICE_FEEDBACK_TURN_WORD(i) turns.words[i]
#endif
#include "sluice/feedback.glsl"
