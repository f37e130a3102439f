/* Push constants of both shaders: axes of the picture, as directions. `edges`: width of the lines
 * that show the edges of the cube, as a share of its edge; 0: none. */
layout(push_constant) uniform View { vec4 right, up, ahead; uint tableIndex; float edges; } view;
