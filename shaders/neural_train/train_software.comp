/* train.comp for software devices: what is live at a barrier costs lavapipe time when it compiles. */
#version 450
#define TRAIN_SUMS_IN_MEMORY
#extension GL_GOOGLE_include_directive : require
#include "train.glsl"
