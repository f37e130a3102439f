/* make_neural_file OUT: writes the worked example, for tests of programs. */
#include "neural/worked_example.h"

#include <stdio.h>

int main(int argc, char **argv)
{
    uint8_t bytes[WORKED_EXAMPLE_MAX_SIZE];
    size_t size = write_worked_example(bytes);
    FILE *file = argc == 2 ? fopen(argv[1], "wb") : NULL;
    if (!file)
        return 1;
    size_t written = fwrite(bytes, 1, size, file);
    return fclose(file) != 0 || written != size;
}
