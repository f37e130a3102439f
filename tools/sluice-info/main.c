/* Says what is in files of textures, and what the Vulkan devices of this machine can do for Sluice.
 */
#include "show.h"

#include "../common/text.h"

#include <stdio.h>

static int show_files(const struct options *options)
{
    int status = ALL_SHOWN;
    for (int i = 0; i < options->file_count; i++)
        if (show_file(options, options->files[i]) != ALL_SHOWN)
            status = NOT_SHOWN;
    return status;
}

int main(int argc, char **argv)
{
    struct options options;
    int status = ALL_SHOWN;
    if (!parse_options(&options, argc, argv))
        return WRONG_USAGE;
    if (options.help)
        print_help();
    else if (options.png)
        status = write_picture(&options);
    else if (options.file_count)
        status = show_files(&options);
    else
        status = show_devices(&options);
    return text_flush("sluice-info: ") ? status : NOT_SHOWN;
}
