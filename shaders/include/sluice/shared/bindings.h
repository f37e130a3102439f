/*
 * Bindings of the descriptor sets that frames and launches return, and of the shaders that use
 * them: bindings.glsl and demand_bindings.glsl.
 */
#ifndef SLUICE_SHARED_BINDINGS_H
#define SLUICE_SHARED_BINDINGS_H

/* Streaming: SluiceStreamingFrame.descriptorSet */
#define SLUICE_BINDING_TEXTURE_TABLE 0
#define SLUICE_BINDING_MIN_MIP 1
#define SLUICE_BINDING_FEEDBACK 2
#define SLUICE_BINDING_FEEDBACK_TURNS 3
#define SLUICE_BINDING_PAGE_TABLE 4
#define SLUICE_BINDING_BUFFER_COUNT 5
#define SLUICE_BINDING_PAGES 5
#define SLUICE_BINDING_TEXTURES 6 /* combined image samplers, or images */
#define SLUICE_BINDING_SAMPLERS 7 /* samplers for images */
#define SLUICE_BINDING_CUBES 8    /* cube views: combined image samplers, or images */

/* SLUICE_TEXTURE_ARRAY, as SluiceTextureArray */
#define SLUICE_TEXTURES_COMBINED 1
#define SLUICE_TEXTURES_SEPARATE 2

/* Demand loading: SluiceDemandLaunch.descriptorSet */
#define SLUICE_DEMAND_BINDING_TEXTURES 0
#define SLUICE_DEMAND_BINDING_LEVELS 1
#define SLUICE_DEMAND_BINDING_DIRECTORY 2
#define SLUICE_DEMAND_BINDING_BLOCKS 3
#define SLUICE_DEMAND_BINDING_MASKS 4
#define SLUICE_DEMAND_BINDING_REQUESTS 5
#define SLUICE_DEMAND_BINDING_SECTIONS 6
#define SLUICE_DEMAND_BINDING_BUFFER_COUNT 7
#define SLUICE_DEMAND_BINDING_PAGES 7
#define SLUICE_DEMAND_BINDING_BYTES 8 /* an array of storage buffers: chunks of byte pages */
#define SLUICE_DEMAND_BYTE_CHUNKS 16  /* its elements */

/* Elements of the array of samplers: the least that every device supports, less one for pages. */
#define SLUICE_SAMPLER_COUNT 15

#endif
