/* Forward and backward pass with sums in registers. */
#version 450
#extension GL_GOOGLE_include_directive : require
#include "train.glsl"
