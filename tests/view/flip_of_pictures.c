/* flip_of_pictures A.png B.png: prints the mean of FLIP between two pictures of one size. */
#include <sluice/metrics.h>

#include "../../samples/common/png_file.h"

#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    uint32_t size[2][2] = {{0}};
    double mean = -1;
    uint8_t *pictures[2] = {NULL, NULL};
    for (int i = 0; i < 2 && argc == 3; i++)
        pictures[i] = png_file_read(argv[i + 1], &size[i][0], &size[i][1]);
    const SluicePicturePair pair = {.structSize = sizeof pair,
                                    .pA = pictures[0],
                                    .pB = pictures[1],
                                    .width = size[0][0],
                                    .height = size[0][1],
                                    .format = SLUICE_PIXEL_FORMAT_RGBA8_SRGB};
    const bool computed = size[0][0] == size[1][0] && size[0][1] == size[1][1] &&
                          sluiceComputeFlip(&pair, 0, NULL, NULL, &mean) == SLUICE_SUCCESS;
    if (computed)
        printf("%.6f\n", mean);
    free(pictures[0]);
    free(pictures[1]);
    return computed ? EXIT_SUCCESS : EXIT_FAILURE;
}
