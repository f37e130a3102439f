/** Suffixes of pictures, for searches in folders. */
#ifndef TOOLS_COMMON_PICTURE_NAMES_H
#define TOOLS_COMMON_PICTURE_NAMES_H

/** Suffixes that sluice-bake reads: OpenEXR, DDS, KTX2 and those of libvips. For files_has_suffix.
 */
#define PICTURE_SUFFIXES                                                                           \
    ".exr|.dds|.ktx2|.png|.jpg|.jpeg|.tif|.tiff|.tx|.webp|.hdr|.gif|.ppm|.pgm|.pfm|.pnm|.bmp|"     \
    ".tga|.jp2|.j2k|.jxl|.heic|.heif|.avif|.psd|.v|.vips"

/** Suffixes of pictures that sluiceOpenImageSource reads in place. */
#define TILED_SUFFIXES ".exr|.dds|.ktx2"

#endif /* TOOLS_COMMON_PICTURE_NAMES_H */
